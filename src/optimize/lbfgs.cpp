#include "optimize/lbfgs.h"

#include <algorithm>
#include <cmath>

#include "math/vectors.h"

namespace aspic {
namespace {

// Minimum cosine between s and y of a pair with reliable curvature.
constexpr double kMinCosine = 1e-8;

}  // namespace

std::string LBFGS::description() const { return "lbfgs, preconditioner " + B_.description(); }

void LBFGS::begin() {
  B_.begin();
  length_.begin();
  count_ = 0;
  has_last_ = corrected_ = false;
}

bool LBFGS::fall_back() {
  count_ = 0;
  return corrected_;
}

void LBFGS::resize(size_t n) {
  for (auto* v : {&last_x_, &last_g_, &r_}) v->resize(n);
  for (Pair& pair : pairs_) pair.s.resize(n), pair.y.resize(n);
}

// Stores the last step as a pair if E has positive curvature along it. A second call at the same x adds no pair.
void LBFGS::remember(Objective& E, std::span<const double> x, std::span<const double> g) {
  if (has_last_) {
    Pair& pair = pairs_[next_];
    for (size_t i = 0; i < x.size(); ++i) pair.s[i] = x[i] - last_x_[i], pair.y[i] = g[i] - last_g_[i];
    const double sy = E.dot(pair.s, pair.y);
    if (sy > kMinCosine * std::sqrt(E.dot(pair.s, pair.s) * E.dot(pair.y, pair.y))) {
      pair.rho = 1 / sy;
      next_ = (next_ + 1) % kPairs;
      count_ = std::min(count_ + 1, kPairs);
    }
  }
  std::copy(x.begin(), x.end(), last_x_.begin());
  std::copy(g.begin(), g.end(), last_g_.begin());
  has_last_ = true;
}

bool LBFGS::compute(const Iterate& at, std::span<double> d, DirectionReport& report) {
  Objective& E = at.E;
  B_.set_stop(at.stop);
  resize(at.x.size());
  remember(E, at.x, at.g);
  corrected_ = count_ > 0;
  for (size_t i = 0; i < at.g.size(); ++i) r_[i] = -at.g[i];
  for (int age = 0; age < count_; ++age) {
    Pair& pair = recent(age);
    pair.weight = pair.rho * E.dot(pair.s, r_);
    add_scaled(-pair.weight, pair.y, r_);
  }
  if (!B_.apply(E, at.x, r_, d, report) || !scale(at, d, report)) return false;
  for (int age = count_ - 1; age >= 0; --age) {
    const Pair& pair = recent(age);
    add_scaled(pair.weight - pair.rho * E.dot(pair.y, d), pair.s, d);
  }
  return true;
}

// Scales directions unless B is the Hessian or, in the first iteration, the preconditioner of the objective. The first
// direction is scaled by the quadratic model along it, later ones by the last pair [Nocedal and Wright 2006, eq. 7.20].
bool LBFGS::scale(const Iterate& at, std::span<double> d, DirectionReport& report) {
  if (B_.kind() == PreconditionerKind::hessian) return true;
  if (B_.kind() == PreconditionerKind::own && count_ == 0) return true;
  double factor = 0;
  if (count_ == 0) {
    factor = length_.along(at, d, report);
  } else {
    const Pair& last = recent(0);
    if (!B_.apply(at.E, at.x, last.y, r_, report)) return false;
    factor = 1 / (last.rho * at.E.dot(last.y, r_));
  }
  for (double& di : d) di *= factor;
  return true;
}

}  // namespace aspic
