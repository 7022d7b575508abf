// Gradient descent: d = -B^-1 g, where B is the identity if not chosen otherwise.
#pragma once
#include "optimize/preconditioner.h"
#include "optimize/search_direction.h"

namespace aspic {

class GradientDescent : public SearchDirection {
 public:
  explicit GradientDescent(Preconditioner B = Preconditioner(PreconditionerKind::none)) : B_(std::move(B)) {}
  std::string_view name() const override { return "gradient_descent"; }
  std::string description() const override;
  void begin() override { B_.begin(); }
  bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) override;

 private:
  Preconditioner B_;
};

}  // namespace aspic
