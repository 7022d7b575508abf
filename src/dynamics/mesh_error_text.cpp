#include "dynamics/mesh_error_text.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/formatted.h"
#include "material/lame.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

constexpr double kEnough = 0.02;  // error that needs no remedy; quadratic tets reach it
constexpr double kNearlyEnough = 1.5 * kEnough;
constexpr double kLocking = 0.45;  // Poisson's ratio above which finer linear tets help slowly
constexpr double kFarFromIt = 1;   // error above which the prediction of the edges is too optimistic
constexpr double kClose = 0.85;    // edges that are no remedy, relative to the present ones
constexpr size_t kBodiesShown = 3;

// In percent, with two digits: "9 %", "220 %".
std::string percent(double fraction) {
  const double value = 100 * fraction;
  const double unit = value < 100 ? 1 : std::pow(10, std::floor(std::log10(value)) - 1);
  return formatted("%.0f %%", unit * std::round(value / unit));
}

// Rounds down to two digits.
double finer(double length) {
  const double unit = std::pow(10, std::floor(std::log10(length)) - 1);
  return unit * std::floor(length / unit * (1 + 1e-9));
}

double mean_edge(const TetMesh& mesh, const BodyRange& body) {
  double sum = 0;
  for (int t = body.first_tet; t < body.first_tet + body.tet_count; ++t)
    for (const auto& [a, b] : kTetEdges) sum += norm(mesh.rest[mesh.tets[t][a]] - mesh.rest[mesh.tets[t][b]]);
  return sum / (6.0 * body.tet_count);
}

double largest_poisson(const TetElasticity& V) {
  double largest = 0;
  for (const MaterialParameters& p : V.parameters())
    if (p.lame.mu > 0) largest = std::max(largest, poisson_ratio(p.lame));
  return largest;
}

// An error of the motion under some load shows in k only if this load stores most of the energy.
double largest_error(const BodyMeshError& body) {
  return body.motion < 1 ? std::max(body.stiffness, body.motion / (1 - body.motion)) : body.stiffness;
}

std::string remedy(const Model& model, size_t body, double k) {
  if (k <= kNearlyEnough) return "";
  const std::string reach = " would reach about 2 % where the solution is smooth.";
  const double edge = mean_edge(model.mesh, model.bodies[body]), fine = finer(edge * edge_factor(k, kEnough));
  if (k > kFarFromIt || largest_poisson(*model.elasticity[body]) > kLocking || fine > kClose * edge)
    return " `order = 2`" + reach;
  return formatted(" `order = 2`, or edges of %.2g m instead of %.2g m,", fine, edge) + reach;
}

std::string about(double k) { return k < 0.005 ? "less than 1 %" : "about " + percent(k); }

std::string effect(const BodyMeshError& body) {
  const double k = body.stiffness, motion = std::isnan(body.motion) ? k / (1 + k) : body.motion;
  return " (displacements err by " + percent(motion) + ")";
}

}  // namespace

std::string mesh_error_text(const MeshErrorEstimate& error, const Simulation& simulation) {
  if (!error.reason.empty()) return "no estimate: " + error.reason;
  const Model& model = simulation.model();
  std::vector<size_t> order;  // strained bodies, the worst first
  for (size_t b = 0; b < error.bodies.size(); ++b)
    if (!std::isnan(error.bodies[b].stiffness)) order.push_back(b);
  if (order.empty()) return "no estimate: nothing is strained";
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return largest_error(error.bodies[a]) > largest_error(error.bodies[b]); });
  const double worst = largest_error(error.bodies[order[0]]);
  std::string text = "makes";
  for (size_t i = 0; i < std::min(order.size(), kBodiesShown); ++i)
    text += std::string(i > 0 ? "," : "") + " '" + model.bodies[order[i]].name + "' " +
            about(error.bodies[order[i]].stiffness);
  text += " too stiff";
  if (order.size() == 1 && worst > kEnough) text += effect(error.bodies[order[0]]);
  if (order.size() > kBodiesShown)
    text += formatted("; %d more bodies less", static_cast<int>(order.size() - kBodiesShown));
  text += "." + remedy(model, order[0], worst);
  if (!error.is_reliable) text += " Unreliable: quadratic tets are unstable in this state.";
  return text + " An estimate.";
}

void add_mesh_error(const Simulation& simulation, const StopToken& stop, StepReport& report) {
  MeshErrorEstimate error = simulation.mesh_error(stop);
  report.mesh_error = mesh_error_text(error, simulation);
  if (!error.reason.empty()) return;
  const Renumbering& user = simulation.model().numbering.tet;
  double most = 0;
  report.mesh_stiffness = report.mesh_energy = 0;
  report.mesh_worst_tet = -1;
  for (const BodyMeshError& body : error.bodies) {
    report.mesh_energy += body.energy;
    if (body.stiffness > report.mesh_stiffness) report.mesh_stiffness = body.stiffness;
    if (body.worst_tet < 0 || error.density[body.worst_tet] <= most) continue;
    most = error.density[body.worst_tet];
    report.mesh_worst_tet = user.to_user(body.worst_tet);
  }
  report.mesh_density = std::move(error.density);
}

}  // namespace aspic
