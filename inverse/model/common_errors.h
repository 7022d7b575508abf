// Residuals with common errors. Besides its own unit variance, r has an error along each direction n, times a standard
// normal number: the covariance is I + sum of n n'. L whitens it: L (I + sum of n n') L' = I. An unbounded error along
// n is projected out: L n = 0.
#pragma once
#include <span>
#include <vector>

#include "model/least_squares.h"

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
    void subtract(std::span<double> r) const;
  };
  std::vector<double> beside_others(int first, const std::vector<double>& n) const;

  std::vector<Direction> directions_;
};

// The stiffness k of an indenter's layer is a convention, so log k is unknown. A mesh that is too stiff around the
// indenter also acts like another layer, independently in each case. So log k, common to all cases, gets a normal
// error per case with the standard deviation kWeakPrior, unless the data state it. All fitted and compared models are
// treated this way.

// r as a function of p alone, for the most probable nuisance parameters q of each p. With r(p, q) linear in q,
//   min over q of |r(p, q)|^2 + |q / sigma|^2 = |L (r - N q_now)|^2,    N = dr/dq, q_now: the values in r,
// where L whitens the covariance I + N sigma^2 N'. An unbounded parameter is projected out.
class WithUncertainLayers : public LeastSquares {
 public:
  // Stores a reference to `data`. N is evaluated at the first p where r exists,
  // so that the problem remains one of least squares. With q_now at estimates(r), a minimum is one over p and q.
  explicit WithUncertainLayers(LeastSquares& data) : data_(data) {}

  int parameter_count() const override { return data_.parameter_count(); }
  int residual_count() const override { return data_.residual_count(); }
  int reading_count() const override { return data_.reading_count(); }
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override;
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;
  const CommonErrors& errors() const { return errors_; }

  // Most probable values of the bounded nuisance parameters for the residuals r of evaluate(), in the order of the
  // data.
  std::vector<double> estimates(std::span<const double> r) const;
  // L dr/dq of bounded parameter k.
  std::vector<double> whitened_direction(int k) const;
  int bounded_count() const { return static_cast<int>(bounded_.size()); }
  double sigma(int k) const { return bounded_[k].sigma; }

 private:
  struct Bounded {
    double sigma;
    std::vector<double> dr;
  };
  void find_directions();
  void add_bounded(const std::vector<double>& dr, const NuisancePrior& prior);

  LeastSquares& data_;
  CommonErrors errors_;
  std::vector<Bounded> bounded_;
  std::vector<double> shift_;  // -N q_now; empty: 0
  bool is_known_ = false, is_linearized_ = false;
};

}  // namespace aspic
