#include "dynamics/modes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "dynamics/incremental_potential.h"
#include "linalg/cholesky.h"
#include "linalg/rank_one_updates.h"
#include "linalg/smallest_eigenpairs.h"

namespace aspic {
namespace {

// Shift relative to the squared rate of uniform growth, which is about E / (density size^2). It makes K + shift M
// positive definite also for free bodies. The rounding error of lambda is the machine precision times (shift +
// lambda)^2 / shift.
constexpr double kShift = 1e-4;
constexpr double kRigid = 1e-10;  // squared rates below this fraction count as zero

struct Stopped {};

// Returns K + shift M without the rows of pinned vertices.
BlockSparse shifted_stiffness(IncrementalPotential& E, std::span<const double> x, double shift) {
  E.at({.predicted = x, .inertia = shift, .context = StepContext{.start = x}});
  return E.evaluate_hessian(x, {Definiteness::exact});
}

// Returns the squared rate u' K u / u' M u [1/s^2] of uniform growth u of the rest shape. K contains only elasticity,
// because stiff springs, such as those that replace pins, do not change the scale of the lowest modes.
double growth_rate(const Model& model, const IncrementalPotential& E) {
  Vec3d center{};
  for (const Vec3d& X : model.mesh.rest) center = center + (1.0 / model.mesh.vertex_count()) * X;
  std::vector<double> rest, growth;
  for (const Vec3d& X : model.mesh.rest)
    for (int axis = 0; axis < 3; ++axis) {
      rest.push_back(X[axis]);
      growth.push_back(X[axis] - center[axis]);
    }
  for (auto* v : {&rest, &growth}) v->resize(3 * static_cast<size_t>(model.rows()), 0.0);
  BlockSparse K(E.pattern());
  for (size_t k = 0; k < model.elasticity.size(); ++k)
    E.terms().potential()[k].add_hessian(rest, 1, {Definiteness::exact}, K);
  std::vector<double> force(growth.size()), momentum(growth.size());
  K.multiply(growth, force);
  model.mass->multiply(growth, momentum);
  const double stiffness = std::inner_product(growth.begin(), growth.end(), force.begin(), 0.0);
  const double inertia = std::inner_product(growth.begin(), growth.end(), momentum.begin(), 0.0);
  return (stiffness > 0 ? stiffness : E.sizes().growth_stiffness()) / inertia;
}

int free_dimension(const Pins& pins) {
  double trace = 0;
  for (int v = 0; v < pins.rows(); ++v)
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d unit{};
      unit[axis] = 1;
      trace += pins.free_part(v, unit)[axis];
    }
  return static_cast<int>(std::lround(trace));
}

// Returns the rounding error of squared rates: the machine precision times a bound of the largest one.
double round_off(const Model& model, const Pins& pins, const BlockSparse& K) {
  double largest = 0;
  for (int v = 0; v < pins.rows(); ++v)
    if (!pins.holds(v)) largest = std::max(largest, trace(K.block[K.pattern->diagonal(v)]) / model.mass->row_mass()[v]);
  return 16 * std::numeric_limits<double>::epsilon() * largest;
}

Modes to_modes(Eigenpairs pairs, double zero) {
  Modes found{.status = pairs.converged ? ModesStatus::converged : ModesStatus::unconverged, .modes = {}};
  for (size_t k = 0; k < pairs.values.size(); ++k) {
    const double squared_rate = pairs.values[k];
    if (squared_rate < -zero) return {.status = ModesStatus::indefinite, .modes = {}};
    const bool is_rigid = squared_rate < zero;
    if (is_rigid) ++found.rigid;
    found.modes.push_back(
        {is_rigid ? 0 : std::sqrt(squared_rate) / (2 * std::numbers::pi), std::move(pairs.vectors[k])});
  }
  return found;
}

}  // namespace

Modes vibration_modes(const Model& model, std::span<const double> x, int count, const StopToken& stop) {
  const Pins pins(model.pins, x);
  IncrementalPotential E(model, pins);
  const double growth = growth_rate(model, E);
  ShiftedPencil pencil{.size = static_cast<int>(x.size()), .dimension = free_dimension(pins), .shift = kShift * growth};
  if (pencil.dimension == 0) return {.status = ModesStatus::all_held, .modes = {}};
  if (!(growth > 0) || !std::isfinite(growth)) return {.status = ModesStatus::indefinite, .modes = {}};

  const BlockSparse K = shifted_stiffness(E, x, pencil.shift);
  Cholesky cholesky;
  cholesky.analyze(*K.pattern);
  if (!cholesky.factorize(K))
    return {.status = cholesky.refused() ? ModesStatus::out_of_memory : ModesStatus::indefinite, .modes = {}};

  RankOneUpdates updates;
  SolveReport work;
  if (!updates.prepare(cholesky, E.traits().dense_rows->dense_rows(), 1e-12, work))
    return {.status = ModesStatus::unconverged, .modes = {}};
  pencil.project = [&](std::span<double> u) { pins.set_zero(u); };
  pencil.multiply_mass = [&](std::span<const double> u, std::span<double> Mu) { model.mass->multiply(u, Mu); };
  pencil.solve = [&](std::span<const double> b, std::span<double> u) {
    if (stop.stopped()) throw Stopped();
    cholesky.solve(b, u, 1e-12);
    updates.apply(u);
  };
  try {
    return to_modes(smallest_eigenpairs(pencil, count), std::max(kRigid * growth, round_off(model, pins, K)));
  } catch (const Stopped&) {
    return {.status = ModesStatus::interrupted, .modes = {}};
  }
}

std::string message(ModesStatus status) {
  switch (status) {
    case ModesStatus::converged:
      return "converged";
    case ModesStatus::all_held:
      return "pins fix every vertex, so no vibration is possible; pin fewer vertices";
    case ModesStatus::indefinite:
      return "the stiffness matrix is zero or has a negative eigenvalue, or a vertex has no mass, so there are no "
             "vibrations "
             "about "
             "these positions; choose the rest shape or a stable equilibrium";
    case ModesStatus::out_of_memory:
      return "the factorized stiffness matrix does not fit into the free memory; use a coarser mesh";
    case ModesStatus::unconverged:
      return "the eigenvalue iteration did not converge; request another number of modes";
    case ModesStatus::interrupted:
      return "the time limit passed before the modes were found";
  }
  return "";
}

}  // namespace aspic
