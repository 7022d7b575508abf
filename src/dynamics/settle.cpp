#include "dynamics/settle.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "contact/barrier.h"
#include "dynamics/incremental_potential.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation_checks.h"
#include "optimize/minimize.h"
#include "optimize/solver.h"

namespace aspic {
namespace {

constexpr int kMaxSteps = 200;
constexpr double kAtRest = 1e-3;  // maximum displacement in a step at rest, relative to the radius of the model

}  // namespace

std::optional<std::string> overlap(const Model& model, const std::vector<double>& q) {
  try {
    State state;
    state.q = q;
    require_apart(model, state, make_integrator("backward_euler")->facts());
    return {};
  } catch (const InvalidInput& e) {
    return e.what();
  }
}

std::set<int> pinned_vertices(const Model& model) {
  std::set<int> pinned;
  for (const Pin& pin : model.pins) pinned.insert(pin.vertices.begin(), pin.vertices.end());
  return pinned;
}

void settle(const Model& model, const std::vector<double>& start, std::vector<double>& q) {
  const Pins pins(model.pins, start);
  IncrementalPotential E(model, pins);
  const double radius = E.scales().x;
  double mass = 0;
  for (const double m : model.mass->vertex_mass()) mass += m;
  const double h2 = mass * radius * radius / E.sizes().growth_stiffness();  // square of a vibration period
  const std::unique_ptr<SearchDirection> direction = make_search_direction({});
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::vector<double> before = q;
    E.at({.predicted = before,
          .factor = h2,
          .context = StepContext{.start = before, .h = std::sqrt(h2), .time = 0, .obstacle_time = 0}});
    const MinimizeReport report = Minimizer().minimize(E, *direction, {q}, {.max_iterations = 100, .tolerance = 1e-3});
    if (!is_success(report.status)) return;
    double moved = 0;
    for (size_t i = 0; i < q.size(); ++i) moved = std::max(moved, std::abs(q[i] - before[i]));
    if (moved < kAtRest * radius) return;
  }
}

void without_other_terms(Model& model, const std::function<void()>& use) {
  const auto other = std::stable_partition(model.loads.begin(), model.loads.end(),
                                           [&](const auto& load) { return load.get() == model.contact; });
  std::vector<std::unique_ptr<Energy>> loads(std::make_move_iterator(other),
                                             std::make_move_iterator(model.loads.end()));
  model.loads.erase(other, model.loads.end());
  std::vector<std::unique_ptr<Energy>> damping = std::exchange(model.damping, {});
  use();
  model.damping = std::move(damping);
  model.loads.insert(model.loads.begin(), std::make_move_iterator(loads.begin()), std::make_move_iterator(loads.end()));
}

}  // namespace aspic
