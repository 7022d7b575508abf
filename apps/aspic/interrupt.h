// Ctrl-C, a plain kill and a pipe without a reader ask the run to stop. A second ctrl-C or kill ends the program at
// once.
#pragma once

namespace aspic::cli {

void catch_interrupts();
int interrupt_signal();  // SIGINT, SIGTERM or SIGPIPE once one was received, else 0

}  // namespace aspic::cli
