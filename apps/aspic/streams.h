// Standard streams on which printing never fails: a full disk, a closed descriptor or a closed pipe ends no
// computation. Losses are reported at the end.
#pragma once
#include <cstdio>
#include <string>

namespace aspic::cli {

// Replaces stdout and stderr. Reserves descriptors 0, 1 and 2 if they are closed, so that no result file gets one of
// these numbers. Call once, before anything is printed.
void guard_standard_streams();

int descriptor(std::FILE* stream);  // descriptor of stdout or stderr

// Returns why output to stdout was lost; empty if all was written.
std::string lost_output();

}  // namespace aspic::cli
