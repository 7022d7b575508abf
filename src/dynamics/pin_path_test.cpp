#include "dynamics/pin_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aspic {
namespace {

std::vector<Pin> pin_moving(std::function<double(double)> x) {
  return {{"pin", {1}, [x](const Vec3d& X, double t) { return X + Vec3d{{x(t), 0, 0}}; }}};
}

TEST(PinPath, DifferentiatesPolynomialsExactly) {
  const auto x = [](double t) { return t * t * t - 2 * t * t; };
  const std::vector<Pin> motion = pin_moving(x);
  const Pins pins(motion, std::vector<double>(6, 0.3));
  PinPath path;
  path.sample(pins, 1, 1.5, 4);
  for (const double t : {1.0, 1.2, 1.5}) {
    std::vector<double> v(6, 7), a(6, 7);
    path.place_velocity(t, v);
    path.place_acceleration(t, a);
    EXPECT_NEAR(v[3], 3 * t * t - 4 * t, 1e-13);
    EXPECT_NEAR(a[3], 6 * t - 4, 1e-12);
    EXPECT_EQ(v[0], 7);
    EXPECT_EQ(a[4], 0) << "must be exactly zero across the motion";
  }
}

TEST(PinPath, ConvergesWithOrderOfPoints) {
  const auto x = [](double t) { return std::sin(t); };
  const std::vector<Pin> motion = pin_moving(x);
  const Pins pins(motion, std::vector<double>(6, 0.0));
  for (const int points : {3, 4, 5, 6}) {
    const auto error = [&](double h, int derivative) {
      PinPath path;
      path.sample(pins, 1, 1 + h, points);
      std::vector<double> out(6);
      derivative == 1 ? path.place_velocity(1 + h, out) : path.place_acceleration(1 + h, out);
      return std::abs(out[3] - (derivative == 1 ? std::cos(1 + h) : -std::sin(1 + h)));
    };
    for (const int derivative : {1, 2})
      EXPECT_NEAR(std::log2(error(0.2, derivative) / error(0.1, derivative)), points - derivative, 0.3);
  }
}

TEST(PinPath, IsExactlyZeroForRestingPins) {
  const std::vector<Pin> still = {{"pin", {1}, {}}};
  const Pins pins(still, std::vector<double>(6, 1e6));
  PinPath path;
  path.sample(pins, 0, 0.1, 4);
  std::vector<double> v(6, 7);
  path.place_velocity(0.1, v);
  EXPECT_EQ(v, (std::vector<double>{7, 7, 7, 0, 0, 0}));
}

}  // namespace
}  // namespace aspic
