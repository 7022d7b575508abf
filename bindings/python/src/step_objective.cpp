#include "step_objective.h"

#include <cmath>

#include "base/error.h"

namespace aspic::python {

std::shared_ptr<StepObjective> StepObjective::make(const SceneSource& source, double time) {
  auto callbacks = std::make_shared<Callbacks>();
  SceneModel model = source.model(callbacks);
  std::unique_ptr<Parts> parts;
  {
    const ReleasedGil free;
    parts = std::make_unique<Parts>(std::move(model));
  }
  callbacks->rethrow();
  if (!parts->E.terms().internal().empty())
    throw InvalidInput("an Objective has no history, which '" + parts->E.terms().internal().names()[0] +
                       "' needs; use a Simulation, or remove [[body.viscoelastic]]");
  return std::shared_ptr<StepObjective>(new StepObjective(std::move(parts), std::move(callbacks), time));
}

StepObjective::StepObjective(std::unique_ptr<Parts> parts, std::shared_ptr<Callbacks> callbacks, double time)
    : Function(&parts->E, Layout::of_vertices(parts->scene.model.numbering.vertex, parts->scene.model.rows()),
               std::move(callbacks)),
      parts_(std::move(parts)),
      time_(time) {}

double StepObjective::end_time(const py::object& time, double usual) {
  if (time.is_none()) return usual;
  const auto given = time.cast<double>();
  if (!std::isfinite(given)) throw InvalidInput("time: must be finite");
  return given;
}

Array StepObjective::begin_step(const py::object& q, const py::object& v, double h, const py::object& time) {
  require_idle(occupancy_, "begin_step");
  const Use use(occupancy_, "objective");
  if (!(h > 0) || !std::isfinite(h)) throw InvalidInput("h: must be positive and finite [s]");
  const std::vector<double> velocity = layout().in(v, "v");
  start_ = layout().in(q, "q");
  time_ = end_time(time, time_ + h);
  return begin(velocity, h);
}

Array StepObjective::begin_statics(const py::object& q, const py::object& time) {
  require_idle(occupancy_, "begin_statics");
  const Use use(occupancy_, "objective");
  start_ = layout().in(q, "q");
  time_ = end_time(time, time_);
  return begin({}, 0);
}

Array StepObjective::begin(const std::vector<double>& v, double h) {
  const bool is_static = h == 0;
  const StepContext context{start_, h, time_, start_, time_ - h};
  std::vector<double> predicted = start_;
  for (size_t i = 0; i < v.size(); ++i) predicted[i] += h * v[i];
  parts_->E.at(
      {.predicted = predicted, .inertia = is_static ? 0.0 : 1.0, .factor = is_static ? 1 : h * h, .context = context});
  std::vector<double> first = start_;
  parts_->pins.place(time_, first);
  callbacks_->rethrow();
  return layout().out(first);
}

void StepObjective::update_lagged(const py::object& q) {
  require_idle(occupancy_, "update_lagged");
  const Use use(occupancy_, "objective");
  const std::vector<double> at = layout().in(q, "q");
  parts_->E.terms().update_lagged(at, false);
}

}  // namespace aspic::python
