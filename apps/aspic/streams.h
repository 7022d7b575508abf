// Standard streams on which printing never fails: a full disk, a closed descriptor or a reader that has gone ends no
// computation. What was lost is known at the end.
#pragma once
#include <cstdio>
#include <string>

namespace aspic::cli {

// Replaces stdout and stderr. Reserves descriptors 0, 1 and 2 where they are closed, so that no file of results gets
// one of these numbers. To be called once, before anything is printed.
void guard_standard_streams();

int descriptor(std::FILE* stream);  // of stdout or stderr

// Why something printed to standard output was lost; empty when all of it arrived.
std::string lost_output();

}  // namespace aspic::cli
