// The work of the beam does not exceed the committed counts. Counts, unlike times, do not depend on the load of the
// machine.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "allocation_counter.h"
#include "base/parallel.h"
#include "bench/beam_run.h"
#include "bench/step_counts.h"
#include "linalg/linear_solver.h"

namespace aspic::bench {
namespace {

constexpr char kFile[] = ASPIC_SOURCE_DIR "/tests/bench/expected_counts.csv";
constexpr char kRenew[] = "ASPIC_UPDATE_COUNTS=1 build/release/bin/test_bench";
bool is_renewed() { return std::getenv("ASPIC_UPDATE_COUNTS") != nullptr; }

using Counts = std::map<std::string, long>;  // "falling,auto,iterations": 30

std::string key(std::string_view beam, std::string_view solver, std::string_view count) {
  std::string key(beam);
  return key.append(",").append(solver).append(",").append(count);
}

Counts read_expected() {
  Counts expected;
  std::ifstream file(kFile);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string beam, solver, name;
    long count = 0;
    std::getline(words, beam, ',');
    std::getline(words, solver, ',');
    std::getline(words, name, ',');
    if (words >> count) expected[key(beam, solver, name)] = count;
  }
  return expected;
}

void write_expected(const Counts& counts) {
  std::ofstream file(kFile);
  file << "# The most work that the beam with n = 7 may take: 10 falling steps, 5 bent ones "
          "(tests/bench/beam_problem.h).\n"
          "# Lower counts are welcome. Renew after a change that is meant, and say why in its commit message:\n# "
       << kRenew << "\nbeam,solver,count,at most\n";
  for (const auto& [name, count] : counts) file << name << ',' << count << '\n';
}

BeamProblem problem_named(const std::string& name) {
  if (name == "falling") return falling_beam(7);
  BeamProblem bent = bent_beam(7);
  bent.steps = 5;
  return bent;
}

Counts measured_counts() {
  Counts measured;
  for (const std::string beam : {"falling", "bent"})
    for (const std::string& solver : linear_solver_names()) {
      StepCounts counts;
      const AspicRun run = run_aspic(problem_named(beam), solver);
      EXPECT_TRUE(run.converged) << beam << ", " << solver;
      for (const StepReport& report : run.reports) add_counts(report, counts);
      for (const NamedCount& named : kCounts) {
        measured[key(beam, solver, named.name)] = counts.*named.count;
      }
    }
  return measured;
}

// Another processor rounds differently, which may change the iterations of conjugate gradients by a few percent.
long allowed(long expected) { return expected + expected / 40; }

TEST(BenchCounts, TheBeamTakesNoMoreWorkThanCommitted) {
  const Counts measured = measured_counts();
  if (is_renewed()) {
    write_expected(measured);
    GTEST_SKIP() << "wrote " << kFile;
  }
  const Counts expected = read_expected();
  for (const auto& [name, count] : measured) {
    const auto found = expected.find(name);
    if (found == expected.end()) {
      ADD_FAILURE() << name << " is not in " << kFile << "; renew it: " << kRenew;
    } else {
      EXPECT_LE(count, allowed(found->second)) << name << "; if that is meant: " << kRenew;
    }
  }
}

TEST(BenchCounts, TheCountsDoNotDependOnTheThreads) {
  const int before = thread_count();
  std::vector<StepCounts> counts(2);
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    for (const StepReport& report : run_aspic(problem_named("falling")).reports)
      add_counts(report, counts[threads - 1]);
  }
  set_thread_count(before);
  for (const NamedCount& named : kCounts) EXPECT_EQ(counts[0].*named.count, counts[1].*named.count) << named.name;
}

TEST(BenchCounts, SteadyBeamStepAllocatesOnlyItsReport) {
  for (const std::string& solver : linear_solver_names()) {
    Simulation simulation = make_beam_simulation(falling_beam(7), solver);
    for (int i = 0; i < 2; ++i) simulation.step();
    for (int i = 0; i < 2; ++i) {
      const test::AllocationCounter counter;
      simulation.step();
      EXPECT_EQ(counter.count(), 5) << solver << ": more than the five vectors of StepReport";
    }
  }
}

}  // namespace
}  // namespace aspic::bench
