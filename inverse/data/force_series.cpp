#include "data/force_series.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "math/vectors.h"
#include "model/limits.h"

namespace aspic {
namespace {

// Which forces count as steady is a convention; docs/capture_format.md states it.
constexpr double kBand = 0.01;                            // deviation of a steady force over the range of the series
constexpr double kDriftOfForce = 0.005;                   // drift of a steady force over the force itself
constexpr double kDriftOfRange = 0.002;                   // the same over the range of the series, for forces near 0
constexpr double kDuration = 0.05;                        // of a steady state over that of the series
constexpr size_t kLeastSamples = 5;                       // of a steady state
constexpr size_t kMaxSamples = 50'000'000;                // of a series: 1.6 GB
constexpr int kTries = static_cast<int>(10 / kDuration);  // times at which a message searches another steady state

double entry_norm(const Vec3d& v) { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

double range_of(const ForceSeries& s) {
  double range = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto by_axis = [axis](const Vec3d& a, const Vec3d& b) { return a[axis] < b[axis]; };
    const auto [low, high] = std::minmax_element(s.values.begin(), s.values.end(), by_axis);
    range = std::max(range, (*high)[axis] - (*low)[axis]);
  }
  return range;
}

size_t first_at(const ForceSeries& s, double time) {
  return static_cast<size_t>(std::lower_bound(s.times.begin(), s.times.end(), time) - s.times.begin());
}

void require_inside(const ForceSeries& s, double time) {
  const double slack =
      s.times.size() > 1 ? (s.times.back() - s.times.front()) / static_cast<double>(s.times.size()) : 0;
  if (!(time >= s.times.front() - slack && time <= s.times.back() + slack))
    throw InvalidInput("time = " + six_digits(time) + " s is not in " + s.file + ", which lasts from " +
                       six_digits(s.times.front()) + " s to " + six_digits(s.times.back()) + " s");
}

size_t nearest_sample(const ForceSeries& s, double time) {
  const size_t after = std::min(first_at(s, time), s.times.size() - 1);
  return after > 0 && time - s.times[after - 1] < s.times[after] - time ? after - 1 : after;
}

Vec3d median_between(const ForceSeries& s, size_t begin, size_t end) {
  Vec3d m{};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (size_t i = begin; i < end; ++i) values.push_back(s.values[i][axis]);
    m[axis] = median(std::move(values));
  }
  return m;
}

Vec3d mean_between(const ForceSeries& s, size_t begin, size_t end) {
  Vec3d sum{};
  for (size_t i = begin; i < end; ++i) sum = sum + s.values[i];
  return (1 / static_cast<double>(end - begin)) * sum;
}

struct Spread {
  double range = 0, noise = 0;
  double band() const { return kBand * range + kManySigmas * noise; }
};

// Largest difference of the means of the two halves of a window of a steady force [N].
double allowed_drift(double force, size_t samples, const Spread& spread) {
  const double standard_error = 2 * spread.noise / std::sqrt(static_cast<double>(samples));
  return std::max(kDriftOfForce * force, kDriftOfRange * spread.range) + 3 * standard_error;
}

SteadyForce judged(const ForceSeries& s, double time, double duration, const Spread& spread) {
  const size_t center = nearest_sample(s, time);
  size_t begin = std::min(first_at(s, time - duration / 4), center),
         end = std::max(first_at(s, time + duration / 4), center + 1);
  const Vec3d typical = median_between(s, begin, end);
  const auto is_near = [&](size_t i) { return entry_norm(s.values[i] - typical) <= spread.band(); };
  begin = center, end = center + 1;
  while (begin > 0 && is_near(begin - 1)) --begin;
  while (end < s.times.size() && is_near(end)) ++end;
  const double length = s.times[end - 1] - s.times[begin];
  const size_t edge = (end - begin) / 10;  // may be the end of a ramp
  begin += edge, end -= edge;
  const size_t count = end - begin, middle = begin + count / 2;
  const double drift = count > 1 ? entry_norm(mean_between(s, middle, end) - mean_between(s, begin, middle)) : 0;
  SteadyForce force{false, mean_between(s, begin, end), {}, ""};
  const double allowed = allowed_drift(entry_norm(force.mean), count, spread);
  for (size_t i = begin; i < end; ++i)
    for (int axis = 0; axis < 3; ++axis)
      force.sigma[axis] += std::pow(s.values[i][axis] - force.mean[axis], 2) / static_cast<double>(count);
  for (double& sigma : force.sigma.a) sigma = std::sqrt(sigma);
  const std::string window =
      formatted("from %.4g s to %.4g s (%d samples)", s.times[begin], s.times[end - 1], static_cast<int>(count));
  const std::string band = "within " + three_digits(spread.band()) + " N";
  if (!is_near(center) || length < duration || count < kLeastSamples)
    force.reason =
        "not steady: the force stays " + band + " only " + window + ", but must for " + three_digits(duration) + " s";
  else if (drift > allowed)
    force.reason = "not steady: the force drifts by " + three_digits(drift) + " N " + window + "; at most " +
                   three_digits(allowed) +
                   " N count as steady. If the sensor drifts, subtract its drift from the series; if the body relaxes, "
                   "wait longer or fit steady = \"history\"";
  else
    force.is_steady = true, force.reason = "steady " + band + " " + window + ", drift " + three_digits(drift) + " N";
  return force;
}

std::string elsewhere(const ForceSeries& s, double time, double duration, const Spread& spread) {
  double best = std::numeric_limits<double>::infinity();
  const double length = s.times.back() - s.times.front();
  for (int i = 0; i <= kTries; ++i) {
    const double t = s.times.front() + length * i / kTries;
    if (std::abs(t - time) < std::abs(best - time) && judged(s, t, duration, spread).is_steady) best = t;
  }
  return std::isfinite(best) ? "; the nearest steady state is at " + three_digits(best) + " s"
                             : "; the series has no steady state";
}

}  // namespace

