#include "dynamics/runge_kutta.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/acceleration.h"
#include "dynamics/implicit_stage.h"

namespace aspic {
namespace {

class RungeKutta : public Integrator {
 public:
  explicit RungeKutta(const Tableau& tableau) : Integrator(tableau.facts), t_(tableau) {
    for (int i = 0; i < t_.stages; ++i) {
      for (int j = 0; j <= i; ++j) c_[i] += t_.A[i][j];
      if (std::abs(c_[i] - 1) < 1e-14) c_[i] = 1;  // exactly the end of the step
    }
    const double* last = t_.A[t_.stages - 1];
    ends_with_last_stage_ = std::equal(last, last + t_.stages, t_.b);
  }

  void set_pin_velocity(const Pins& pins, double h, State& state) const override {
    PinPath path;
    path.sample(pins, state.time, state.time + h, pin_path_points(facts().order));
    path.place_velocity(state.time, state.qdot);
  }

  StepSolve advance(const StepTools& tools, State& end, StepForces& forces) override {
    const State& start = tools.start;
    resize(start.q.size());
    forces.reset(start.q.size());
    path_.sample(tools.pins, start.time, tools.end_time, pin_path_points(facts().order));
    StepSolve solve;
    for (int i = 0; i < t_.stages; ++i) {
      const bool ok = t_.A[i][i] > 0 ? solve_implicitly(tools, i, solve, forces) : evaluate(tools, i, solve, forces);
      if (!ok) return solve;
    }
    finish(tools, forces, end);
    const bool finite = std::all_of(end.q.begin(), end.q.end(), [](double x) { return std::isfinite(x); });
    if (!finite) solve.work.status = Status::undefined;
    return solve;
  }

 private:
  void resize(size_t n) {
    for (auto* all : {&q_, &v_, &acc_})
      for (int i = 0; i < t_.stages; ++i) (*all)[i].resize(n);
    for (auto* v : {&stage_.a, &stage_.b}) v->resize(n);
  }

  double time_of(const StepTools& tools, int i) const {
    return c_[i] == 1 ? tools.end_time : tools.start.time + c_[i] * tools.h;
  }

  // Fraction of the time budget at which stage i ends: implicit stages have equal shares.
  double budget_fraction(int i) const {
    int done = 0, all = 0;
    for (int j = 0; j < t_.stages; ++j)
      if (t_.A[j][j] > 0) ++all, done += j <= i;
    return static_cast<double>(done) / all;
  }

  // Adds the contributions of the earlier stages.
  void combine(const StepTools& tools, int i, std::span<double> q, std::span<double> v) const {
    std::copy(tools.start.q.begin(), tools.start.q.end(), q.begin());
    std::copy(tools.start.qdot.begin(), tools.start.qdot.end(), v.begin());
    for (int j = 0; j < i; ++j) {
      const double weight = tools.h * t_.A[i][j];
      if (weight == 0) continue;
      for (size_t k = 0; k < q.size(); ++k) {
        q[k] += weight * v_[j][k];
        v[k] += weight * acc_[j][k];
      }
    }
  }

  bool solve_implicitly(const StepTools& tools, int i, StepSolve& solve, StepForces& forces) {
    combine(tools, i, stage_.a, stage_.b);
    q_[i] = i > 0 ? q_[i - 1] : tools.start.q;
    v_[i] = i > 0 ? v_[i - 1] : tools.start.qdot;
    const StageOptions options{.beta = tools.h * t_.A[i][i],
                               .time = time_of(tools, i),
                               .weight = t_.b[i],
                               .ahead = tools.h * (c_[i] - (i > 0 ? c_[i - 1] : 0)),
                               .budget_fraction = budget_fraction(i),
                               .path = &path_};
    return stage_.solve(tools, options, {q_[i], v_[i], acc_[i]}, solve, forces);
  }

  bool evaluate(const StepTools& tools, int i, StepSolve& solve, StepForces& forces) {
    combine(tools, i, q_[i], v_[i]);
    const double time = time_of(tools, i);
    if (i > 0) tools.pins.place(time, q_[i]);
    path_.place_velocity(time, v_[i]);
    std::fill(acc_[i].begin(), acc_[i].end(), 0.0);
    path_.place_acceleration(time, acc_[i]);
    MinimizeReport report;
    report.iterations = facts().is_implicit ? 0 : 1;
    const MotionPoint at{time, q_[i], v_[i], DampingDifference::central, t_.b[i]};
    const bool solved = force_.solve(tools, at, acc_[i], forces, report);
    forces.add_round_off(tools.E, t_.b[i] * force_.round_off());
    const bool finite = std::all_of(acc_[i].begin(), acc_[i].end(), [](double x) { return std::isfinite(x); });
    report.status = finite && solved ? Status::converged : Status::undefined;
    return solve.add(report);
  }

  void finish(const StepTools& tools, const StepForces& forces, State& end) const {
    end.time = tools.end_time;
    if (ends_with_last_stage_) {
      end.q = q_[t_.stages - 1];
      end.qdot = v_[t_.stages - 1];
      return;
    }
    end.q = tools.start.q;
    end.qdot = tools.start.qdot;
    for (size_t k = 0; k < end.q.size(); ++k) {
      double velocity = 0;
      for (int i = 0; i < t_.stages; ++i) velocity += t_.b[i] * v_[i][k];
      end.q[k] += tools.h * velocity;
      end.qdot[k] += tools.h * forces.acceleration[k];
    }
    tools.pins.place(end.time, end.q);
    path_.place_velocity(end.time, end.qdot);
  }

  Tableau t_;
  bool ends_with_last_stage_ = false;
  std::array<double, kMaxStages> c_{};  // times of the stages relative to the step

  std::array<std::vector<double>, kMaxStages> q_, v_, acc_;
  ImplicitStage stage_;
  Acceleration force_;
  PinPath path_;
};

}  // namespace

std::unique_ptr<Integrator> make_runge_kutta(const Tableau& tableau) { return std::make_unique<RungeKutta>(tableau); }

}  // namespace aspic
