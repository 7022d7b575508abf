// The entry of libFuzzer; ASPIC_FUZZ_TARGET is the function of targets.h.
#include <cstddef>
#include <cstdint>

#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  aspic::fuzz::attempt(aspic::fuzz::ASPIC_FUZZ_TARGET, {reinterpret_cast<const char*>(data), size});
  return 0;
}
