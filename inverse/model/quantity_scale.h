// Scale on which a quantity is fitted: a smooth increasing map of z in (-inf, inf) to its value.
//   positive              q = exp(z)
//   any                   q = z
//   in (lower, upper)     q = middle + half tanh(z / 2): the logistic curve, z = +-2 reaches 12 % and 88 % of the range
//   in a range of powers  log q = middle + half tanh(z / half), z = log(q / center) in the middle of the range
//   powers from zero      log(1 + q): linear below 1, a logarithm above
#pragma once
#include <cmath>

namespace aspic {

class QuantityScale {
 public:
  static QuantityScale positive() { return {}; }
  static QuantityScale any() {
    QuantityScale scale;
    scale.is_log_ = false;
    return scale;
  }
  static QuantityScale bounded(double lower, double upper) {
    QuantityScale scale;
    scale.is_log_ = false;
    scale.middle_ = (lower + upper) / 2, scale.half_ = (upper - lower) / 2, scale.width_ = 2;
    return scale;
  }
  static QuantityScale bounded_powers(double lower, double upper) {  // 0 < lower
    QuantityScale scale;
    scale.middle_ = (std::log(lower) + std::log(upper)) / 2;
    scale.half_ = scale.width_ = (std::log(upper) - std::log(lower)) / 2;
    return scale;
  }

  static QuantityScale powers_from_zero(double upper) {  // [1]
    QuantityScale scale;
    scale.shift_ = 1;
    scale.middle_ = scale.half_ = scale.width_ = std::log1p(upper) / 2;
    return scale;
  }

  double value(double z) const { return is_log_ ? std::exp(line(z)) - shift_ : line(z); }
  double slope(double z) const {  // dq/dz
    double du = 1;
    if (half_ > 0) {
      const double c = std::cosh(z / width_);
      du = half_ / (width_ * c * c);
    }
    return is_log_ ? std::exp(line(z)) * du : du;
  }
  double fitted(double q) const {  // z of a value in the range
    const double u = is_log_ ? std::log(q + shift_) : q;
    return half_ > 0 ? width_ * std::atanh((u - middle_) / half_) : u;
  }

  double place_in_range(double z) const { return half_ > 0 ? std::tanh(z / width_) : 0; }  // -1 to 1; 0: unbounded

 private:
  double line(double z) const {
    return half_ > 0 ? middle_ + half_ * std::tanh(z / width_) : z;
  }  // q or log(q + shift)

  bool is_log_ = true;
  double shift_ = 0;
  double middle_ = 0, half_ = 0 /* 0: unbounded */, width_ = 1;
};

}  // namespace aspic
