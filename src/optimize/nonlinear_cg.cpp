#include "optimize/nonlinear_cg.h"

#include <algorithm>

namespace aspic {

std::string NonlinearCG::description() const { return "nonlinear_cg, preconditioner " + B_.description(); }

void NonlinearCG::begin() {
  B_.begin();
  length_.begin();
  remembers_ = conjugate_ = false;
}

bool NonlinearCG::fall_back() {
  remembers_ = false;
  return conjugate_;
}

bool NonlinearCG::compute(const Iterate& at, std::span<double> d, DirectionReport& report) {
  Objective& E = at.E;
  const std::span<const double> g = at.g;
  B_.set_stop(at.stop);
  for (auto* v : {&p_, &z_, &last_g_, &last_z_}) v->resize(at.x.size());
  if (!B_.apply(E, at.x, g, z_, report)) return false;
  const double b = remembers_ ? beta(E, g) : 0;
  for (size_t i = 0; i < p_.size(); ++i) p_[i] = b * p_[i] - z_[i];
  conjugate_ = b != 0 && E.dot(g, p_) < 0;
  if (!conjugate_)
    for (size_t i = 0; i < p_.size(); ++i) p_[i] = -z_[i];
  const double step = length_.along(at, p_, report);
  for (size_t i = 0; i < p_.size(); ++i) d[i] = step * p_[i];
  std::copy(g.begin(), g.end(), last_g_.begin());
  last_z_.swap(z_);
  remembers_ = true;
  return true;
}

// Returns the coefficient of Polak and Ribiere, or 0 (a restart) if it is negative [Nocedal and Wright 2006, eq. 5.45].
double NonlinearCG::beta(Objective& E, std::span<const double> g) {
  const double last = E.dot(last_g_, last_z_), change = E.dot(g, z_) - E.dot(last_g_, z_);
  return last > 0 ? std::max(0.0, change / last) : 0;
}

}  // namespace aspic
