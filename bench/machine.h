// The machine and the build that measure: what a number needs beside it to be worth anything.
#pragma once
#include <string>
#include <vector>

namespace aspic::bench {

struct Fact {
  std::string name, value;
};
// Processor, SIMD, caches, memory, load, compiler, flags, commit. Nothing that names a person's machine.
std::vector<Fact> machine_facts();
void print_facts(const std::vector<Fact>& facts);

// The largest resident memory of this process since it was last forgotten [bytes]; 0: the system does not tell.
double peak_memory();
void forget_peak_memory();

}  // namespace aspic::bench
