// Small models shared by checks and tests, and steps that must converge.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/model_builder.h"
#include "dynamics/modes.h"
#include "dynamics/simulation.h"

namespace aspic::verify {

// Pins the vertices (empty: all) in their planes along an axis, except those that other pins hold: plane strain.
void hold_plane(Model& model, int axis = 2, std::vector<int> vertices = {});

// A body of one layer of cells, for plane problems: length x height cells of equal size, one cell thick, mapped from
// [0, 1]^2 by `place`; thickness `thickness`.
TetMesh make_layer(int length, int height, double thickness,
                   const std::function<std::array<double, 2>(double, double)>& place);

// Moduli for which plane strain equals plane stress with E and nu.
struct PlaneModuli {
  double young, poisson;
};
PlaneModuli plane_stress(double young, double poisson);

// Momenta of a simulation.
struct Momenta {
  Vec3d linear, angular;  // sum of p [kg m/s], and of x cross p [kg m^2/s]
};
Momenta momenta(const Simulation& simulation);

// One cubic meter of 1000 kg/m^3, stretched by 1.2 along z, rotating at 6 rad/s about z and moving at 2 m/s along x.
Simulation spinning_box(const std::string& integrator, double h, const Vec3d& gravity, double young);

struct ModelOptions {
  std::string material = "neo_hookean_log";
  double young = 1e6, poisson = 0.4, density = 1000;  // [Pa], [1], [kg/m^3]
  MassKind mass = MassKind::consistent;
  Vec3d gravity{{0, -9.81, 0}};  // [m/s^2]
};

// Returns a builder with one body of all tets and its weight as the first load, without pins.
ModelBuilder model_of(TetMesh mesh, const ModelOptions& options = {});
inline Model make_model(TetMesh mesh, const ModelOptions& options) {
  return model_of(std::move(mesh), options).build();
}

inline Simulation simulate(Model model, SimulationOptions options = {}) {  // starts from rest
  return Simulation(std::move(model), std::move(options));
}

// Takes steps. Throws std::runtime_error with `what` if one of them does not converge.
void take_steps(Simulation& simulation, int count, const std::string& what);

// Returns the `count` lowest vibration modes about rest. Throws std::runtime_error if they cannot be computed.
std::vector<Mode> lowest_modes(const Model& model, int count);
std::vector<double> frequencies(const Model& model, int count);  // frequencies of lowest_modes() [Hz]

double largest_difference(std::span<const double> a, std::span<const double> b);  // max_abs(a - b)

}  // namespace aspic::verify
