#include <algorithm>

#include "base/parallel.h"
#include "data/case_table.h"
#include "data/data_findings.h"
#include "data/surface_projection.h"
#include "math/vectors.h"
#include "model/gauge.h"
#include "model/limits.h"
#include "model/local_motion.h"

namespace aspic {
namespace {

// Limits of findings are chosen: they decide about messages and refusals, not about results.
constexpr double kSuspicious = 6;  // multiple of the differences between neighbors
constexpr double kReach = 2;       // radii around an indenter within which the surface follows it
constexpr double kLever = 3;       // multiple of the indenter's displacement; larger median motions have another cause

class PositionDiagnosis {
 public:
  PositionDiagnosis(const DataSet& data, DataFindings& findings)
      : data_(data), experiment_(data.experiment), findings_(findings), size_(size_of(experiment_.mesh)) {}

  void run() {
    examine_gaps();
    if (!examine_units()) return;     // otherwise every marker would be reported
    if (!examine_readings()) return;  // otherwise comparisons are meaningless
    if (!examine_way()) return;
    for (size_t c = 0; c < experiment_.cases.size(); ++c) examine_outliers(static_cast<int>(c));
    if (outliers_ > kMaxListed)
      findings_.warning(data_.source.positions, std::to_string(outliers_ - kMaxListed) + " more markers are outliers",
                        "correct the tracking, or increase sd");
  }

 private:
  std::string name(int marker) const { return "marker '" + data_.marker_names[marker] + "'"; }

  void examine_gaps() {
    std::vector<int> off;
    for (size_t m = 0; m < data_.marker_gap.size(); ++m)
      if (data_.marker_gap[m] > kOffSurface * size_) off.push_back(static_cast<int>(m));
    std::stable_sort(off.begin(), off.end(), [&](int a, int b) { return data_.marker_gap[a] > data_.marker_gap[b]; });
    for (size_t i = 0; i < std::min(off.size(), kMaxListed); ++i)
      findings_.warning(data_.source.marker(off[i]),
                        name(off[i]) + " lies " + three_digits(data_.marker_gap[off[i]]) +
                            " m off the surface; it was projected onto it",
                        "correct its position, or align the mesh with the markers at rest");
    if (off.size() > kMaxListed)
      findings_.warning(data_.source.markers,
                        std::to_string(off.size() - kMaxListed) + " more markers lie off the surface",
                        "align the mesh with the markers at rest");
  }

  // Motions larger than the body indicate another unit or coordinate system than at rest.
  bool examine_units() {
    std::vector<double> motion;
    for (const LoadCase& load : experiment_.cases)
      for (const MarkerReading& r : load.positions) motion.push_back(norm(displacement(experiment_, r)));
    if (motion.empty() || median(motion) < size_) return true;
    std::string remedy = "positions and the mesh must share one unit and one coordinate system";
    for (const double factor : {1e-3, 1e-2}) {
      std::vector<double> scaled;
      for (const LoadCase& load : experiment_.cases)
        for (const MarkerReading& r : load.positions)
          scaled.push_back(norm(factor * r.position - position(experiment_.markers[r.marker], experiment_.mesh.rest)));
      if (median(scaled) < 0.2 * size_) {
        const std::string unit = factor == 1e-3 ? "mm" : "cm";
        remedy = "in " + unit + " they would fit: units = { length = \"" + unit + "\" }";
      }
    }
    findings_.error(data_.source.positions,
                    "markers move by " + three_digits(median(motion)) + " m, more than the size of the body, " +
                        three_digits(size_) + " m",
                    remedy);
    return false;
  }

  // Finds implausible readings, whose residuals would dominate all others.
  bool examine_readings() {
    for (size_t c = 0; c < experiment_.cases.size(); ++c) {
      const std::vector<MarkerReading>& readings = experiment_.cases[c].positions;
      for (size_t i = 0; i < readings.size(); ++i) {
        const MarkerReading& r = readings[i];
        const auto where = [&] { return data_.source.position(static_cast<int>(c), static_cast<int>(i)); };
        const auto who = [&] { return name(r.marker) + " in '" + experiment_.cases[c].name + "'"; };
        if (!(norm(displacement(experiment_, r)) < kTooFar * size_))
          return refuse(where(), who() + " is far outside the body of size " + three_digits(size_) + " m",
                        "correct its position, or remove the row");
        const double finest = std::min({r.sigma[0], r.sigma[1], r.sigma[2]});
        if (finest < kFinest * size_)
          return refuse(
              where(),
              who() + " has a standard deviation of " + three_digits(finest) + " m, which no instrument attains",
              "check the unit of sd; leave it blank for 1 % of the largest motion");
      }
    }
    return true;
  }

  // Median motion of the markers that only an indenter moves; use(position, rest position) interprets positions.
  template <class Use>
  double default_motion(const Use& use) const {
    std::vector<double> motion;
    for (const LoadCase& load : experiment_.cases)
      for (const MarkerReading& r : load.positions) {
        if (!is_by_indenter_alone(load)) continue;
        const Vec3d X = position(experiment_.markers[r.marker], experiment_.mesh.rest);
        motion.push_back(norm(use(r.position, X) - X));
      }
    return median(motion);
  }

