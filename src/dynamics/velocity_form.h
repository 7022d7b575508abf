// The objective of a step as a function of velocities: E(v) = 1/2 (v - v~)' M (v - v~) + V(q_t + h v), v~ = (q~ - q_t)
// / h. With q = q_t + h v it equals E(q) / h^2, where E(q) is the objective of backward Euler (w = 1, f = h^2). Its
// gradient is that of E(q) divided by h, and its Hessian is the same, so the Newton iterates are the same points.
#pragma once
#include <span>
#include <vector>

#include "dynamics/incremental_potential.h"

namespace aspic {

class VelocityForm : public Objective, public HasMetric {
 public:
  // Requires that E.at() was called; q_t is the start of the step. Both must outlive this object.
  VelocityForm(IncrementalPotential& E, std::span<const double> start /* q_t */, double h)
      : E_(E), start_(start), h_(h), q_(start.size()), dq_(start.size()) {}

  Evaluation evaluate(std::span<const double> v) override {  // [J]
    const Evaluation E = E_.evaluate(position(v));
    return {E.value / (h_ * h_), E.round_off / (h_ * h_)};
  }
  void gradient(std::span<const double> v, std::span<double> g) override;  // [N s]
  const BlockSparse& evaluate_hessian(std::span<const double> v, const Projection& projection) override {
    const BlockSparse& H = E_.hessian(position(v), projection);  // M + h^2 d2V/dq2 [kg]
    projected_elements_ = E_.projected_elements();
    return H;
  }
  double max_step(std::span<const double> v, std::span<const double> d) override;

  const BlockSparse& metric() override { return E_.metric(); }
  ObjectiveTraits traits() override { return {.metric = this}; }
  ObjectiveScales scales() const override {
    const ObjectiveScales s = E_.scales();
    return {s.x / h_, s.value / (h_ * h_), s.gradient / h_, s.gradient_unit / h_, s.gradient_round_off / h_};
  }

  // Convert between q = q_t + h v and v. The span that position() returns is valid until the next call.
  std::span<const double> position(std::span<const double> v);
  void velocity(std::span<const double> q, std::span<double> v) const;

 private:
  IncrementalPotential& E_;
  std::span<const double> start_;
  double h_;
  std::vector<double> q_, dq_;  // scratch: q_t + h v, h d
};

}  // namespace aspic
