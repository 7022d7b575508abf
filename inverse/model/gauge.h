// Readings of one component: forces and torques of single-axis gauges, and positions without depth.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "model/misfit.h"

namespace aspic {

// Measured components of a force or torque: {its component along the gauge, 0, 0}, or all three without a gauge.
inline Vec3d to_gauge(const std::optional<Vec3d>& gauge, const Vec3d& v) {
  return gauge ? Vec3d{{dot(*gauge, v), 0, 0}} : v;
}

// Transpose of to_gauge().
inline Vec3d from_gauge(const std::optional<Vec3d>& gauge, const Vec3d& components) {
  return gauge ? components[0] * *gauge : components;
}

// Standard deviations of to_gauge() for those of the axes. Components that were not measured have infinite ones.
inline Vec3d gauge_sigma(const std::optional<Vec3d>& gauge, const Vec3d& sigma) {
  if (!gauge) return sigma;
  const Vec3d& a = *gauge;
  return {{norm(Vec3d{{a[0] * sigma[0], a[1] * sigma[1], a[2] * sigma[2]}}), INFINITY, INFINITY}};
}

// Whether component k of a reading was measured. Recordings of one camera lack one; its standard deviation is huge.
inline bool is_measured(const Vec3d& sigma, int k) {
  constexpr double kUnmeasured = 1e3;  // chosen, above ratios of measured components
  return sigma[k] < kUnmeasured * std::min({sigma[0], sigma[1], sigma[2]});
}

// Root mean square of the standard deviations of the measured components.
inline double rms_sigma(const Vec3d& sigma) {
  double squares = 0;
  int count = 0;
  for (int k = 0; k < 3; ++k)
    if (is_measured(sigma, k)) squares += sigma[k] * sigma[k], ++count;
  return std::sqrt(squares / std::max(count, 1));
}

// Number of measured components of the positions, force and torque of a case.
inline int measured_count(const LoadCase& load) {
  int count = 0;
  const auto add = [&](const Vec3d& sigma) {
    for (int k = 0; k < 3; ++k) count += is_measured(sigma, k) ? 1 : 0;
  };
  for (const MarkerReading& reading : load.positions) add(reading.sigma);
  if (load.force) add(gauge_sigma(load.gauge, load.force_sigma));
  if (load.torque) add(gauge_sigma(load.torque_gauge, load.torque_sigma));
  return count;
}

}  // namespace aspic
