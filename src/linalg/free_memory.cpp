#include "linalg/free_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace aspic {
namespace {

constexpr int64_t kUnknown = std::numeric_limits<int64_t>::max();

int64_t machine_available() {  // /proc/meminfo: "MemAvailable:   123456 kB"
  std::ifstream file("/proc/meminfo");
  for (std::string key; file >> key; file.ignore(256, '\n'))
    if (int64_t kilobytes = 0; key == "MemAvailable:" && file >> kilobytes) return kilobytes * 1024;
  return kUnknown;
}

int64_t number_in(const char* path) {  // "max" stands for no limit
  std::ifstream file(path);
  int64_t value = 0;
  return file >> value ? value : kUnknown;
}

int64_t group_available(const char* limit_path, const char* usage_path) {
  const int64_t limit = number_in(limit_path), usage = number_in(usage_path);
  return limit == kUnknown || usage == kUnknown ? kUnknown : std::max<int64_t>(0, limit - usage);
}

}  // namespace

int64_t free_memory() {
  return std::min(
      {machine_available(), group_available("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
       group_available("/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes")});
}

}  // namespace aspic
