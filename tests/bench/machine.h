// Description of the machine and the build, recorded with each measurement.
#pragma once
#include <string>
#include <vector>

namespace aspic::bench {

struct Fact {
  std::string name, value;
};
// Processor, SIMD, caches, memory, load, compiler, flags, commit. Contains no name of a machine or user.
std::vector<Fact> machine_facts();
void print_facts(const std::vector<Fact>& facts);

// Peak resident memory of this process since the last reset [bytes]; 0: unknown.
double peak_memory();
void forget_peak_memory();

}  // namespace aspic::bench
