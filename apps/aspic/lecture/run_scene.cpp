#include "aspic/lecture/run_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/barrier.h"
#include "contact/obstacle_surface.h"
#include "mesh/surface.h"

namespace aspic::cli::lecture {

OpenStep::OpenStep(Scene opened)
    : scene(std::move(opened)),
      h(scene.simulation.options().h),
      q_t(scene.simulation.state().q),
      qdot(scene.simulation.state().qdot),
      predicted(plus(q_t, h, qdot)),
      start(q_t),
      pins(model().pins, scene.simulation.snapshot().start.q),
      E(model(), pins) {
  const double end = scene.simulation.state().time + h;
  E.at({.predicted = predicted, .factor = h * h, .context = StepContext{q_t, h, end}});
  pins.place(end, start);
  pins.place(end, predicted);
}

Vector OpenStep::residual(std::span<const double> q) const {
  const Vector free = plus(q_t, h, qdot);  // q~ before the pins are moved
  Vector r = plus(mass_times(model(), plus(q, -1, free)), h * h, gradient_of_potential(model(), q));
  pins.set_zero(r);
  return r;
}

double OpenStep::smallest_mass() const {
  const auto mass = model().mass->vertex_mass();
  return *std::min_element(mass.begin(), mass.end()) / 5;
}

Vector gradient_of_potential(const Model& model, std::span<const double> q) {
  Vector g(q.size(), 0.0);
  for (const auto& V : model.elasticity) V->add_gradient(q, 1, g);
  for (const auto& V : model.loads) ActiveTerm(*V).add_gradient(q, 1, g);
  return g;
}

double potential(const Model& model, std::span<const double> q) {
  double sum = 0;
  for (const auto& V : model.elasticity) sum += V->value(q);
  for (const auto& V : model.loads) sum += ActiveTerm(*V).value(q);
  return sum;
}

Vector mass_times(const Model& model, std::span<const double> a) {
  Vector Ma(a.size());
  model.mass->multiply(a, Ma);
  return Ma;
}

Vector plus(std::span<const double> a, double factor, std::span<const double> b) {
  Vector sum(a.begin(), a.end());
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += factor * b[i];
  return sum;
}

Vector scaled(std::span<const double> a, double factor) {
  Vector product(a.begin(), a.end());
  for (double& x : product) x *= factor;
  return product;
}

Vector smooth_direction(const OpenStep& step) {
  Vector d(step.q_t.size());
  for (size_t i = 0; i < d.size(); ++i) {
    const Vec3d& X = step.model().mesh.rest[i / 3];
    const double phase = static_cast<double>(i % 3);
    d[i] = std::sin(7 * X[0] + phase) * std::cos(5 * X[1] - phase) + std::sin(6 * X[2] + 2 * phase);
  }
  step.pins.set_zero(d);
  const double size = norm(d);
  for (double& x : d) x /= size;
  return d;
}

std::vector<char> fixed_entries(const OpenStep& step) {
  std::vector<char> fixed(step.q_t.size());
  for (size_t i = 0; i < fixed.size(); ++i) fixed[i] = step.pins.holds(static_cast<int>(i / 3));
  return fixed;
}

double observed_order(const Vector& step, const Vector& error) {
  return std::log(error.front() / error.back()) / std::log(step.front() / step.back());
}

TriMesh surface_at(const Model& model, std::span<const double> q) {
  BoundarySurface boundary = boundary_surface(model.mesh);
  for (size_t i = 0; i < boundary.tet_vertex.size(); ++i)
    for (int r = 0; r < 3; ++r) boundary.surface.vertices[i][r] = q[3 * boundary.tet_vertex[i] + r];
  return boundary.surface;
}

Run run(Simulation& simulation, int steps, const AfterStep& after, const IterationObserver& observe) {
  Run result;
  for (int i = 0; i < steps; ++i) {
    const StepReport report = simulation.step(observe);
    result.reports.push_back(report);
    result.unconverged += !is_success(report.status);
    result.iterations += report.iterations;
    const double energy = report.kinetic + report.potential_total;
    if (report.status == Status::undefined || !std::isfinite(energy)) {
      result.largest_energy = INFINITY;
      break;
    }
    result.largest_energy = std::max(result.largest_energy, energy);
    const double size = std::max({std::abs(report.kinetic), std::abs(report.potential_total), std::abs(report.pin_work),
                                  std::abs(report.numerical_loss)});
    result.largest_ledger_error = std::max(result.largest_ledger_error, std::abs(report.ledger_error) / size);
    if (after) after(report);
  }
  return result;
}

Scene in_motion(Scene scene, int steps) {
  for (int i = 0; i < steps; ++i) scene.simulation.step();
  return scene;
}

ShadedSurface all_surfaces(const Simulation& simulation) {
  const Model& model = simulation.model();
  const State& state = simulation.state();
  const BoundarySurface bodies = boundary_surface(model.mesh);
  ShadedSurface all{.caption = fmt::format("t = {:.1f} s", state.time), .surface = surface_at(model, state.q)};
  for (const int v : bodies.tet_vertex) all.values.push_back(norm(point(state.qdot, v)));
  const Barrier& contact = *model.contact;
  const std::vector<Vec3d> points = contact.obstacle_points(simulation.obstacle_time());
  for (const ObstacleSurface& obstacle : obstacle_surfaces(contact.mesh(), points)) {
    if (obstacle.plane) continue;
    const int first = static_cast<int>(all.surface.vertices.size());
    for (const Triangle& t : obstacle.surface.triangles)
      all.surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (const Vec3d& x : obstacle.surface.vertices) {
      all.surface.vertices.push_back(x);
      all.values.push_back(std::numeric_limits<double>::quiet_NaN());
    }
  }
  return all;
}

}  // namespace aspic::cli::lecture
