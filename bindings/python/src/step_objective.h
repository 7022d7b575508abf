// The incremental potential of a time step, for loops written in Python.
#pragma once
#include <memory>
#include <vector>

#include "dynamics/incremental_potential.h"
#include "function.h"
#include "simulation.h"

namespace aspic::python {

class StepObjective : public Function {
 public:
  // Builds a model of its own, because a term can serve one objective only. `time`: at the start of the first step.
  static std::shared_ptr<StepObjective> make(const SceneSource& source, double time);

  Array begin_step(const py::object& q, const py::object& v, double h, const py::object& time);
  Array begin_statics(const py::object& q, const py::object& time);
  void set_pins_zero(std::span<double> d) const override { parts_->pins.set_zero(d); }
  void update_lagged(const py::object& q);
  bool is_lagged() const { return parts_->E.terms().is_lagged(); }
  double time() const { return time_; }

 private:
  struct Parts {
    explicit Parts(SceneModel made)
        : scene(std::move(made)), pins(scene.model.pins, scene.start.q), E(scene.model, pins) {}
    SceneModel scene;
    Pins pins;
    IncrementalPotential E;
  };

  StepObjective(std::unique_ptr<Parts> parts, std::shared_ptr<Callbacks> callbacks, double time);
  Array begin(const std::vector<double>& v, double h);
  static double end_time(const py::object& time, double usual);

  std::unique_ptr<Parts> parts_;
  std::vector<double> start_;  // q at the start of the step
  double time_ = 0;
};

}  // namespace aspic::python
