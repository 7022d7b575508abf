// Ctrl-C, a plain kill and a closed pipe request a stop. A second Ctrl-C or kill ends the program immediately.
#pragma once

namespace aspic::cli {

void catch_interrupts();
int interrupt_signal();  // SIGINT, SIGTERM or SIGPIPE after one was received, otherwise 0

}  // namespace aspic::cli
