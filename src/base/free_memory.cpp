#include "base/free_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace aspic {
namespace {

constexpr int64_t kNoLimit = std::numeric_limits<int64_t>::max();

// Returns the number after `key` in a file of lines "key number ...".
int64_t entry(const char* path, const char* key) {
  std::ifstream file(path);
  for (std::string word; file >> word; file.ignore(256, '\n'))
    if (int64_t value = 0; word == key && file >> value) return value;
  return kNoLimit;
}

int64_t machine_available() {
  const int64_t kilobytes = entry("/proc/meminfo", "MemAvailable:");
  return kilobytes == kNoLimit ? kNoLimit : kilobytes * 1024;
}

int64_t number_in(const char* path) {  // "max" means no limit
  std::ifstream file(path);
  int64_t value = 0;
  return file >> value ? value : kNoLimit;
}

struct GroupFiles {
  const char *limit, *usage, *statistics, *cache_key;
};

// The usage includes the page cache, which the system can reclaim.
int64_t group_available(const GroupFiles& files) {
  const int64_t limit = number_in(files.limit), usage = number_in(files.usage);
  if (limit == kNoLimit || usage == kNoLimit) return kNoLimit;
  const int64_t cache = entry(files.statistics, files.cache_key);
  return std::clamp<int64_t>(limit - usage + (cache == kNoLimit ? 0 : cache), 0, limit);
}

// Returns the memory that this process may still map (ulimit -v).
int64_t process_available() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoLimit;
  const int64_t pages = number_in("/proc/self/statm");
  if (pages == kNoLimit) return kNoLimit;
  return std::max<int64_t>(0, static_cast<int64_t>(limit.rlim_cur) - pages * ::sysconf(_SC_PAGESIZE));
}

}  // namespace

int64_t free_memory() {
  const int64_t version_2 = group_available(
      {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current", "/sys/fs/cgroup/memory.stat", "inactive_file"});
  const int64_t version_1 =
      group_available({"/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes",
                       "/sys/fs/cgroup/memory/memory.stat", "total_inactive_file"});
  return std::min({machine_available(), process_available(), version_2, version_1});
}

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);  // a mapping of its own is returned when it is freed
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace aspic
