#include "estimate/spectrum.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "linalg/dense_eigen.h"

namespace aspic {
namespace {

std::span<const double> column(const std::vector<double>& A, int rows, int j) {
  return {A.data() + static_cast<size_t>(rows) * j, static_cast<size_t>(rows)};
}

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool all_finite(const Columns& A) {
  for (int j = 0; j < A.count(); ++j)
    if (!all_finite(A[j])) return false;
  return true;
}

Spectrum nothing(int parameter_count, bool ok) {
  return {.ok = ok, .W = Columns(parameter_count), .dual = Columns(parameter_count)};
}

// Columns times diag(factor).
void scale_columns(Columns& A, std::span<const double> factor) {
  for (int j = 0; j < A.count(); ++j)
    for (double& a : A[j]) a *= factor[j];
}

std::vector<double> powers(std::span<const double> values, double exponent) {
  std::vector<double> result;
  for (const double v : values) result.push_back(std::pow(v, exponent));
  return result;
}

// Number of descending values above round-off relative to the first.
int numerical_rank(std::span<const double> values, double relative) {
  int rank = 0;
  while (rank < static_cast<int>(values.size()) && values[rank] > relative * std::max(values[0], 1e-300)) ++rank;
  return rank;
}

DenseEigen truncated(DenseEigen e, int rows, double relative) {
  const int rank = numerical_rank(e.values, relative);
  e.values.resize(rank);
  e.vectors.resize(static_cast<size_t>(rows) * rank);
  return e;
}

Columns columns_of_transposed(LeastSquares& data) {  // J'
  const int n = data.parameter_count(), m = data.residual_count();
  Columns rows(n, m);
  std::vector<double> unit(m, 0.0);
  for (int i = 0; i < m; ++i) {
    unit[i] = 1;
    data.multiply_transposed(unit, rows[i]);
    unit[i] = 0;
  }
  return rows;
}

Columns products(LeastSquares& data, const Columns& V) {  // J V
  Columns JV(data.residual_count(), V.count());
  for (int j = 0; j < V.count(); ++j) data.multiply(V[j], JV[j]);
  return JV;
}

// J V by rows of J or by one product per column, whichever needs fewer.
Columns dense_products(LeastSquares& data, const Columns& V) {
  if (V.count() <= data.residual_count()) return products(data, V);
  const Columns rows = columns_of_transposed(data);
  const std::vector<double> A = product_transposed(rows, V);
  Columns JV(data.residual_count(), V.count());
  for (int j = 0; j < V.count(); ++j) {
    const auto image = column(A, data.residual_count(), j);
    std::copy(image.begin(), image.end(), JV[j].begin());
  }
  return JV;
}

// All eigenpairs: with C^-1 = U diag(l) U', the columns of Q = U diag(l)^-1/2 are orthonormal in the norm of C^-1.
Spectrum all_eigenpairs(LeastSquares& data, Gaussian& prior) {
  const int n = data.parameter_count();
  std::vector<double> precision(static_cast<size_t>(n) * n), unit(n, 0.0);
  for (int j = 0; j < n; ++j) {
    unit[j] = 1;
    prior.precision(unit, std::span(precision).subspan(static_cast<size_t>(n) * j, n));
    unit[j] = 0;
  }
  DenseEigen l = dense_eigen(n, precision);
  for (double& value : l.values) value = std::max(value, 1e-15 * l.values[0]);
  Columns Q(n), dual(n);
  for (int j = 0; j < n; ++j) Q.push_back(column(l.vectors, n, j)), dual.push_back(column(l.vectors, n, j));
  scale_columns(Q, powers(l.values, -0.5));
  scale_columns(dual, powers(l.values, 0.5));
  const Columns JQ = dense_products(data, Q);
  if (!all_finite(JQ)) return nothing(n, false);
  DenseEigen e = dense_eigen(n, product_transposed(JQ, JQ));
  for (double& value : e.values) value = std::max(value, 0.0);
  return {.d = e.values, .W = product(Q, e.vectors, n), .dual = product(dual, e.vectors, n), .complete = true};
}

// Eigenpairs of B B' w = d C^-1 w from those of the small matrix B' C B.
Spectrum of_factor(const Columns& B, Gaussian& prior) {
  const int count = B.count();
  if (!all_finite(B)) return nothing(B.rows(), false);
  Columns Z(B.rows(), count);
  for (int j = 0; j < count; ++j) prior.covariance(B[j], Z[j]);
  const DenseEigen e = truncated(dense_eigen(count, product_transposed(B, Z)), count, 1e-13);
  const int rank = static_cast<int>(e.values.size());
  Spectrum s{.d = e.values, .W = product(Z, e.vectors, rank), .dual = product(B, e.vectors, rank)};
  scale_columns(s.W, powers(s.d, -0.5));
  scale_columns(s.dual, powers(s.d, -0.5));
  return s;
}

// Growing basis Q of the range of C J', orthonormal in the norm of C^-1.
class RandomRange {
 public:
  RandomRange(LeastSquares& data, Gaussian& prior, unsigned seed)
      : data_(data),
        prior_(prior),
        random_(seed),
        Q_(data.parameter_count()),
        dual_(data.parameter_count()),
        JQ_(data.residual_count()) {}

