#include "model/regularizer.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/check.h"
#include "base/error.h"
#include "linalg/scalar_cholesky.h"
#include "model/field_roughness.h"
#include "model/limits.h"

namespace aspic {
namespace {

// A penalty limits values of fields to a factor of 100 from the guess (4.6 in log E) for any weight. With small
// weights, poorly determined tets would otherwise diverge to 0 or infinity.
constexpr double kWall = 1e4;  // 1 / variance of the excess of a whole field: a hundredth of log E

double excess(double distance) { return std::copysign(std::max(0.0, std::abs(distance) - kFarthestOfField), distance); }

double inverse_square(double x) { return 1 / (x * x); }

// Entries of p of one quantity, and their prior.
class Prior {
 public:
  Prior(double guess, double sigma) : guess_(guess), precision_(inverse_square(sigma)) {}
  virtual ~Prior() = default;
  virtual double value(std::span<const double> p) const = 0;
  virtual void add_gradient(std::span<const double> p, double scale, std::span<double> g) const = 0;
  virtual void add_product(std::span<const double> p, std::span<const double> v, double scale,
                           std::span<double> y) const = 0;
  virtual void solve(std::span<const double> p, std::span<const double> v, double shift, std::span<double> z) = 0;
  virtual void add_noise(std::span<const double> p, std::mt19937_64& random, std::span<double> g) const = 0;

 protected:
  double invertible_precision(double shift) const {
    return precision_ > 0 || shift > 0 ? precision_ : inverse_square(kUninformative);
  }

  double guess_, precision_;
};

class ValuePrior : public Prior {
 public:
  using Prior::Prior;

  double value(std::span<const double> p) const override {
    double sum = 0;
    for (double pi : p) sum += (pi - guess_) * (pi - guess_);
    return precision_ * sum / 2;
  }
  void add_gradient(std::span<const double> p, double scale, std::span<double> g) const override {
    for (size_t i = 0; i < p.size(); ++i) g[i] += scale * precision_ * (p[i] - guess_);
  }
  void add_product(std::span<const double>, std::span<const double> v, double scale,
                   std::span<double> y) const override {
    for (size_t i = 0; i < v.size(); ++i) y[i] += scale * precision_ * v[i];
  }
  void solve(std::span<const double>, std::span<const double> v, double shift, std::span<double> z) override {
    for (size_t i = 0; i < v.size(); ++i) z[i] = v[i] / (invertible_precision(shift) + shift);
  }
  void add_noise(std::span<const double>, std::mt19937_64& random, std::span<double> g) const override {
    std::normal_distribution<double> normal;
    for (double& gi : g) gi += std::sqrt(precision_) * normal(random);
  }
};

class FieldPrior : public Prior {
 public:
  FieldPrior(const TetMesh& mesh, const FieldBasis& basis, const RegularizerOptions& options, double guess)
      : Prior(guess, options.prior_sigma),
        basis_(basis),
        roughness_(mesh, options.smoothness == Smoothness::total_variation ? options.sharpness
                                                                           : std::numeric_limits<double>::infinity()),
        is_smooth_(options.smoothness != Smoothness::none) {}

