#include "dynamics/velocity_form.h"

namespace aspic {

void VelocityForm::gradient(std::span<const double> v, std::span<double> g) {
  E_.gradient(position(v), g);
  for (double& gi : g) gi /= h_;
}

double VelocityForm::max_step(std::span<const double> v, std::span<const double> d) {
  for (size_t i = 0; i < d.size(); ++i) dq_[i] = h_ * d[i];
  return E_.max_step(position(v), dq_);
}

std::span<const double> VelocityForm::position(std::span<const double> v) {
  for (size_t i = 0; i < v.size(); ++i) q_[i] = start_[i] + h_ * v[i];
  return q_;
}

void VelocityForm::velocity(std::span<const double> q, std::span<double> v) const {
  for (size_t i = 0; i < q.size(); ++i) v[i] = (q[i] - start_[i]) / h_;
}

}  // namespace aspic
