// The benchmark beam: the box [0,4] x [0,1] x [0,1] m of 4n x n x n cells, clamped at x = 0, falls from rest under
// gravity with backward Euler. Also the results that a program reports.
#pragma once
#include "bench/stopwatch.h"
#include "mesh/generators.h"

namespace aspic::bench {

inline constexpr double kYoung = 1e6;      // [Pa]
inline constexpr double kPoisson = 0.4;    // [1]
inline constexpr double kDensity = 1000;   // [kg/m^3]
inline constexpr double kGravity = -9.81;  // along y [m/s^2]
inline constexpr double kTimeStep = 0.01;  // [s]

struct BeamProblem {
  int n = 7;
  double young = kYoung;         // [Pa]
  double time_step = kTimeStep;  // [s]
  int steps = 10;                //
  double tolerance = 1e-6;       // relative to the first gradient of each step
};
inline BeamProblem falling_beam(int n) { return {.n = n}; }  // indenter moves 5 cm
inline BeamProblem bent_beam(int n) {
  return {.n = n, .young = 1e5, .time_step = 1.0 / 30, .steps = 30};
}  // indenter moves 5 m

inline TetMesh make_beam(int n) { return make_box({0, 0, 0}, {4, 1, 1}, {4 * n, n, n}); }
inline int tip_vertex(int n) { return 4 * n * (n + 1) * (n + 1); }  // vertex at (4, 0, 0)
inline bool is_clamped(const TetMesh& mesh, int vertex) { return mesh.rest[vertex][0] == 0; }

struct BeamResult {
  Seconds set_up;      // mesh, terms, and other work before the first step
  Seconds steps;       // all steps, including one-time work in the first one
  int iterations = 0;  // Newton iterations of all steps
  int linear_iterations = 0;
  double displacement = 0;  // displacement of vertex (4, 0, 0) along y [m]
  bool converged = true;    // whether every step converged

  Seconds total() const { return {set_up.wall + steps.wall, set_up.processor + steps.processor}; }
};

BeamResult run_naive(const BeamProblem& problem);  // straightforward implementation with Eigen

}  // namespace aspic::bench