  double value(std::span<const double> p) const override {
    const std::vector<double> z = field(p);
    double sum = 0;
    for (size_t t = 0; t < z.size(); ++t) {
      const double distance = z[t] - guess_, beyond = excess(distance);
      sum += mass(t) * (precision_ * distance * distance + kWall * beyond * beyond);
    }
    return sum / 2 + (is_smooth_ ? roughness_.value(z) : 0);
  }
  void add_gradient(std::span<const double> p, double scale, std::span<double> g) const override {
    const std::vector<double> z = field(p);
    std::vector<double> zbar(z.size());
    for (size_t t = 0; t < z.size(); ++t)
      zbar[t] = mass(t) * (precision_ * (z[t] - guess_) + kWall * excess(z[t] - guess_));
    if (is_smooth_) roughness_.add_gradient(z, 1, zbar);
    add_transposed(zbar, scale, g);
  }
  void add_product(std::span<const double> p, std::span<const double> v, double scale,
                   std::span<double> y) const override {
    const std::vector<double> z = field(p), dz = field(v);
    std::vector<double> zbar(dz.size());
    for (size_t t = 0; t < dz.size(); ++t) zbar[t] = (precision_ + wall(z[t])) * mass(t) * dz[t];
    if (is_smooth_) roughness_.add_product(z, dz, 1, zbar);
    add_transposed(zbar, scale, y);
  }
  void solve(std::span<const double> p, std::span<const double> v, double shift, std::span<double> z) override {
    const std::vector<double> z_now = field(p);
    const auto is_far = [&](double x) { return wall(x) > 0; };
    const bool is_beyond = std::any_of(z_now.begin(), z_now.end(), is_far);
    const bool depends_on_p = (is_smooth_ && !roughness_.is_quadratic()) || is_beyond || made_beyond_;
    if (!made_shift_ || *made_shift_ != shift || (depends_on_p && !std::equal(p.begin(), p.end(), made_p_.begin())))
      factorize(p, shift), made_beyond_ = is_beyond;
    inverse_.solve(v, z);
  }
  void add_noise(std::span<const double> p, std::mt19937_64& random, std::span<double> g) const override {
    std::normal_distribution<double> normal;
    std::vector<double> zbar(static_cast<size_t>(basis_.tet_count()));
    const std::vector<double> z = field(p);
    for (size_t t = 0; t < zbar.size(); ++t) zbar[t] = std::sqrt((precision_ + wall(z[t])) * mass(t)) * normal(random);
    if (is_smooth_) roughness_.add_noise(z, random, zbar);
    add_transposed(zbar, 1, g);
  }

 private:
  double wall(double z) const { return excess(z - guess_) != 0 ? kWall : 0; }
  double mass(size_t t) const { return roughness_.volume_share()[t]; }
  std::vector<double> field(std::span<const double> p) const {
    std::vector<double> z(basis_.tet_count());
    basis_.multiply(p, z);
    return z;
  }
  void add_transposed(std::vector<double>& zbar, double scale, std::span<double> pbar) const {
    for (double& b : zbar) b *= scale;
    basis_.add_transposed(zbar, pbar);
  }

  // Matrix over the tets: roughness plus diagonal.
  std::vector<MatrixPlace> field_places() const {
    std::vector<MatrixPlace> places = is_smooth_ ? roughness_.places() : std::vector<MatrixPlace>{};
    for (int t = 0; t < basis_.tet_count(); ++t) places.push_back({t, t});
    return places;
  }
  std::vector<double> field_entries(std::span<const double> p, double shift) const {
    std::vector<double> entries = is_smooth_ ? roughness_.entries(field(p)) : std::vector<double>{};
    const std::vector<double> z = field(p);
    for (size_t t = 0; t < z.size(); ++t) entries.push_back((invertible_precision(shift) + wall(z[t])) * mass(t));
    return entries;
  }

  void factorize(std::span<const double> p, double shift) {
    std::vector<MatrixPlace> places = field_places();
    std::vector<double> entries = field_entries(p, shift);
    if (!basis_.is_identity()) reduce(places, entries);
    for (int i = 0; i < basis_.size(); ++i) {
      places.push_back({i, i});
      entries.push_back(shift);
    }
    if (!made_shift_) inverse_.analyze(basis_.size(), places);
    const bool is_definite = inverse_.factorize(entries);
    if (!is_definite) throw std::runtime_error("the regularizer's matrix could not be factorized");
    made_shift_ = shift;
    made_p_.assign(p.begin(), p.end());
  }

