#include "mesh/predicates.h"

#include <cmath>

#include "base/check.h"

namespace aspic {
namespace {

// Bounds of the rounding error relative to the sum of the absolute values of the terms: (7 + 56 e) e and (3 + 16 e) e
// with e = 2^-53, rounded up.
constexpr double kError3 = 8 * 0x1p-53;
constexpr double kError2 = 4 * 0x1p-53;

int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

struct Pair {
  double value, error;  // their exact sum is the result
};

Pair exact_sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}

Pair exact_product(double a, double b) {
  const volatile double product = a * b;  // volatile prevents fusion into a sum
  const double p = product;
  return {p, std::fma(a, b, -p)};
}

// A number as a sum of nonoverlapping doubles, smallest first.
class Expansion {
 public:
  void add(double x) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const auto [sum, error] = exact_sum(x, terms_[i]);
      if (error != 0) terms_[kept++] = error;
      x = sum;
    }
    if (x != 0) terms_[kept++] = x;
    count_ = kept;
    ASPIC_CHECK(count_ < kMaxTerms);
  }
  void add_product(double a, double b) {
    const auto [value, error] = exact_product(a, b);
    add(error);
    add(value);
  }
  void add_product(double a, double b, double c) {
    const auto [value, error] = exact_product(a, b);
    add_product(error, c);
    add_product(value, c);
  }
  int sign() const { return count_ == 0 ? 0 : aspic::sign(terms_[count_ - 1]); }

 private:
  static constexpr int kMaxTerms = 128;  // more than the 96 terms of the largest sum here
  double terms_[kMaxTerms] = {};
  int count_ = 0;
};

// Adds +u . (v x w) or -u . (v x w).
void add_triple(Expansion& sum, const Vec3d& u, const Vec3d& v, const Vec3d& w, double factor) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum.add_product(factor * u[i], v[j], w[k]);
    sum.add_product(-factor * u[i], v[k], w[j]);
  }
}

bool is_exact_difference(const Vec3d& a, const Vec3d& b) {
  for (int i = 0; i < 3; ++i)
    if (exact_sum(a[i], -b[i]).error != 0) return false;
  return true;
}

int exact_orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  Expansion sum;
  if (is_exact_difference(a, d) && is_exact_difference(b, d) && is_exact_difference(c, d)) {
    add_triple(sum, a - d, b - d, c - d, 1);
  } else {  // expansion of the same determinant
    add_triple(sum, a, b, c, 1);
    add_triple(sum, d, b, c, -1);
    add_triple(sum, a, d, c, -1);
    add_triple(sum, a, b, d, -1);
  }
  return sum.sign();
}

int exact_orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  Expansion sum;
  sum.add_product(a[0], b[1]);
  sum.add_product(-a[1], b[0]);
  sum.add_product(b[0], c[1]);
  sum.add_product(-b[1], c[0]);
  sum.add_product(c[0], a[1]);
  sum.add_product(-c[1], a[0]);
  return sum.sign();
}

}  // namespace

int orientation(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = a - d, v = b - d, w = c - d;
  double value = 0, terms = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double left = v[j] * w[k], right = v[k] * w[j];
    value += u[i] * (left - right);
    terms += std::abs(u[i]) * (std::abs(left) + std::abs(right));
  }
  if (std::abs(value) > kError3 * terms) return sign(value);
  return terms == 0 ? 0 : exact_orientation(a, b, c, d);
}

int orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
  const double terms = std::abs(left) + std::abs(right);
  if (std::abs(left - right) > kError2 * terms) return sign(left - right);
  return terms == 0 ? 0 : exact_orientation(a, b, c);
}

}  // namespace aspic
