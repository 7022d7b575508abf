// Time series of a force: resampling, and steady states, to which static fits apply.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "data/settings.h"

namespace aspic {

struct ForceSeries {
  std::string file;           // name for messages
  std::vector<double> times;  // [s], ascending
  std::vector<Vec3d> values;  // [N]; only x, the component along the axis of the indenter, if it is_axial
  bool is_axial = false;
  bool has_stated_sigma = false;  // deviation.force of the settings
};

// Reads the table of the key `forces`: time [s], and force or force_x, force_y, force_z. Throws InvalidInput.
ForceSeries read_force_series(const CaptureSettings& settings, ErrorList& errors, std::vector<std::string>& notes);

double largest_force(const ForceSeries& series);  // largest absolute entry [N]
// Standard deviation of the noise, from the median second difference of successive samples, which linear ramps and a
// few steps do not change [N].
double noise_of(const ForceSeries& series);

struct SteadyForce {
  bool is_steady = false;
  Vec3d mean{}, sigma{};  // over the window; sigma: root mean square deviation [N]
  std::string reason;     // why it is steady, or why not
};

// The window around a time in which the force stays within 1 % of its range, or 4 times its noise, of the median there.
// It is steady if the window is at least as long as `duration` [s] and the means of its halves differ by at most 0.5 %
// of the force, or 0.2 % of the range, and 3 standard errors. Throws InvalidInput for a time outside the series.
SteadyForce steady_force(const ForceSeries& series, double time, double duration);
double default_duration(const ForceSeries& series);  // [s]

// Interpolates linearly between samples. Throws InvalidInput for a time outside the series.
Vec3d resampled(const ForceSeries& series, double time);

}  // namespace aspic
