// Residuals with errors in common. Beside one of its own of length 1, r has an error along each of some directions n,
// times a normal number: its covariance is I + sum of n n'. L makes it independent again: L (I + sum of n n') L' = I.
// Along a direction of which nothing is known the error has no bounds, and L takes r off it: L n = 0.
#pragma once
#include <span>
#include <vector>

#include "fit/least_squares.h"

namespace aspic {

class CommonErrors {
 public:
  // n: of the residuals from `first` on, and 0 elsewhere. As long as it is, so uncertain they are along it.
  void add(int first, std::vector<double> n);
  void add_unbounded(std::vector<double> n);         // of all residuals, after all others
  void apply(std::span<double> r) const;             // r := L r
  void apply_transposed(std::span<double> w) const;  // w := L' w

 private:
  struct Direction {
    int first;
    std::vector<double> unit;
    double taken;  // of the part along it: 0 none, 1 all
    void take_off(std::span<double> r) const;
  };
  std::vector<double> beside_others(int first, const std::vector<double>& n) const;

  std::vector<Direction> directions_;
};

// How stiff the layer of a tip is, is a convention: nothing is known of log k. And a body whose mesh is too stiff
// around the tip behaves as under another layer, in each case by itself: to log k, common to all cases, a normal number
// of its own is added with the deviation kLayerDeviation. All models that are fitted and judged are taken so.
inline constexpr double kLayerDeviation = 3;  // a factor of 20

class WithUncertainLayers : public LeastSquares {
 public:
  // Refers to `data`, whose nuisances it takes in. They are those of the first p where r exists, so that the problem
  // remains one of least squares.
  explicit WithUncertainLayers(LeastSquares& data) : data_(data) {}

  int unknowns() const override { return data_.unknowns(); }
  int residual_count() const override { return data_.residual_count(); }
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override;
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;
  const CommonErrors& errors() const { return errors_; }

 private:
  void learn();

  LeastSquares& data_;
  CommonErrors errors_;
  bool is_known_ = false, is_linearized_ = false;
};

}  // namespace aspic
