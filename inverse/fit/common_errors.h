// Residuals with common errors. Besides its own unit variance, r has an error along each direction n, times a standard
// normal number: the covariance is I + sum of n n'. L whitens it: L (I + sum of n n') L' = I. An unbounded error along
// n is projected out: L n = 0.
#pragma once
#include <span>
#include <vector>

#include "fit/least_squares.h"

namespace aspic {

class CommonErrors {
 public:
  // Adds n for the residuals from `first` on, 0 elsewhere. The length of n is the standard deviation along it.
  void add(int first, std::vector<double> n);
  void add_unbounded(std::vector<double> n);         // for all residuals, after all other directions
  void apply(std::span<double> r) const;             // r := L r
  void apply_transposed(std::span<double> w) const;  // w := L' w

 private:
  struct Direction {
    int first;
    std::vector<double> unit;
    double taken;  // removed fraction along it: 0 none, 1 all
    void take_off(std::span<double> r) const;
  };
  std::vector<double> beside_others(int first, const std::vector<double>& n) const;

  std::vector<Direction> directions_;
};

// The stiffness k of an indenter's layer is a convention, so log k is unknown. A mesh that is too stiff around the
// indenter also acts like another layer, independently in each case. So log k, common to all cases, gets a normal
// error per case with the standard deviation kLayerSigma. All fitted and compared models are treated this way.
inline constexpr double kLayerSigma = 3;  // a factor of 20

class WithUncertainLayers : public LeastSquares {
 public:
  // Stores a reference to `data`, whose nuisance directions it projects out and whose common error it whitens. They are
  // evaluated at the first p where r exists, so that the problem remains one of least squares.
  explicit WithUncertainLayers(LeastSquares& data) : data_(data) {}

  int parameter_count() const override { return data_.parameter_count(); }
  int residual_count() const override { return data_.residual_count(); }
  int reading_count() const override { return data_.reading_count(); }
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
