#include "optimize/newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aspic {
namespace {

constexpr double kSmallest = 1e-8;
constexpr double kGamma = 0.9;
constexpr double kMatters = 0.1;  // safeguard: ignores the previous eta below this value

}  // namespace

double Forcing::at(double gradient_norm, const InnerAccuracy& accuracy) {
  if (gradient_norm == last_norm_) return eta_;  // the same iterate
  double eta = accuracy.loosest;
  if (last_norm_ > 0) {
    const double ratio = gradient_norm / last_norm_, held = kGamma * eta_ * eta_;
    eta = kGamma * ratio * ratio;
    if (held > kMatters) eta = std::max(eta, held);
  }
  last_norm_ = gradient_norm;
  return eta_ = std::min(accuracy.loosest, std::max({kSmallest, accuracy.enough, eta}));
}

std::unique_ptr<Newton> make_newton_cg(NewtonDefiniteness definiteness) {
  auto solver = std::make_unique<ConjugateGradient>(std::make_unique<BlockJacobi>(BlockJacobi::Blocks::modified));
  return std::unique_ptr<Newton>(new Newton(NewtonSystem(std::move(solver), true), definiteness));
}

std::string Newton::description() const {
  return std::string(name()) + ", definiteness " + std::string(to_string(definiteness_)) + ", " +
         solver().description();
}

void Newton::begin() {
  is_new_ = true;
  forcing_.begin();
  system_.begin();
  policy_->begin();
}

bool Newton::compute(const Iterate& at, std::span<double> d, DirectionReport& report) {
  const double gradient_norm = std::sqrt(at.E.dot(at.g, at.g));
  NewtonTask task{at.E, at.x, at.g, at.accuracy.value, forcing_.at(gradient_norm, at.accuracy), d, report};
  system_.begin_direction(at.E, at.stop, std::exchange(is_new_, false), gradient_norm);
  used_kept_ = system_.solve_with_kept(task, at.accuracy);
  return used_kept_ || policy_->compute(system_, task);
}

bool Newton::fall_back() {
  system_.drop_kept();
  return used_kept_ || policy_->fall_back();
}

}  // namespace aspic
