// Counts of the work done. Unlike times, they are reproducible.
#pragma once
#include "linalg/linear_solver.h"

namespace aspic {

struct Work {
  int values = 0, gradients = 0, hessians = 0;  // evaluations, each over all elements
  int factorizations = 0;                       // of the linear solver
  int linear_iterations = 0;                    // of conjugate gradients
  int products = 0, cycles = 0;                 // matrix products and multigrid cycles of linear solves

  void add(const Work& other) {
    values += other.values;
    gradients += other.gradients;
    hessians += other.hessians;
    factorizations += other.factorizations;
    linear_iterations += other.linear_iterations;
    products += other.products;
    cycles += other.cycles;
  }
  void add(const SolveReport& solved) {
    linear_iterations += solved.iterations;
    products += solved.products;
    cycles += solved.cycles;
  }
};

}  // namespace aspic
