#include "optimize/forcing.h"

#include <algorithm>

namespace aspic {
namespace {

constexpr double kSmallest = 1e-8;
constexpr double kGamma = 0.9;
constexpr double kMatters = 0.1;  // safeguard: ignores the previous eta below this value

}  // namespace

double Forcing::at(double gradient_norm, const InnerAccuracy& accuracy) {
  if (gradient_norm == last_norm_) return eta_;  // the same iterate
  double eta = accuracy.loosest;
  if (last_norm_ > 0) {
    const double ratio = gradient_norm / last_norm_, held = kGamma * eta_ * eta_;
    eta = kGamma * ratio * ratio;
    if (held > kMatters) eta = std::max(eta, held);
  }
  last_norm_ = gradient_norm;
  return eta_ = std::min(accuracy.loosest, std::max({kSmallest, accuracy.enough, eta}));
}

}  // namespace aspic
