// Limits of time and memory for this process.
#pragma once
#include <cstdint>
#include <string>

namespace aspic {

inline constexpr int kOutOfTime = 4;  // exit code

// After this many seconds of wall time the process prints `message` to stderr and exits with kOutOfTime. A second call
// replaces the first.
void limit_time(double seconds, const std::string& message);

// If a fault signal such as SIGSEGV occurs, the process prints `message` to stderr and exits with this code.
void end_faults(int exit_code, const std::string& message);

// Allocations beyond this many bytes throw std::bad_alloc.
void limit_memory(std::int64_t bytes);

}  // namespace aspic