double largest_force(const ForceSeries& s) {
  double largest = 0;
  for (const Vec3d& v : s.values) largest = std::max(largest, entry_norm(v));
  return largest;
}

double noise_of(const ForceSeries& s) {
  constexpr double kMedianOfNormal = 0.6745;  // median of the magnitude of a normal number
  double noise = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> bends;
    for (size_t i = 2; i < s.values.size(); ++i)
      bends.push_back(std::abs(s.values[i][axis] - 2 * s.values[i - 1][axis] + s.values[i - 2][axis]));
    noise = std::max(noise, median(std::move(bends)) / (kMedianOfNormal * std::sqrt(6.0)));
  }
  return noise;
}

ForceSeries read_force_series(const CaptureSettings& settings, ErrorList& errors, std::vector<std::string>& notes) {
  const std::filesystem::path path = settings.file("forces");
  MeasuredTable table(path, settings.columns("forces"), errors, notes);
  ForceSeries series{.file = path.filename().string()};
  series.is_axial = table.has("force");
  series.has_stated_sigma = settings["deviation"].find("force") != nullptr;
  if (!table.has("time") || (!series.is_axial && !table.has("force_x")))
    throw InvalidInput(series.file +
                       ":1: needs the columns time and force, or time, force_x, force_y and force_z (columns in " +
                       settings.file_name() + " gives them other names)");
  const double newton = settings.unit("force") * (settings["force_of"].text() == "tip" ? 1 : -1);
  while (table.next()) {
    const std::optional<double> time = table.number("time"), along = table.number("force", newton);
    const std::optional<Vec3d> vector = series.is_axial ? std::nullopt : table.vector("force_", newton);
    if (!time || (!along && !vector)) continue;  // a blank cell was not measured
    if (!series.times.empty() && !(*time > series.times.back()))
      table.error("time = " + six_digits(*time) + " s follows " + six_digits(series.times.back()) +
                  " s; times must ascend");
    if (series.times.size() == kMaxSamples) throw InvalidInput(series.file + ": more than 5e7 samples; resample it");
    series.times.push_back(*time);
    series.values.push_back(vector ? *vector : Vec3d{{*along, 0, 0}});
  }
  if (series.times.empty()) throw InvalidInput(series.file + ": has no samples below the header");
  return series;
}

double default_duration(const ForceSeries& series) { return kDuration * (series.times.back() - series.times.front()); }

SteadyForce steady_force(const ForceSeries& series, double time, double duration) {
  require_inside(series, time);
  const Spread spread{range_of(series), noise_of(series)};
  SteadyForce force = judged(series, time, duration, spread);
  if (!force.is_steady) force.reason += elsewhere(series, time, duration, spread);
  return force;
}

Vec3d resampled(const ForceSeries& series, double time) {
  require_inside(series, time);
  const size_t after = first_at(series, time);
  if (after == 0) return series.values.front();
  if (after == series.times.size()) return series.values.back();
  const double share = (time - series.times[after - 1]) / (series.times[after] - series.times[after - 1]);
  return (1 - share) * series.values[after - 1] + share * series.values[after];
}

}  // namespace aspic
