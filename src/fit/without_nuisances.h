// The part of residuals that no nuisance can explain: r and J projected onto what is orthogonal to all dr/d(nuisance).
// It is what remains when the nuisances are fitted along, with nothing known of them.
#pragma once
#include <vector>

#include "fit/columns.h"
#include "fit/least_squares.h"

namespace aspic {

class WithoutNuisances : public LeastSquares {
 public:
  explicit WithoutNuisances(LeastSquares& data) : data_(data) {}
  int unknowns() const override { return data_.unknowns(); }
  int residual_count() const override { return data_.residual_count(); }
  bool evaluate(std::span<const double> p, std::span<double> r) override { return data_.evaluate(p, r); }
  bool linearize() override;
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;
  void project(std::span<double> r) const;  // after linearize()
  int dropped() const { return directions_.count(); }

 private:
  LeastSquares& data_;
  Columns directions_;  // orthonormal
};

}  // namespace aspic
