// Rows of the Hessian that its blocks do not hold: those of nearly incompressible elements and of cavities.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "dynamics/pins.h"
#include "dynamics/step_terms.h"
#include "energy/dense_energy.h"
#include "energy/stiff_energy.h"
#include "optimize/objective.h"

namespace aspic {

class TermRows : public HasStiffRows, public HasDenseRows {
 public:
  TermRows(const StepTerms& terms, const Pins& pins);  // both must outlive this

  void evaluate(std::span<const double> q, double factor);  // of factor times the Hessian of V

  const StiffRows& stiff_rows() const override { return stiff_rows_; }
  const DenseRows& dense_rows() const override { return dense_rows_; }

 private:
  const StepTerms& terms_;
  const Pins& pins_;
  std::vector<std::pair<const StiffEnergy*, size_t>> stiff_;  // with the index in V
  std::vector<std::pair<const DenseEnergy*, size_t>> dense_;
  StiffRows stiff_rows_;
  DenseRows dense_rows_;
};

}  // namespace aspic