  // Returns false if there is no further direction.
  bool grow() {
    const int n = data_.parameter_count();
    std::normal_distribution<double> normal;
    std::vector<double> q(n), y(n), r(data_.residual_count());
    for (double& value : r) value = normal(random_);
    data_.multiply_transposed(r, y);
    prior_.covariance(y, q);
    is_finite_ = is_finite_ && all_finite(y);
    if (!is_finite_) return false;
    const double length = std::sqrt(std::max(dot(q, y), 0.0));
    for (int pass = 0; pass < 2; ++pass) add_product(Q_, product_transposed(dual_, q), -1, q);
    prior_.precision(q, y);
    const double rest = std::sqrt(std::max(dot(q, y), 0.0));
    if (!(rest > 1e-10 * length)) return false;
    for (double& value : q) value /= rest;
    for (double& value : y) value /= rest;
    data_.multiply(q, r);
    is_finite_ = is_finite_ && all_finite(r);
    if (!is_finite_) return false;
    Q_.push_back(q), dual_.push_back(y), JQ_.push_back(r);
    return true;
  }

  int count() const { return Q_.count(); }
  bool is_finite() const { return is_finite_; }
  DenseEigen ritz() const { return dense_eigen(count(), product_transposed(JQ_, JQ_)); }

  // J'J ~ (J'JQ) (Q'J'JQ)^-1 (J'JQ)' = B B'
  Columns nystroem_factor() {
    const DenseEigen e = truncated(ritz(), count(), 1e-13);
    const int rank = static_cast<int>(e.values.size());
    Columns residuals = product(JQ_, e.vectors, rank), B(data_.parameter_count(), rank);
    scale_columns(residuals, powers(e.values, -0.5));
    for (int j = 0; j < rank; ++j) data_.multiply_transposed(residuals[j], B[j]);
    return B;
  }

