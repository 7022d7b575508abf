// What the data say against what was believed: the eigenpairs of
//   J'J w = d C^-1 w,   W' C^-1 W = I,
// where C is the covariance before the data. Along w the data are worth d times that belief, and the posterior is
//   (J'J + C^-1)^-1 = C - W diag(d / (1 + d)) W'.
#pragma once
#include "fit/columns.h"
#include "fit/gaussian.h"
#include "fit/least_squares.h"

namespace aspic {

struct Spectrum {
  bool ok = true;         // false: a product with J was not finite; there are no eigenpairs
  std::vector<double> d;  // descending, >= 0
  Columns W;              // their directions
  Columns dual;           // C^-1 W
  bool complete = false;  // W spans everything
  double missed = 0;      // no direction that is left out is worth much more than this
};

struct SpectrumOptions {
  int dense = 600;           // largest number of parameters or residuals with exact eigenpairs
  int max_rank = 200;        // else: directions looked for
  double negligible = 1e-1;  // value of d that is not worth looking for
  unsigned seed = 1;
};

// Where `data` is linearized. Beyond `dense`, directions are found by random sampling [Halko 2011] and their values by
// Nystroem's approximation, which never says more than the data: what it misses makes the posterior wider.
Spectrum spectrum(LeastSquares& data, Gaussian& before, const SpectrumOptions& options = {});

// The distribution once the data count. Refers to `before`.
class PosteriorGaussian : public Gaussian {
 public:
  PosteriorGaussian(PriorGaussian before, Spectrum spectrum);
  int size() const override { return before_.size(); }
  void precision(std::span<const double> v, std::span<double> y) override;
  void covariance(std::span<const double> v, std::span<double> z) override;
  PriorGaussian& before() { return before_; }
  const Spectrum& spectrum() const { return spectrum_; }

 private:
  PriorGaussian before_;
  Spectrum spectrum_;
};

}  // namespace aspic
