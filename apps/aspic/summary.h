// What a run amounted to, and how to look at its results.
#pragma once
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "dynamics/step_report.h"

namespace aspic::cli {

struct RunTotals {
  int steps = 0, unconverged = 0;
  int out_of_time = 0;  // ended by solver.time_budget, which was asked for: not among the unconverged
  std::array<int, kStatusCount> by_status = {};
  int bounds_held = 0, bounds_broken = 0;  // of energy, where backward Euler guarantees one
  int grew = 0;           // steps of those in which kinetic + potential energy grew by more than forces worked
  double most_grown = 0;  // [J]
  std::optional<StepReport> worst;  // least of a success, then furthest from its threshold
  long iterations = 0;
  long values = 0, gradients = 0, hessians = 0, factorizations = 0, products = 0, cycles = 0;
  int most_iterations = 0;
  long substeps = 0, rejected = 0;                 // of adaptive steps
  double seconds = 0;                              // in steps
  double time = 0;                                 // of the last step [s]
  int with_inverted_tets = 0, first_inverted = 0;  // steps that end with an inverted tet, and the first of them
  double least_det_F = 1;                          // of all tets at the ends of steps
  std::vector<Resultant> reactions;                // of the last step, of each pin

  void add(const StepReport& report);
};

struct InvertedTets {
  int count = 0;         // of those with det F <= 0
  double least_det = 1;  // smallest det F of all tets
  std::string worst;     // which tet has it, and where: "tet 12 at (0, 0.1, 0.2) m"
};
InvertedTets inverted_tets(const Simulation& simulation);

struct RunEnd {
  int last_step = 0, steps_taken = 0;
  bool interrupted = false;
  double time_limit = 0;  // that ended the run [s]; 0: it did not
  bool blown_up = false;
  std::string solver;             // the methods and what they chose, and why; empty: none was needed
  InvertedTets inverted;          // of the last state
  std::uint64_t state_hash = 0;   // of the last state
  std::vector<std::string> pins;  // the names of RunTotals::reactions
  std::filesystem::path directory;
};

void print_summary(std::FILE* stream, const RunTotals& totals, const RunEnd& end);

}  // namespace aspic::cli