 private:
  LeastSquares& data_;
  Gaussian& prior_;
  std::mt19937_64 random_;
  Columns Q_, dual_, JQ_;
  bool is_finite_ = true;
};

Spectrum leading_eigenpairs(LeastSquares& data, Gaussian& prior, const SpectrumOptions& options) {
  // kSpare negligible values imply that the rest is negligible: 5 to 10 suffice [Halko et al. 2011, section 4.2].
  // kBatch products are computed between two tests of the values; chosen.
  constexpr int kBatch = 24, kSpare = 8;
  RandomRange range(data, prior, options.seed);
  const int limit = std::min({options.max_rank + kSpare, data.parameter_count(), data.residual_count()});
  double missed = 0;
  for (bool more = true; more;) {
    for (int k = 0; k < kBatch && more; ++k) more = range.count() < limit && range.grow();
    if (!range.is_finite() || range.count() == 0) return nothing(data.parameter_count(), range.is_finite());
    const DenseEigen ritz = range.ritz();
    missed = more || range.count() == options.max_rank + kSpare
                 ? std::max(ritz.values[std::max(range.count() - kSpare, 0)], 0.0)
                 : 0;
    more = more && missed > options.negligible;
  }
  Spectrum s = of_factor(range.nystroem_factor(), prior);
  s.missed = missed;
  return s;
}

}  // namespace

std::vector<double> product_transposed(const Columns& A, std::span<const double> v) {
  std::vector<double> c(A.count());
  parallel_for(A.count(), [&](int j) { c[j] = dot(A[j], v); });
  return c;
}

std::vector<double> product_transposed(const Columns& A, const Columns& B) {
  const int rows = A.count();
  std::vector<double> C(static_cast<size_t>(rows) * B.count());
  parallel_for(B.count(), [&](int j) {
    for (int i = 0; i < rows; ++i) C[i + static_cast<size_t>(rows) * j] = dot(A[i], B[j]);
  });
  return C;
}

void add_product(const Columns& A, std::span<const double> c, double scale, std::span<double> y) {
  ASPIC_CHECK(static_cast<int>(c.size()) == A.count());
  parallel_chunks(A.rows(), [&](int first, int last) {
    for (int j = 0; j < A.count(); ++j) {
      const double s = scale * c[j];
      const std::span<const double> column = A[j];
      for (int i = first; i < last; ++i) y[i] += s * column[i];
    }
  });
}

Columns product(const Columns& A, std::span<const double> C, int count) {
  ASPIC_CHECK(C.size() == static_cast<size_t>(A.count()) * count);
  Columns B(A.rows(), count);
  for (int j = 0; j < count; ++j) add_product(A, C.subspan(static_cast<size_t>(A.count()) * j, A.count()), 1, B[j]);
  return B;
}

PriorGaussian::PriorGaussian(Regularizer& regularizer, double weight, std::span<const double> p)
    : regularizer_(regularizer),
      weight_(weight),
      floor_(1 / (kUninformative * kUninformative * static_cast<double>(std::max<size_t>(p.size(), 1)))),
      p_(p.begin(), p.end()) {
  ASPIC_CHECK(weight >= 0);
}

void PriorGaussian::precision(std::span<const double> v, std::span<double> y) {
  for (size_t i = 0; i < v.size(); ++i) y[i] = floor_ * v[i];
  if (weight_ > 0) regularizer_.add_hessian_product(p_, v, weight_, y);
}

void PriorGaussian::covariance(std::span<const double> v, std::span<double> z) {
  if (weight_ > 0) regularizer_.solve(p_, v, floor_ / weight_, z);
  for (size_t i = 0; i < v.size(); ++i) z[i] = weight_ > 0 ? z[i] / weight_ : v[i] / floor_;
}

void PriorGaussian::sample(std::mt19937_64& random, std::span<double> x) {
  std::vector<double> g(x.size(), 0.0);
  if (weight_ > 0) regularizer_.add_noise(p_, random, g);
  std::normal_distribution<double> normal;
  for (double& value : g) value = std::sqrt(weight_) * value + std::sqrt(floor_) * normal(random);
  covariance(g, x);
}

Spectrum spectrum(LeastSquares& data, Gaussian& prior, const SpectrumOptions& options) {
  ASPIC_CHECK(data.parameter_count() == prior.size());
  if (data.parameter_count() <= options.dense) return all_eigenpairs(data, prior);
  if (data.residual_count() <= options.dense) return of_factor(columns_of_transposed(data), prior);
  return leading_eigenpairs(data, prior, options);
}

PosteriorGaussian::PosteriorGaussian(PriorGaussian prior, Spectrum spectrum)
    : prior_(std::move(prior)), spectrum_(std::move(spectrum)) {}

void PosteriorGaussian::precision(std::span<const double> v, std::span<double> y) {
  prior_.precision(v, y);
  std::vector<double> c = product_transposed(spectrum_.dual, v);
  for (size_t k = 0; k < c.size(); ++k) c[k] *= spectrum_.d[k];
  // J'J = (C^-1 W) d (C^-1 W)' with W'(C^-1)v = dual' v
  add_product(spectrum_.dual, c, 1, y);
}

void PosteriorGaussian::covariance(std::span<const double> v, std::span<double> z) {
  prior_.covariance(v, z);
  std::vector<double> c = product_transposed(spectrum_.W, v);
  for (size_t k = 0; k < c.size(); ++k) c[k] *= spectrum_.d[k] / (1 + spectrum_.d[k]);
  add_product(spectrum_.W, c, -1, z);
}

}  // namespace aspic
