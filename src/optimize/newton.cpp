#include "optimize/newton.h"

#include <cmath>
#include <utility>

namespace aspic {

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
  system_.begin_direction(at.stop, std::exchange(is_new_, false), gradient_norm);
  used_kept_ = system_.solve_with_kept(task, at.accuracy);
  return used_kept_ || policy_->compute(system_, task);
}

bool Newton::fall_back() {
  system_.drop_kept();
  return used_kept_ || policy_->fall_back();
}

}  // namespace aspic
