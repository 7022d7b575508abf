// The entry of libFuzzer; ASPIC_FUZZ_TARGET is the function of targets.h.
#include <cstddef>
#include <cstdint>

#include "base/parallel.h"
#include "targets.h"

// Inputs are small, and the machine is full of fuzzers.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  aspic::set_thread_count(1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  aspic::fuzz::attempt(aspic::fuzz::ASPIC_FUZZ_TARGET, {reinterpret_cast<const char*>(data), size});
  return 0;
}
