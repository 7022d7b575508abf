#include "io/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"

namespace aspic {

OutputFile::OutputFile(std::filesystem::path path, int flags)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), flags | O_RDWR | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail("cannot be opened for writing");
  const off_t end = ::lseek(descriptor_, 0, SEEK_END);
  if (end < 0) {
    ::close(descriptor_);
    fail("is no ordinary file");
  }
  size_ = static_cast<uint64_t>(end);
}

OutputFile OutputFile::create(const std::filesystem::path& path) { return OutputFile(path, O_CREAT | O_TRUNC); }
OutputFile OutputFile::open_existing(const std::filesystem::path& path) { return OutputFile(path, 0); }

OutputFile::~OutputFile() {
  if (is_open()) ::close(descriptor_);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

void OutputFile::append(std::string_view bytes) {
  try {
    write_at(size_, bytes);
  } catch (const InvalidInput&) {  // the disk may have stored a part
    [[maybe_unused]] const int best_effort = ::ftruncate(descriptor_, static_cast<off_t>(size_));
    throw;
  }
  size_ += bytes.size();
}

void OutputFile::write_at(uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot be written");
    bytes.remove_prefix(static_cast<size_t>(written));
    offset += static_cast<uint64_t>(written);
  }
}

void OutputFile::truncate(uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail("cannot be shortened");
  size_ = size;
}

void OutputFile::sync() {
  if (::fsync(descriptor_) != 0) fail("cannot be written");
}

void OutputFile::close() {
  if (is_open() && ::close(std::exchange(descriptor_, -1)) != 0) fail("cannot be written");
}

void OutputFile::fail(const char* what) const {
  throw InvalidInput(path_.string() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace aspic