  // W' A W, dense.
  void reduce(std::vector<MatrixPlace>& places, std::vector<double>& entries) const {
    const int n = basis_.size();
    std::vector<std::vector<std::pair<int, double>>> row(static_cast<size_t>(basis_.tet_count()));
    basis_.for_each_weight([&](int t, int j, double w) { row[t].emplace_back(j, w); });
    std::vector<double> dense(static_cast<size_t>(n) * n, 0.0);
    const auto add = [&](int a, int b, double value) {
      for (const auto& [i, wi] : row[a])
        for (const auto& [j, wj] : row[b]) dense[static_cast<size_t>(i) * n + j] += value * wi * wj;
    };
    for (size_t k = 0; k < places.size(); ++k) {
      const auto& [a, b] = places[k];
      add(a, b, entries[k]);
      if (a != b) add(b, a, entries[k]);
    }
    places.clear(), entries.clear();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) {
        places.push_back({i, j});
        entries.push_back(dense[static_cast<size_t>(i) * n + j]);
      }
  }

  const FieldBasis& basis_;
  FieldRoughness roughness_;
  bool is_smooth_;
  ScalarCholesky inverse_;
  std::optional<double> made_shift_;
  bool made_beyond_ = false;
  std::vector<double> made_p_;
};

class SumOfPriors : public Regularizer {
 public:
  SumOfPriors(const TetMesh& mesh, const ParameterMap& map, const RegularizerOptions& options) {
    for (size_t u = 0; u < map.fitted_parameters().size(); ++u) {
      const auto [first, count] = map.range(static_cast<int>(u));
      const double guess = map.guess()[first];
      const FitParameter& parameter = map.fitted_parameters()[u];
      const Parameterization parameterization = parameter.parameterization;
      const double sigma = parameter.prior_sigma > 0 ? parameter.prior_sigma : options.prior_sigma;
      std::unique_ptr<Prior> prior;
      if (parameterization == Parameterization::uniform || parameterization == Parameterization::regions)
        prior = std::make_unique<ValuePrior>(guess, sigma);
      else
        prior = std::make_unique<FieldPrior>(mesh, map.basis(static_cast<int>(u)), options, guess);
      parts_.push_back({static_cast<size_t>(first), static_cast<size_t>(count), std::move(prior)});
    }
  }

  double value(std::span<const double> p) const override {
    double sum = 0;
    for (const Part& part : parts_) sum += part.prior->value(part.of(p));
    return sum;
  }
  void add_gradient(std::span<const double> p, double scale, std::span<double> g) const override {
    for (const Part& part : parts_) part.prior->add_gradient(part.of(p), scale, part.of(g));
  }
  void add_hessian_product(std::span<const double> p, std::span<const double> v, double scale,
                           std::span<double> y) const override {
    for (const Part& part : parts_) part.prior->add_product(part.of(p), part.of(v), scale, part.of(y));
  }
  void solve(std::span<const double> p, std::span<const double> v, double shift, std::span<double> z) override {
    for (const Part& part : parts_) part.prior->solve(part.of(p), part.of(v), shift, part.of(z));
  }
  void add_noise(std::span<const double> p, std::mt19937_64& random, std::span<double> g) const override {
    for (const Part& part : parts_) part.prior->add_noise(part.of(p), random, part.of(g));
  }

 private:
  struct Part {
    size_t first, count;
    std::unique_ptr<Prior> prior;

    template <class T>
    std::span<T> of(std::span<T> v) const {
      return v.subspan(first, count);
    }
  };
  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<Regularizer> make_regularizer(const TetMesh& mesh, const ParameterMap& map,
                                              const RegularizerOptions& options) {
  if (!(options.prior_sigma > 0)) throw InvalidInput("the standard deviation of the prior must be positive (try 2)");
  if (!(options.sharpness > 0 && std::isfinite(options.sharpness)))
    throw InvalidInput("the sharpness of total variation must be positive and finite (try 10)");
  return std::make_unique<SumOfPriors>(mesh, map, options);
}

}  // namespace aspic
