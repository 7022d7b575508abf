// Taylor's theorem as a test of a derivative: |f(eps) - f(0) - eps f'| falls like eps^2.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "math/vectors.h"

namespace aspic::taylor {

class Numbers {
 public:
  explicit Numbers(unsigned seed = 5) : random_(seed) {}
  std::vector<double> operator()(size_t count) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> numbers(count);
    for (double& x : numbers) x = uniform(random_);
    return numbers;
  }

 private:
  std::mt19937 random_;
};

// Over some decades of eps below `largest`, where the noise of f must stay far below the curvature term.
inline void expect_slope_2(const std::function<std::vector<double>(double eps)>& f,
                           const std::vector<double>& derivative, double largest, const std::string& what,
                           int decades = 4) {
  const std::vector<double> f0 = f(0);
  double before = 0;
  for (int decade = 0; decade <= decades; ++decade) {
    const double eps = largest * std::pow(10, -decade);
    std::vector<double> rest = f(eps);
    for (size_t i = 0; i < rest.size(); ++i) rest[i] -= f0[i] + eps * derivative[i];
    const double remainder = norm(rest);
    EXPECT_GT(remainder, 0) << what;
    if (decade > 0) {
      EXPECT_NEAR(std::log10(before / remainder), 2, 0.1) << what << ", eps = " << eps;
    }
    before = remainder;
  }
}

}  // namespace aspic::taylor
