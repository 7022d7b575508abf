// Work of steps as counts, which are equal in every run, unlike times.
#pragma once
#include <array>
#include <string_view>

#include "dynamics/step_report.h"

namespace aspic::bench {

struct StepCounts {
  long iterations = 0, trials = 0, values = 0, gradients = 0, hessians = 0;
  long factorizations = 0, linear_iterations = 0, products = 0, cycles = 0;
};

struct NamedCount {
  std::string_view name;
  long StepCounts::*count;
};
inline constexpr std::array<NamedCount, 9> kCounts = {{
    {"iterations", &StepCounts::iterations},                // iterations of the minimizer
    {"trials", &StepCounts::trials},                        // trials of the line search
    {"values", &StepCounts::values},                        // evaluations of E, each over all elements
    {"gradients", &StepCounts::gradients},                  // evaluations of the gradient
    {"hessians", &StepCounts::hessians},                    // evaluations of the Hessian
    {"factorizations", &StepCounts::factorizations},        //
    {"linear_iterations", &StepCounts::linear_iterations},  //
    {"products", &StepCounts::products},                    // products with the matrix
    {"cycles", &StepCounts::cycles},                        // cycles of multigrid
}};

inline void add_counts(const StepReport& report, StepCounts& counts) {
  counts.iterations += report.iterations;
  counts.trials += report.trials;
  counts.values += report.values;
  counts.gradients += report.gradients;
  counts.hessians += report.hessians;
  counts.factorizations += report.factorizations;
  counts.linear_iterations += report.linear_iterations;
  counts.products += report.products;
  counts.cycles += report.cycles;
}

}  // namespace aspic::bench
