#include "optimize/landscape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "optimize/gradient_descent.h"
#include "optimize/newton.h"
#include "optimize/test_functions.h"

namespace aspic {
namespace {

template <class Direction, class Observer>
void observe_first_iteration(Direction&& direction, const Observer& observe) {
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  Minimizer().minimize(f, direction, x, {.max_iterations = 1},
                       [&](const LiveIteration& iteration) { observe(iteration); });
}

Newton direct_newton() { return Newton(make_linear_solver("cholesky")); }

TEST(Landscape, CurveMatchesModelToThirdOrder) {
  observe_first_iteration(direct_newton(), [](const LiveIteration& iteration) {
    for (const CurvePoint& point : curve_along(iteration, 1e-4, 201))
      EXPECT_LE(std::abs(point.value - point.model),
                (std::abs(iteration.value) + 200) * std::pow(std::abs(point.alpha), 3) * 10 + 1e-9)
          << point.alpha;
  });
}

TEST(Landscape, CurvePassesThroughTrials) {
  observe_first_iteration(GradientDescent(), [](const LiveIteration& iteration) {
    ASSERT_GT(iteration.tried.size(), 1u);
    const double last = 1.25 * iteration.tried[0].alpha;
    const auto curve = curve_along(iteration, 0.25, 101);
    EXPECT_NEAR(curve.back().alpha, last, 1e-12);
    EXPECT_LT(curve.front().alpha, 0);
    const Trial& first = iteration.tried[0];
    std::vector<double> x(3);
    for (int i = 0; i < 3; ++i) x[i] = iteration.x[i] + first.alpha * iteration.d[i];
    EXPECT_EQ(iteration.E.value(x), first.value);
    EXPECT_NEAR(curve.back().textbook_bound, iteration.value - 0.25 * last * 2 * iteration.decrement, 1e-9);
    EXPECT_NEAR(curve.back().slide_bound, iteration.value - 0.25 * 2 * iteration.decrement, 1e-9);
  });
}

// Gradient descent accepts an eighth of its first trial.
TEST(Landscape, ShortAcceptedStepHasSamplesAround) {
  observe_first_iteration(GradientDescent(), [](const LiveIteration& iteration) {
    ASSERT_EQ(iteration.alpha, 0.125);
    const auto curve = curve_along(iteration, 1e-4, 101);
    ASSERT_EQ(curve.size(), 101u);
    EXPECT_GE(
        std::count_if(curve.begin(), curve.end(), [](const CurvePoint& point) { return std::abs(point.alpha) < 0.2; }),
        30);
    EXPECT_TRUE(std::is_sorted(curve.begin(), curve.end(),
                               [](const CurvePoint& a, const CurvePoint& b) { return a.alpha < b.alpha; }));
  });
}

// (s, t) = (1, 0) is the end of the full step, where the model of Newton's method has its minimum.
TEST(Landscape, SliceContainsIterateAndModelMinimum) {
  observe_first_iteration(direct_newton(), [](const LiveIteration& iteration) {
    const Slice slice = slice_through(iteration, 41);
    const SlicePoint* lowest = &slice.point[0];
    for (const SlicePoint& point : slice.point) {
      if (point.model < lowest->model) lowest = &point;
      if (std::abs(point.s) < 1e-12 && std::abs(point.t) < 1e-12) {
        EXPECT_NEAR(point.value, iteration.value, 1e-12);
        EXPECT_NEAR(point.model, iteration.value, 1e-12);
      }
    }
    EXPECT_NEAR(lowest->s, 1, 1e-9);
    EXPECT_NEAR(lowest->t, 0, 1e-9);
  });
}

// The plane of gradient descent is spanned by g and H g, so it is not a line.
TEST(Landscape, SliceOfGradientDescentIsPlane) {
  observe_first_iteration(GradientDescent(), [](const LiveIteration& iteration) {
    const Slice slice = slice_through(iteration, 5);
    EXPECT_GT(std::abs(slice.point[0].value - slice.point[4 * 5].value), 1e-3);
  });
}

TEST(Landscape, StopsOnRequest) {
  observe_first_iteration(direct_newton(), [](const LiveIteration& iteration) {
    int asked = 0;
    const StopToken stop([&] { return ++asked >= 10; });
    EXPECT_TRUE(slice_through(iteration, 41, stop).point.empty());
    EXPECT_EQ(asked, 10);
    EXPECT_TRUE(curve_along(iteration, 1e-4, 101, stop).empty());
    EXPECT_EQ(asked, 11);
  });
}

TEST(Landscape, SamplingDoesNotChangeResult) {
  const auto minimum = [](bool observes) {
    Rosenbrock f;
    std::vector<double> x = {-0.8, 0.6, 0};
    Newton direction = direct_newton();
    Minimizer().minimize(f, direction, x, {}, [&](const LiveIteration& iteration) {
      if (observes) slice_through(iteration), curve_along(iteration, 1e-4);
    });
    return x;
  };
  EXPECT_EQ(minimum(false), minimum(true));
}

// A wall at x = -0.7 that straight paths must not cross.
class WalledRosenbrock : public Rosenbrock {
 public:
  double max_step(std::span<const double> x, std::span<const double> d) override {
    return d[0] > 0 ? std::min(1.0, (-0.7 - x[0]) / d[0]) : 1;
  }
};

TEST(Landscape, MarksBlockedPoints) {
  WalledRosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};
  const auto observe = [](const LiveIteration& iteration) {
    ASSERT_GT(iteration.d[0], 0);
    const double most = 0.1 / iteration.d[0];
    EXPECT_NEAR(largest_step(iteration, 2 * most), most, 1e-12);
    EXPECT_EQ(largest_step(iteration, 0.5 * most), std::numeric_limits<double>::infinity());
    int beyond = 0;
    for (const CurvePoint& point : curve_along(iteration, 1e-4)) {
      EXPECT_EQ(std::isfinite(point.value), point.alpha <= most) << point.alpha;
      beyond += point.alpha > most;
    }
    EXPECT_GT(beyond, 0);
    const Slice slice = slice_through(iteration, 21);
    int blocked = 0;
    for (const SlicePoint& point : slice.point) {
      const double at = -0.8 + point.s * iteration.d[0] + point.t * slice.across[0];
      if (std::abs(at + 0.7) > 1e-9) {
        EXPECT_EQ(point.is_blocked, at > -0.7);
      }
      EXPECT_EQ(std::isfinite(point.value), !point.is_blocked);
      blocked += point.is_blocked;
    }
    EXPECT_GT(blocked, 0);
    EXPECT_LT(blocked, 21 * 21);
  };
  GradientDescent direction;
  Minimizer().minimize(f, direction, {x}, {.max_iterations = 1}, observe);
}

}  // namespace
}  // namespace aspic
