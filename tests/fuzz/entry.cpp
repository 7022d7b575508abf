// Entry point of libFuzzer: "aspic_fuzz TARGET [options of libFuzzer] [files and folders]". Subprocesses of libFuzzer
// read the target from the environment.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/parallel.h"
#include "targets.h"

namespace {

constexpr char kVariable[] = "ASPIC_FUZZ_TARGET";
const aspic::fuzz::Target* target = nullptr;

}  // namespace

// Inputs are small, and several fuzzers run at once.
extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  aspic::set_thread_count(1);
  const char* known = std::getenv(kVariable);
  std::string name = known ? known : "";
  if (*count > 1 && (*arguments)[1][0] != '-' && aspic::fuzz::target_named((*arguments)[1])) {
    name = (*arguments)[1];
    for (int i = 1; i < *count; ++i) (*arguments)[i] = (*arguments)[i + 1];
    --*count;
    ::setenv(kVariable, name.c_str(), 1);
  }
  target = aspic::fuzz::target_named(name);
  if (target) return 0;
  std::fprintf(stderr, "usage: aspic_fuzz TARGET [options] [files and folders]\nTargets:");
  for (const aspic::fuzz::Target& t : aspic::fuzz::targets()) std::fprintf(stderr, " %s", std::string(t.name).c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  aspic::fuzz::attempt(target->feed, {reinterpret_cast<const char*>(data), size});
  return 0;
}
