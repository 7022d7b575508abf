#include "budget.h"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>

namespace aspic {
namespace {

struct Farewell {
  std::string message;
  int exit_code = 0;

  [[noreturn]] void say() const {
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, message.data(), message.size());
    ::_exit(exit_code);
  }
};

Farewell out_of_time, fault;  // set before the signals can arrive

}  // namespace

void limit_time(double seconds, const std::string& message) {
  out_of_time = {message, kOutOfTime};
  std::signal(SIGALRM, [](int) { out_of_time.say(); });
  constexpr double kLongest = 1e9;  // [s]
  const double bounded = std::clamp(seconds, 1e-3, kLongest);
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(bounded);
  timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (bounded - std::floor(bounded)));
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

// The handler has its own stack, because a fault may be the overflow of the other one.
void end_faults(int exit_code, const std::string& message) {
  static std::array<char, 1 << 16> handler_stack;
  fault = {message, exit_code};
  stack_t stack{};
  stack.ss_sp = handler_stack.data();
  stack.ss_size = handler_stack.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = [](int) { fault.say(); };
  action.sa_flags = SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

void limit_memory(std::int64_t bytes) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  const auto wanted = static_cast<rlim_t>(std::max<std::int64_t>(bytes, 0));
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? wanted : std::min(wanted, limit.rlim_max);
  ::setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace aspic
