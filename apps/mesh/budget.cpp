#include "budget.h"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>

namespace aspic {
namespace {

std::string farewell;  // set before the signal can arrive

void end_process(int) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, farewell.data(), farewell.size());
  ::_exit(kOutOfTime);
}

}  // namespace

void limit_time(double seconds, const std::string& message) {
  farewell = message;
  std::signal(SIGALRM, end_process);
  constexpr double kLongest = 1e9;  // [s]
  const double bounded = std::clamp(seconds, 1e-3, kLongest);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(bounded);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (bounded - std::floor(bounded)));
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

void limit_memory(std::int64_t bytes) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const auto wanted = static_cast<rlim_t>(std::max<std::int64_t>(bytes, 0));
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? wanted : std::min(wanted, limit.rlim_max);
  ::setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace aspic
