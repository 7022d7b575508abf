// Information of the data relative to the prior: the eigenpairs of
//   J'J w = d C^-1 w,   W' C^-1 W = I,
// where C is the prior covariance. Along w the data have d times the information of the prior; the posterior has
//   (J'J + C^-1)^-1 = C - W diag(d / (1 + d)) W'.
#pragma once
#include <random>
#include <span>
#include <vector>

#include "math/vectors.h"
#include "model/least_squares.h"
#include "model/limits.h"
#include "model/regularizer.h"

namespace aspic {

// A tall matrix: a few hundred columns with many rows.
class Columns {
 public:
  Columns() = default;
  explicit Columns(int rows, int count = 0) : rows_(rows), values_(static_cast<size_t>(rows) * count) {}

  int rows() const { return rows_; }
  int count() const { return rows_ > 0 ? static_cast<int>(values_.size() / rows_) : 0; }
  std::span<double> operator[](int j) { return {values_.data() + static_cast<size_t>(rows_) * j, size_t(rows_)}; }
  std::span<const double> operator[](int j) const {
    return {values_.data() + static_cast<size_t>(rows_) * j, size_t(rows_)};
  }
  void push_back(std::span<const double> column) { values_.insert(values_.end(), column.begin(), column.end()); }

 private:
  int rows_ = 0;
  std::vector<double> values_;  // column-major
};

std::vector<double> product_transposed(const Columns& A, std::span<const double> v);               // A' v
std::vector<double> product_transposed(const Columns& A, const Columns& B);                        // A' B, column-major
void add_product(const Columns& A, std::span<const double> c, double scale, std::span<double> y);  // y += scale A c
// A C, where C has A.count() rows and `count` columns, column-major.
Columns product(const Columns& A, std::span<const double> C, int count);

// Normal distribution of the parameters, given by products with its precision (inverse covariance) and covariance.
class Gaussian {
 public:
  virtual ~Gaussian() = default;
  virtual int size() const = 0;
  virtual void precision(std::span<const double> v, std::span<double> y) = 0;   // y = C^-1 v
  virtual void covariance(std::span<const double> v, std::span<double> z) = 0;  // z = C v
};

// Prior exp(-weight R) with the curvature of R at p. Directions without curvature get a standard deviation of
// kUninformative, so that the distribution is proper.
class PriorGaussian : public Gaussian {
 public:
  // Stores a reference to the regularizer. Requires weight >= 0.
  PriorGaussian(Regularizer& regularizer, double weight, std::span<const double> p);

  int size() const override { return static_cast<int>(p_.size()); }
  void precision(std::span<const double> v, std::span<double> y) override;
  void covariance(std::span<const double> v, std::span<double> z) override;
  void sample(std::mt19937_64& random, std::span<double> x);  // zero mean

 private:
  Regularizer& regularizer_;
  double weight_, floor_;
  std::vector<double> p_;
};

struct Spectrum {
  bool ok = true;         // false: a product with J was not finite, and there are no eigenpairs
  std::vector<double> d;  // descending, >= 0
  Columns W;              // directions w
  Columns dual;           // C^-1 W
  bool complete = false;  // W spans the whole space
  double missed = 0;      // bound of d for omitted directions, approximately
};

struct SpectrumOptions {
  int dense = 600;           // maximum number of parameters or residuals for exact eigenpairs
  int max_rank = 200;        // otherwise: maximum number of directions
  double negligible = 1e-1;  // negligible value of d
  unsigned seed = 1;
};

// At the linearization of `data`. Beyond `dense`, random sampling [Halko 2011] finds directions and Nystroem's
// approximation their values. It never overestimates the information: omissions make the posterior wider.
Spectrum spectrum(LeastSquares& data, Gaussian& prior, const SpectrumOptions& options = {});

// Posterior distribution. Stores a reference to the prior.
class PosteriorGaussian : public Gaussian {
 public:
  PosteriorGaussian(PriorGaussian prior, Spectrum spectrum);
  int size() const override { return prior_.size(); }
  void precision(std::span<const double> v, std::span<double> y) override;
  void covariance(std::span<const double> v, std::span<double> z) override;
  PriorGaussian& prior() { return prior_; }
  const Spectrum& spectrum() const { return spectrum_; }

 private:
  PriorGaussian prior_;
  Spectrum spectrum_;
};

}  // namespace aspic
