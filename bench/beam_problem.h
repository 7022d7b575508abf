// The benchmark beam, and what a program reports about it: the box [0,4] x [0,1] x [0,1] m of 4n x n x n cells,
// clamped at x = 0, falls from rest under gravity for ten steps of backward Euler.
#pragma once
#include "mesh/generators.h"

namespace aspic::bench {

inline constexpr double kYoung = 1e6;      // [Pa]
inline constexpr double kPoisson = 0.4;    // [1]
inline constexpr double kDensity = 1000;   // [kg/m^3]
inline constexpr double kGravity = -9.81;  // along y [m/s^2]
inline constexpr double kTimeStep = 0.01;  // [s]
inline constexpr int kSteps = 10;
inline constexpr double kTolerance = 1e-6;  // of the first gradient of each step

struct BeamResult {
  double seconds = 0;       // wall time of the steps and of what they need set up, without making the mesh
  double cpu_seconds = 0;   // of all threads
  int iterations = 0;       // of Newton's method, all steps
  double displacement = 0;  // of vertex (4, 0, 0) along y [m]
};

inline TetMesh make_beam(int n) { return make_box({0, 0, 0}, {4, 1, 1}, {4 * n, n, n}); }
inline int tip_vertex(int n) { return 4 * n * (n + 1) * (n + 1); }  // (4, 0, 0)
inline bool is_clamped(const TetMesh& mesh, int vertex) { return mesh.rest[vertex][0] == 0; }

BeamResult run_naive(int n);  // the most obvious program with Eigen
BeamResult run_aspic(int n);  // this library

}  // namespace aspic::bench
