#include "results/run_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>

namespace aspic {
namespace {

// Returns the process that holds the lock, from a line of /proc/locks:
//   1: FLOCK  ADVISORY  WRITE 4711 08:01:131 0 EOF
std::string holder_of(const struct stat& info) {
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, mode, access, process, file;
    words >> number >> kind >> mode >> access >> process >> file;
    if (kind == "FLOCK" && file.substr(file.rfind(':') + 1) == std::to_string(info.st_ino)) return "process " + process;
  }
  return "";
}

}  // namespace

std::string RunLock::holder(const std::filesystem::path& folder) {
  struct stat info {};
  return ::stat(folder.c_str(), &info) == 0 ? holder_of(info) : "";
}

RunLock::RunLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  const std::string process = holder(folder);
  throw FolderInUse(folder.string() + ": " + (process.empty() ? "another process" : process) +
                    " is writing results into it; wait for its end, stop it, or choose another directory with --out");
}

RunLock::~RunLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace aspic
