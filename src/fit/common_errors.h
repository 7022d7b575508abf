// Residuals with errors in common. Beside one of its own of length 1, r has an error along each of some directions n,
// times a normal number: its covariance is I + sum of n n'. L makes it independent again: L (I + sum of n n') L' = I.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "fit/least_squares.h"

namespace aspic {

class CommonErrors {
 public:
  // n: of the residuals from `first` on, and 0 elsewhere. As long as it is, so uncertain they are along it.
  void add(int first, std::vector<double> n);
  void apply(std::span<double> r) const;             // r := L r
  void apply_transposed(std::span<double> w) const;  // w := L' w

 private:
  struct Direction {
    int first;
    std::vector<double> unit;
    double taken;  // of the part along it: 0 none, 1 all
    void take_off(std::span<double> r) const;
  };
  std::vector<Direction> directions_;
};

// How stiff the layer of a tip is, is a convention, and a body whose mesh is too stiff around the tip behaves as under
// another one: what the readings of a case say along dr/dlog k is hardly any knowledge of the body. log k is taken for
// a normal number with the deviation kLayerDeviation, another one in each case.
inline constexpr double kLayerDeviation = 3;  // a factor of 20

class WithUncertainLayers : public LeastSquares {
 public:
  // `cases`: of the residuals, first and count. Refers to `data`. dr/dlog k is that of the first p where r exists, so
  // that the problem remains one of least squares.
  WithUncertainLayers(LeastSquares& data, std::vector<std::pair<int, int>> cases)
      : data_(data), cases_(std::move(cases)) {}

  int unknowns() const override { return data_.unknowns(); }
  int residual_count() const override { return data_.residual_count(); }
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override;
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;
  int nuisance_count() const override { return data_.nuisance_count(); }
  void nuisance(int k, std::span<double> dr) override;
  const CommonErrors& errors() const { return errors_; }

 private:
  void learn();

  LeastSquares& data_;
  std::vector<std::pair<int, int>> cases_;
  CommonErrors errors_;
  bool is_known_ = false;
};

}  // namespace aspic
