// Small models that several checks and tests share, and steps that must succeed.
#pragma once
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/model_builder.h"
#include "dynamics/modes.h"
#include "dynamics/simulation.h"

namespace aspic::verify {

struct ModelOptions {
  std::string material = "neo_hookean_log";
  double young = 1e6, poisson = 0.4, density = 1000;  // [Pa], [1], [kg/m^3]
  MassKind mass = MassKind::consistent;
  Vec3d gravity{{0, -9.81, 0}};  // [m/s^2]
};

// Returns the builder of one body of all the tets, with its weight as the first load; nothing is held yet.
ModelBuilder model_of(TetMesh mesh, const ModelOptions& options = {});
inline Model make_model(TetMesh mesh, const ModelOptions& options) {
  return model_of(std::move(mesh), options).build();
}

inline Simulation simulate(Model model, SimulationOptions options = {}) {  // from rest
  return Simulation(std::move(model), std::move(options));
}

// Throws std::runtime_error, naming `what`, when one of the steps does not converge.
void take_steps(Simulation& simulation, int count, const std::string& what);

// The `count` lowest vibrations about rest. Throws std::runtime_error when they cannot be computed.
std::vector<Mode> lowest_modes(const Model& model, int count);
std::vector<double> frequencies(const Model& model, int count);  // of lowest_modes() [Hz]

double largest(std::span<const double> values);  // absolute value; NaN when there is one
double largest_difference(std::span<const double> a, std::span<const double> b);  // of entries; same sizes

}  // namespace aspic::verify
