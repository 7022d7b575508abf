// Ctrl-C and a plain kill ask the run to stop; a second one ends the program at once.
#pragma once

namespace aspic::cli {

void catch_interrupts();
int interrupt_signal();  // SIGINT or SIGTERM once one was received, else 0

}  // namespace aspic::cli