  static bool is_by_indenter_alone(const LoadCase& load) {
    return load.indenter && load.pressure == 0 && norm(load.gravity) == 0;
  }

  // Most parts of a body move less than the indenter; otherwise positions have another meaning.
  bool examine_way() {
    std::vector<double> way, noise;
    for (const LoadCase& load : experiment_.cases)
      for (const MarkerReading& r : load.positions)
        if (is_by_indenter_alone(load)) {
          way.push_back(load_size(load) + norm(load.pose.rotation) * size_);
          noise.push_back(std::sqrt(3.0) * rms_sigma(r.sigma));
        }
    if (way.empty()) return true;
    const double motion = default_motion([](const Vec3d& x, const Vec3d&) { return x; });
    if (motion <= kLever * (median(way) + median(noise))) return true;
    const std::string what =
        "markers move by " + three_digits(motion) + " m, the indenter by " + three_digits(median(way)) + " m (medians)";
    if (median(way) == 0)
      return refuse(data_.source.positions, what, "give the pose of the indenter in cases.csv: depth, or center");
    if (default_motion([](const Vec3d& x, const Vec3d& X) { return X + x; }) < motion / kLever)
      return refuse(data_.source.positions, what, "these are displacements; add the positions at rest");
    for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}})
      if (default_motion([i = i, j = j](Vec3d x, const Vec3d&) { return std::swap(x[i], x[j]), x; }) < motion / kLever)
        return refuse(data_.source.positions, what,
                      std::string("the columns ") + "xyz"[i] + " and " + "xyz"[j] + " seem to be swapped");
    findings_.warning(
        data_.source.positions, what,
        "check the units and columns of positions, and that they share the coordinate system of the mesh");
    return true;
  }

  bool refuse(const std::string& where, const std::string& what, const std::string& remedy) {
    findings_.error(where, what, remedy);
    return false;
  }

  // Estimated motion of a surface point by the indenter: its displacement, decaying like its radius over the distance.
  static double by_tip(const LoadCase& load, const Vec3d& X) {
    if (!load.indenter) return 0;
    const double distance = norm(X - load.touch.center);
    return load_size(load) * std::min(1.0, kReach * load.indenter->radius / distance);
  }

  // Neighbors of the markers at rest. Cases with the same markers share them.
  const std::vector<MotionNeighbors>& neighbors(const std::vector<Vec3d>& X) {
    const auto are_same = [](const Vec3d& a, const Vec3d& b) { return squared_norm(a - b) == 0; };
    if (!std::equal(X.begin(), X.end(), neighbors_of_.begin(), neighbors_of_.end(), are_same))
      neighbors_of_ = X, neighbors_ = nearest_points(X);
    return neighbors_;
  }

  // Whether a motion agrees with those of all neighbors within half the tolerance; then no field through them is
  // needed.
  static bool agrees(const std::vector<Vec3d>& u, size_t i, const MotionNeighbors& near, double sigma) {
    return std::all_of(near.begin(), near.end(), [&](int j) { return norm(u[j] - u[i]) <= kSuspicious / 2 * sigma; });
  }

  void examine_outliers(int c) {
    const LoadCase& load = experiment_.cases[c];
    const std::vector<MarkerReading>& readings = load.positions;
    if (readings.size() <= kMotionNeighbors) return;
    std::vector<Vec3d> X, u;
    for (const MarkerReading& r : readings) {
      X.push_back(position(experiment_.markers[r.marker], experiment_.mesh.rest));
      u.push_back(displacement(experiment_, r));
    }
    const std::vector<MotionNeighbors>& near = neighbors(X);
    std::vector<ExpectedMotion> typical(u.size());
    parallel_chunks(static_cast<int>(u.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i)
        typical[i] = agrees(u, i, near[i], norm(readings[i].sigma)) ? ExpectedMotion{u[i], 0, 0}
                                                                    : expected_motion(X, u, i, near[i]);
    });
    double largest = 0;
    for (const ExpectedMotion& motion : typical) largest = std::max(largest, norm(motion.u));
    for (size_t i = 0; i < u.size(); ++i) {
      const double excess = norm(u[i] - typical[i].u);
      const double tolerated = kSuspicious * (typical[i].spread + norm(readings[i].sigma));
      // The top of a sharp dent differs from its neighbors, but not by more than they differ from each other, nor by
      // more than the estimated motion by the indenter.
      if (excess > std::max({tolerated, kNegligible * largest, typical[i].range, by_tip(load, X[i])}) &&
          ++outliers_ <= kMaxListed)
        findings_.warning(data_.source.position(c, static_cast<int>(i)),
                          name(readings[i].marker) + " in '" + load.name + "' is " + three_digits(excess) +
                              " m away from the motion of its neighbors, which differ by " +
                              three_digits(typical[i].spread) + " m",
                          "correct the tracking, remove the row, or increase its sd");
    }
  }

  const DataSet& data_;
  const Experiment& experiment_;
  DataFindings& findings_;
  double size_;
  size_t outliers_ = 0;
  std::vector<Vec3d> neighbors_of_;  // markers at rest whose neighbors are known
  std::vector<MotionNeighbors> neighbors_;
};

}  // namespace

void diagnose_positions(const DataSet& data, DataFindings& findings) { PositionDiagnosis(data, findings).run(); }

}  // namespace aspic
