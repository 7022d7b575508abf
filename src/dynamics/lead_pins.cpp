#include "dynamics/lead_pins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "contact/barrier.h"

namespace aspic {
namespace {

constexpr double kSmallestPart = 1.0 / 1024;
constexpr int kMaxParts = 200;

MinimizeOptions rough(const MinimizeOptions& options) {
  MinimizeOptions few = options;
  few.max_iterations = std::min(options.max_iterations, 8);
  few.criterion = Criterion::scale;
  few.tolerance = 1e-2;
  few.stop = options.stop.without_deadline();  // a step needs a start
  return few;
}

}  // namespace

bool is_free(const StepTools& tools, const ContactPath& path) {
  if (!tools.model.contact) return true;
  std::vector<double> d(path.to.begin(), path.to.end());
  for (size_t i = 0; i < d.size(); ++i) d[i] -= path.from[i];
  return tools.model.contact->max_step(path.from, d, path.start_time, path.end_time) >= 1;
}

void add_work(const MinimizeReport& spent, MinimizeReport& work) {
  work.add(spent);
  work.iterations += spent.iterations;
  work.trials += spent.trials;
  work.projected_hessians += spent.projected_hessians;
  work.projected_elements += spent.projected_elements;
  work.fallbacks += spent.fallbacks;
}

Evaluation lead_pins(const StepTools& tools, double time, std::span<const double> from, std::span<double> q,
                     MinimizeReport& work) {
  tools.pins.place(time, q);
  const Evaluation at_once = tools.E.evaluate(q);
  ++work.values;
  const auto time_at = [&](double part) {
    return part < 1 ? tools.obstacle_start + part * (time - tools.obstacle_start) : time;
  };
  if (std::isfinite(at_once.value) && is_free(tools, {from, q, time_at(0), time})) return at_once;
  const std::vector<double> to(q.begin(), q.end());

  std::vector<double> reached(from.begin(), from.end()), trial = reached, between = reached;
  double done = 0, part = 0.5;
  for (int i = 0; i < kMaxParts && part >= kSmallestPart; ++i) {
    const double next = std::min(1.0, done + part);
    for (size_t k = 0; k < trial.size(); ++k) between[k] = next < 1 ? from[k] + next * (to[k] - from[k]) : to[k];
    trial = reached;
    tools.pins.copy_held(between, trial);
    tools.E.move_obstacles(time_at(next));
    const Evaluation there = tools.E.evaluate(trial);
    ++work.values;
    if (!std::isfinite(there.value) || !is_free(tools, {reached, trial, time_at(done), time_at(next)})) {
      part /= 2;
      continue;
    }
    done = next;
    reached = trial;
    if (done == 1) {
      std::copy(reached.begin(), reached.end(), q.begin());
      return there;
    }
    const MinimizeReport spent =
        tools.minimizer.minimize(tools.E, tools.direction, {reached, there}, rough(tools.options), tools.observe);
    add_work(spent, work);
    if (spent.status == Status::interrupted) break;
    part *= 2;
  }
  return tools.model.contact ? Evaluation{std::numeric_limits<double>::infinity()} : at_once;
}

}  // namespace aspic
