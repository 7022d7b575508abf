// Runs the benchmark beam with this library.
#pragma once
#include <string>
#include <vector>

#include "bench/beam_problem.h"
#include "dynamics/simulation.h"

namespace aspic::bench {

Simulation make_beam_simulation(const BeamProblem& problem, const std::string& linear = "auto");

struct AspicRun : BeamResult {
  std::vector<StepReport> reports;
  std::string solver;      // solver chosen, with the reason
  double peak_memory = 0;  // peak memory of the process during this run [bytes]; 0: unknown
};
AspicRun run_aspic(const BeamProblem& problem, const std::string& linear = "auto");

}  // namespace aspic::bench
