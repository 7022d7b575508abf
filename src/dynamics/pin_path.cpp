#include "dynamics/pin_path.h"

#include <array>

#include "base/check.h"

namespace aspic {
namespace {

constexpr int kMaxPoints = 8;

// Returns the first (1) or second (2) derivative at z of the polynomial that is 1 at j / (points - 1) and 0 at the
// other points.
double basis_derivative(int j, int points, double z, int derivative) {
  double p = 1, dp = 0, ddp = 0;
  for (int k = 0; k < points; ++k) {
    if (k == j) continue;
    const double slope = (points - 1.0) / (j - k), factor = slope * (z - k / (points - 1.0));
    ddp = ddp * factor + 2 * dp * slope;
    dp = dp * factor + p * slope;
    p *= factor;
  }
  return derivative == 1 ? dp : ddp;
}

}  // namespace

void PinPath::sample(const Pins& pins, double time, double end_time, int points) {
  ASPIC_CHECK(points >= 3 && points <= kMaxPoints);
  pins_ = &pins;
  time_ = time;
  h_ = end_time - time;
  points_ = pins.any_moves() ? points : 0;
  x_.resize(points_);
  for (int j = 0; j < points_; ++j) {
    x_[j].assign(3 * static_cast<size_t>(pins.rows()), 0.0);
    pins.place(j == points - 1 ? end_time : time + h_ * j / (points - 1), x_[j]);
  }
}

void PinPath::differentiate(double time, int derivative, std::span<double> out) const {
  std::array<double, kMaxPoints> weight{};
  for (int j = 0; j < points_; ++j)
    weight[j] = basis_derivative(j, points_, (time - time_) / h_, derivative) / (derivative == 1 ? h_ : h_ * h_);
  for (int v = 0; v < pins_->rows(); ++v) {
    if (pins_->is_free(v)) continue;
    Vec3d sum{};  // the weights sum to zero, so the velocity of a pin at rest is exactly zero
    Vec3d given;
    for (int r = 0; r < 3; ++r) {
      const size_t i = 3 * static_cast<size_t>(v) + r;
      for (int j = 1; j < points_; ++j) sum[r] += weight[j] * (x_[j][i] - x_[0][i]);
      given[r] = out[i];
    }
    const Vec3d value = pins_->holds(v) ? sum : pins_->free_part(v, given) + sum;
    for (int r = 0; r < 3; ++r) out[3 * v + r] = value[r];
  }
}

}  // namespace aspic
