// Small models for several tests.
#pragma once
#include <cmath>
#include <string>

#include "dynamics/integrator.h"
#include "dynamics/simulation.h"
#include "energy/linear_load.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"
#include "material/lame.h"
#include "mesh/generators.h"
#include "reference/models.h"

namespace aspic::testing_models {

using namespace verify;  // NOLINT(google-build-using-namespace)

// The box beam of the benchmarks: [0, 4] x [0, 1] x [0, 1] m, 4n x n x n cells, face x = 0 fixed.
inline ModelBuilder beam_builder(int n, const ModelOptions& options) {
  ModelBuilder builder = model_of(make_box({{0, 0, 0}}, {{4, 1, 1}}, {4 * n, n, n}), options);
  builder.pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; });
  return builder;
}
inline Model beam(int n, const ModelOptions& options = {}) { return beam_builder(n, options).build(); }

inline Model damped_beam_with_moving_pins_and_targets(int n = 2) {  // n >= 2
  return beam_builder(n, {.young = 1e5, .poisson = 0.3})
      .pin(
          "crank", [](const Vec3d& X) { return X[0] > 4 - 1e-9; },
          [](const Vec3d& X, double t) {
            return X + Vec3d{{0, 0.2 * std::sin(8 * t), 0}};
          })
      .load(make_point_springs("pull", {{20, 500,
                                         [](double t) {
                                           return Vec3d{{2, t, 0}};
                                         }}}))
      .rayleigh_damping(0.5, 1e-3)
      .strain_rate_damping(50)
      .build();
}

inline bool is_explicit(const std::string& integrator) { return !make_integrator(integrator)->facts().is_implicit; }

}  // namespace aspic::testing_models
