// Small models that several tests share.
#pragma once
#include <cmath>
#include <functional>
#include <string>

#include "dynamics/integrator.h"
#include "dynamics/simulation.h"
#include "energy/linear_load.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"
#include "material/lame.h"
#include "mesh/generators.h"
#include "verify/models.h"

namespace aspic::testing_models {

using namespace verify;  // NOLINT(google-build-using-namespace)

// The box beam of the benchmarks: [0, 4] x [0, 1] x [0, 1] m, 4n x n x n cells, face x = 0 fixed.
inline Model beam(int n, const ModelOptions& options = {}) {
  Model model = make_model(make_box({{0, 0, 0}}, {{4, 1, 1}}, {4 * n, n, n}), options);
  model.pins.push_back({"wall", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] < 1e-9; }), {}});
  return model;
}

inline Model damped_beam_with_moving_pins_and_targets(int n = 2) {  // n >= 2
  Model model = beam(n, {.young = 1e5, .poisson = 0.3});
  model.pins.push_back({"crank", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; }),
                        [](const Vec3d& X, double t) {
                          return X + Vec3d{{0, 0.2 * std::sin(8 * t), 0}};
                        }});
  model.loads.push_back(make_point_springs("pull", {{20, 500, [](double t) { return Vec3d{{2, t, 0}}; }}}));
  model.damping.push_back(make_rayleigh_damping(*model.mass, 0.5, model.elasticity[0].get(), 1e-3));
  model.damping.push_back(make_strain_rate_damping(model.mesh, 0, std::vector<double>(model.mesh.tet_count(), 50.0)));
  return model;
}

inline bool is_explicit(const std::string& integrator) { return !make_integrator(integrator)->facts().is_implicit; }

}  // namespace aspic::testing_models
