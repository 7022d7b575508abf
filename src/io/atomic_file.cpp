#include "io/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/free_memory.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error, const std::string& remedy) {
  throw InvalidInput(path.string() + ": " + what + ": " + std::generic_category().message(error) + "; " + remedy);
}

// File descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  operator int() const { return number_; }
  int close() {
    const int result = number_ < 0 ? 0 : ::close(number_);
    number_ = -1;
    return result;
  }

 private:
  int number_;
};

// The name is short, so that it fits wherever the target's fits.
std::string unused_name(const fs::path& folder) {
  static std::atomic<unsigned> counter = 0;
  for (;;) {
    const std::string number = std::to_string(::getpid()) + "-" + std::to_string(counter++);
    fs::path name = folder / (std::string(".aspic-") + number);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(name, error))) return name.string();
  }
}

// The file to replace: a symbolic link remains a link.
fs::path replaced_file(const fs::path& path) {
  std::error_code error;
  fs::path target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  if (target.filename().empty()) throw InvalidInput(path.string() + ": names no file; name a file to write");
  if (fs::exists(target, error) && !fs::is_regular_file(target, error))
    throw InvalidInput(path.string() + ": is not a regular file; name a file to write");
  return target;
}

// After a crash the new name exists only if its directory was synced. Some file systems refuse this, which is no error
// because the file itself is complete.
void flush_directory_of(const fs::path& file) {
  const fs::path directory = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const Descriptor descriptor(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor >= 0) ::fsync(descriptor);
}

// " (did you mean 'bunny.mesh'?)", or nothing.
std::string near_name(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (fs::exists(path, error)) return "";
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  const std::string nearest = nearest_name(path.filename().string(), names);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path)
    : path_(path), target_(replaced_file(path)), temporary_(unused_name(target_.parent_path())) {
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);  // as any new file
  if (descriptor_ < 0) fail(path, "cannot be written", errno, "create the folder or choose a writable one");
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write();
    bytes.remove_prefix(static_cast<size_t>(written));
  }
}

void AtomicFile::commit() {
  struct stat info {};  // a replaced file keeps its permissions
  if (::stat(target_.c_str(), &info) == 0 && ::fchmod(descriptor_, info.st_mode & 0777) != 0) fail_to_write();
  if (::fsync(descriptor_) != 0) fail_to_write();
  if (::close(std::exchange(descriptor_, -1)) != 0) fail_to_write();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0)
    fail(path_, "cannot be replaced", errno, "check its folder's permissions");
  temporary_.clear();
  flush_directory_of(target_);
}

void AtomicFile::fail_to_write() const {
  fail(path_, "cannot be written", errno, "free some space or choose another disk");
}

void write_file(const fs::path& path, std::string_view contents) {
  AtomicFile file(path);
  file.append(contents);
  file.commit();
}

std::string read_file(const fs::path& path) {
  const Descriptor descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (const int error = errno; descriptor < 0)
    fail(path, "cannot be read", error, "check the name and the permissions" + near_name(path));
  struct stat info {};
  if (::fstat(descriptor, &info) != 0) fail(path, "cannot be read", errno, "check the file system");
  if (S_ISDIR(info.st_mode)) throw InvalidInput(path.string() + ": is a folder; name a file in it");
  if (!S_ISREG(info.st_mode)) throw InvalidInput(path.string() + ": is not a regular file; copy it to one first");
  const auto size = static_cast<size_t>(info.st_size);
  constexpr size_t kSmall = size_t{1} << 24;
  if (const size_t available = size > kSmall ? static_cast<size_t>(free_memory()) : size; size > available)
    throw InvalidInput(path.string() + ": is " + std::to_string(size) + " bytes, more than the " +
                       std::to_string(available) + " bytes of memory that are free; use a smaller file");

  // A compressed file system also stores less than the size, but not a hundred times less.
  if (const auto stored = static_cast<size_t>(info.st_blocks) * 512; size > kSmall && stored < size / 100)
    throw InvalidInput(path.string() + ": is " + std::to_string(size) + " bytes, of which only " +
                       std::to_string(stored) + " were ever written; copy or download it again");

  std::string contents(size, '\0');
  size_t done = 0;
  while (done < size) {
    const ssize_t count = ::read(descriptor, contents.data() + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, "cannot be read", errno, "check the disk");
    if (count == 0) break;  // the file was shortened meanwhile
    done += static_cast<size_t>(count);
  }
  contents.resize(done);
  return contents;
}

}  // namespace aspic
