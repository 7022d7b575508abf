// `aspic-mpi run`: simulates a scene on several ranks.
#pragma once
#include <string>
#include <vector>

namespace aspic::mpi {

struct RunArguments {
  std::string input, out;  // out: directory for the results; empty: out/NAME
  std::vector<std::string> overrides;
  int steps = 0;  // of the whole run; 0: as in the scene
  bool force = false, resume = false, quiet = false, allow_unconverged = false;
};

// Returns the exit code. Collective.
int run(const RunArguments& arguments);

}  // namespace aspic::mpi
