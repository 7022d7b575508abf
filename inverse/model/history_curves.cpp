#include "model/history_curves.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

bool is_same(const Vec3d& a, const Vec3d& b) { return dot(a, b) > 1 - 1e-9; }

// "force", or with several components "force x" by the coordinate that an axis is closest to.
std::string reading_of(const Vec3d& axis, bool is_single) {
  int largest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(axis[i]) > std::abs(axis[largest])) largest = i;
  return is_single ? "force" : std::string("force ") + "xyz"[largest];
}

std::vector<HistoryCurve> force_curves(const LoadHistory& history, const HistoryPrediction& prediction) {
  std::vector<HistoryCurve> curves;
  std::vector<Vec3d> axes;
  for (const ForceReading& reading : history.forces)
    if (std::none_of(axes.begin(), axes.end(), [&](const Vec3d& a) { return is_same(a, reading.axis); }))
      axes.push_back(reading.axis);
  for (const Vec3d& axis : axes) {
    HistoryCurve& curve = curves.emplace_back(HistoryCurve{
        .history = history.name, .reading = reading_of(axis, axes.size() == 1), .unit = "N", .points = {}});
    for (size_t k = 0; k < history.forces.size(); ++k)
      if (const ForceReading& reading = history.forces[k]; is_same(axis, reading.axis))
        curve.points.push_back({reading.time, reading.value, reading.sigma, prediction.forces[k]});
  }
  return curves;
}

struct MarkerPoint {
  double time;
  Vec3d measured, fitted, sigma;  // displacements
};

// Standard deviation of the component of a vector along a unit axis.
double along(const Vec3d& sigma, const Vec3d& axis) {
  double squares = 0;
  for (int i = 0; i < 3; ++i) squares += sigma[i] * sigma[i] * axis[i] * axis[i];
  return std::sqrt(squares);
}

class MarkerMotion {
 public:
  MarkerMotion(int marker, std::vector<MarkerPoint> points) : marker_(marker), points_(std::move(points)) {
    for (const MarkerPoint& p : points_)
      if (norm(p.measured) > largest_) largest_ = norm(p.measured), axis_ = (1 / largest_) * p.measured;
  }

  double largest() const { return largest_; }
  HistoryCurve curve(const std::string& history) const {
    HistoryCurve curve{.history = history, .reading = "motion", .unit = "m", .marker = marker_, .points = {}};
    for (const MarkerPoint& p : points_)
      curve.points.push_back({p.time, dot(p.measured, axis_), along(p.sigma, axis_), dot(p.fitted, axis_)});
    return curve;
  }

 private:
  int marker_;
  std::vector<MarkerPoint> points_;
  double largest_ = 0;
  Vec3d axis_{};
};

std::vector<MarkerMotion> motions(const Experiment& body, const LoadHistory& history,
                                  const HistoryPrediction& prediction) {
  std::vector<std::vector<MarkerPoint>> points(body.markers.size());
  size_t next = 0;
  for (size_t w = 0; w < history.waypoints.size(); ++w)
    for (const MarkerReading& reading : history.waypoints[w].positions) {
      const Vec3d rest = at_rest(body, body.markers[static_cast<size_t>(reading.marker)]);
      points[static_cast<size_t>(reading.marker)].push_back(
          {history.times[w], reading.position - rest, prediction.markers[next++] - rest, reading.sigma});
    }
  std::vector<MarkerMotion> all;
  for (size_t m = 0; m < points.size(); ++m)
    if (points[m].size() > 1) all.emplace_back(static_cast<int>(m), std::move(points[m]));
  return all;
}

}  // namespace

std::vector<HistoryCurve> curves_of(const Experiment& body, const LoadHistory& history,
                                    const HistoryPrediction& prediction) {
  std::vector<HistoryCurve> curves = force_curves(history, prediction);
  std::vector<MarkerMotion> all = motions(body, history, prediction);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.largest() > b.largest(); });
  if (all.size() > kMarkersWithCurve) all.erase(all.begin() + kMarkersWithCurve, all.end());
  for (const MarkerMotion& motion : all)
    if (motion.largest() > 0) curves.push_back(motion.curve(history.name));
  return curves;
}

}  // namespace aspic
