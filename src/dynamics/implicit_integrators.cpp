// Backward Euler, its linearisation, and the static limit.
#include <algorithm>
#include <cmath>

#include "dynamics/integrator.h"
#include "dynamics/lead_pins.h"

namespace aspic {
namespace {

// q_new = argmin 1/2 (q - q~)' M (q - q~) + h^2 V(q),  qdot_new = (q_new - q_t) / h
class BackwardEuler : public Integrator {
 public:
  std::string_view name() const override { return "backward_euler"; }
  bool is_implicit() const override { return true; }
  Displacement displacement() const override { return Displacement::new_velocity; }

  MinimizeReport advance(const StepTools& tools, double h, State& state) override {
    q_ = state.q;
    predicted_.resize(q_.size());
    for (size_t i = 0; i < q_.size(); ++i) predicted_[i] = q_[i] + h * state.qdot[i];  // = 2 q_t - q_(t-1)
    tools.E.begin_step(predicted_, 1, h * h);
    MinimizeReport lead;
    start(tools, state.q, lead);
    MinimizeReport report =
        tools.minimizer.minimize(tools.E, tools.direction, state.q, adapted(tools.options), tools.observe);
    add_work(lead, report);
    for (size_t i = 0; i < q_.size(); ++i) state.qdot[i] = (state.q[i] - q_[i]) / h;
    state.time = tools.end_time;
    return finished(report);
  }

 protected:
  // Starts from the candidate of lower energy: where the body is, or where it would fly without forces. Pinned
  // vertices go where they must in both.
  virtual void start(const StepTools& tools, std::span<double> q, MinimizeReport& lead) {
    lead_pins(tools, q_, q, lead);
    tools.pins.place(tools.end_time, predicted_);
    if (tools.E.value(predicted_) <= tools.E.value(q)) std::copy(predicted_.begin(), predicted_.end(), q.begin());
  }
  virtual MinimizeOptions adapted(const MinimizeOptions& options) const { return options; }
  virtual MinimizeReport finished(const MinimizeReport& report) const { return report; }

 private:
  std::vector<double> q_, predicted_;  // q_t, q~
};

// One Newton iteration from the current state, without line search [Baraff and Witkin 1998].
class LinearlyImplicitEuler : public BackwardEuler {
 public:
  std::string_view name() const override { return "linearly_implicit_euler"; }

 protected:
  void start(const StepTools& tools, std::span<double> q, MinimizeReport&) override {
    tools.pins.place(tools.end_time, q);
  }
  MinimizeOptions adapted(const MinimizeOptions& options) const override {
    MinimizeOptions one = options;
    one.max_iterations = 1;
    one.max_forcing = 1e-10;
    one.line_search.test = DecreaseTest::none;
    one.line_search.alpha_max = 1;
    return one;
  }
  // The scheme asks for one iteration, not for a small gradient; what is left over stays in the report.
  MinimizeReport finished(const MinimizeReport& report) const override {
    MinimizeReport done = report;
    if (done.status == Status::iteration_limit) done.status = Status::converged;
    done.threshold = 0;
    return done;
  }
};

// q_new = argmin V(q)
class QuasiStatic : public Integrator {
 public:
  std::string_view name() const override { return "quasi_static"; }
  bool is_implicit() const override { return true; }
  bool is_static() const override { return true; }
  Displacement displacement() const override { return Displacement::any; }

  MinimizeReport advance(const StepTools& tools, double, State& state) override {
    tools.E.begin_step(state.q, 0, 1);
    q_ = state.q;
    MinimizeReport lead;
    lead_pins(tools, q_, state.q, lead);
    MinimizeReport report = tools.minimizer.minimize(tools.E, tools.direction, state.q, tools.options, tools.observe);
    add_work(lead, report);
    std::fill(state.qdot.begin(), state.qdot.end(), 0.0);
    state.time = tools.end_time;
    return report;
  }

 private:
  std::vector<double> q_;  // where the step starts
};

}  // namespace

std::unique_ptr<Integrator> make_backward_euler() { return std::make_unique<BackwardEuler>(); }
std::unique_ptr<Integrator> make_linearly_implicit_euler() { return std::make_unique<LinearlyImplicitEuler>(); }
std::unique_ptr<Integrator> make_quasi_static() { return std::make_unique<QuasiStatic>(); }

}  // namespace aspic
