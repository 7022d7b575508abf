#include "aspic/interrupt.h"

#include <atomic>
#include <csignal>

namespace aspic::cli {
namespace {

std::atomic<int> received = 0;
static_assert(std::atomic<int>::is_always_lock_free, "the handler may only touch lock-free state");

void on_signal(int signal) {
  received = signal;
  std::signal(signal, signal == SIGPIPE ? SIG_IGN : SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGPIPE, on_signal);
}

int interrupt_signal() { return received; }

}  // namespace aspic::cli
