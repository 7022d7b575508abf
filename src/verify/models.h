// Small models that several checks and tests share, and steps that must succeed.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dynamics/modes.h"
#include "dynamics/simulation.h"

namespace aspic::verify {

struct ModelOptions {
  std::string material = "neo_hookean_log";
  double young = 1e6, poisson = 0.4, density = 1000;  // [Pa], [1], [kg/m^3]
  MassKind mass = MassKind::consistent;
  Vec3d gravity{{0, -9.81, 0}};  // [m/s^2]
};

// The constants of one tet; what only some materials have takes its default.
MaterialParameters parameters_of(const std::string& material, double young, double poisson);
// One body of all the tets, with its weight as the first load; nothing is held.
Model make_model(TetMesh mesh, const ModelOptions& options);

std::vector<int> vertices_where(const TetMesh& mesh, const std::function<bool(const Vec3d&)>& predicate);
std::vector<double> at_vertices(const TetMesh& mesh, const std::function<Vec3d(const Vec3d&)>& f);  // 3 per vertex
State at_rest(const TetMesh& mesh);
Simulation simulate(Model model, SimulationOptions options = {});  // from rest

// Throws std::runtime_error, naming `what`, when one of the steps does not converge.
void take_steps(Simulation& simulation, int count, const std::string& what);

// The `count` lowest vibrations about rest. Throws std::runtime_error when they cannot be computed.
std::vector<Mode> lowest_modes(const Model& model, int count);
std::vector<double> frequencies(const Model& model, int count);  // of lowest_modes() [Hz]

double largest(std::span<const double> values);  // absolute value; NaN when there is one
double largest_difference(std::span<const double> a, std::span<const double> b);  // of entries; same sizes

}  // namespace aspic::verify
