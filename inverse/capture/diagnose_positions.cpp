#include <algorithm>
#include <array>

#include "capture/case_table.h"
#include "capture/data_findings.h"
#include "capture/surface_projection.h"
#include "math/vectors.h"
#include "mesh/box.h"

namespace aspic {
namespace {

constexpr int kNeighbors = 12;
constexpr size_t kMaxListed = 5;      // listed findings per kind; others are counted
constexpr double kOffSurface = 0.02;  // fraction of the body's size
constexpr double kSuspicious = 6;     // multiple of the differences between neighbors
constexpr double kNoticeable = 0.05;  // fraction of the largest motion of the case
constexpr double kReach = 2;          // radii around an indenter within which the surface follows it
constexpr double kFar = 1;            // fraction of the body's size; larger motions are implausible
constexpr double kFarthest = 10;      // the same for a single marker; larger motions are errors
constexpr double kLever = 3;  // multiple of the indenter's displacement; larger median motions have another cause
constexpr double kFinestPosition = 1e-9;  // fraction of the body's size; no instrument has smaller deviations

// Indices of the nearest of the given markers at rest, for each marker.
std::vector<std::vector<int>> neighbors(const std::vector<Vec3d>& X) {
  std::vector<Box> boxes(X.size());
  for (size_t i = 0; i < X.size(); ++i) boxes[i].add(X[i]);
  const BoxTree tree(boxes);
  std::vector<std::vector<int>> nearest(X.size());
  for (size_t i = 0; i < X.size(); ++i) {
    std::vector<std::pair<double, int>> found;
    double reach = Box::kInfinity;
    tree.for_each_near(X[i], reach, [&](int j) {
      if (j == static_cast<int>(i)) return;
      const std::pair<double, int> candidate = {dot(X[j] - X[i], X[j] - X[i]), j};
      found.insert(std::upper_bound(found.begin(), found.end(), candidate), candidate);
      if (found.size() > kNeighbors) found.pop_back();
      if (found.size() == kNeighbors) reach = found.back().first;
    });
    for (const auto& [distance, j] : found) nearest[i].push_back(j);
  }
  return nearest;
}

using Row4 = std::array<double, 4>;

// Solves the symmetric positive definite A c = b for three right-hand sides.
std::array<Vec3d, 4> solve(std::array<Row4, 4> A, std::array<Vec3d, 4> b) {
  for (int k = 0; k < 4; ++k)
    for (int i = k + 1; i < 4; ++i) {
      const double l = A[i][k] / A[k][k];
      for (int j = k; j < 4; ++j) A[i][j] -= l * A[k][j];
      b[i] = b[i] - l * b[k];
    }
  for (int k = 3; k >= 0; --k) {
    for (int j = k + 1; j < 4; ++j) b[k] = b[k] - A[k][j] * b[j];
    b[k] = (1 / A[k][k]) * b[k];
  }
  return b;
}

struct Expected {
  Vec3d u{};          // motion of the marker predicted from its neighbors
  double spread = 0;  // median deviation of the neighbors from such a field
  double range = 0;   // median deviation of the neighbors from the marker's expected motion
};

// Fits the field u = c + B (X - X_i) / reach with the least sum of |u_j - u| over the neighbors, by reweighted least
// squares, which downweights outliers among the neighbors.
Expected expected(const std::vector<Vec3d>& X, const std::vector<Vec3d>& u, int i, const std::vector<int>& near) {
  constexpr int kSweeps = 8;
  constexpr double kRidge = 1e-3;  // regularizes the normal slope for coplanar neighbors
  const double reach = norm(X[near.back()] - X[i]);
  const auto terms = [&](int j) {
    const Vec3d r = (reach > 0 ? 1 / reach : 0) * (X[j] - X[i]);
    return Row4{1, r[0], r[1], r[2]};
  };
  std::vector<double> weight(near.size(), 1), difference(near.size());
  std::array<Vec3d, 4> c{};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::array<Row4, 4> A{};
    std::array<Vec3d, 4> b{};
    for (int k = 1; k < 4; ++k) A[k][k] = kRidge;
    for (size_t n = 0; n < near.size(); ++n) {
      const Row4 t = terms(near[n]);
      for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < 4; ++l) A[k][l] += weight[n] * t[k] * t[l];
        b[k] = b[k] + (weight[n] * t[k]) * u[near[n]];
      }
    }
    c = solve(A, b);
    for (size_t n = 0; n < near.size(); ++n) {
      const Row4 t = terms(near[n]);
      difference[n] = norm(u[near[n]] - (t[0] * c[0] + t[1] * c[1] + t[2] * c[2] + t[3] * c[3]));
    }
    const double typical = median(difference);
    for (size_t n = 0; n < near.size(); ++n) weight[n] = typical > 0 ? typical / std::max(difference[n], typical) : 1;
  }
  std::vector<double> range;
  for (const int j : near) range.push_back(norm(u[j] - c[0]));
  return {c[0], median(difference), median(range)};
}

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
    if (motion.empty() || median(motion) < kFar * size_) return true;
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
        const std::string where = data_.source.position(static_cast<int>(c), static_cast<int>(i));
        const std::string who = name(r.marker) + " in '" + experiment_.cases[c].name + "'";
        if (!(norm(displacement(experiment_, r)) < kFarthest * size_))
          return refuse(where, who + " is far outside the body of size " + three_digits(size_) + " m",
                        "correct its position, or remove the row");
        const double finest = std::min({r.sigma[0], r.sigma[1], r.sigma[2]});
        if (finest < kFinestPosition * size_)
          return refuse(
              where, who + " has a standard deviation of " + three_digits(finest) + " m, which no instrument attains",
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
          noise.push_back(norm(r.sigma));
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

  void examine_outliers(int c) {
    const std::vector<MarkerReading>& readings = experiment_.cases[c].positions;
    if (readings.size() <= kNeighbors) return;
    std::vector<Vec3d> X, u;
    double largest = 0;
    for (const MarkerReading& r : readings) {
      X.push_back(position(experiment_.markers[r.marker], experiment_.mesh.rest));
      u.push_back(displacement(experiment_, r));
    }
    const std::vector<std::vector<int>> near = neighbors(X);
    std::vector<double> excess(u.size()), spread(u.size()), range(u.size());
    for (size_t i = 0; i < u.size(); ++i) {
      const Expected typical = expected(X, u, static_cast<int>(i), near[i]);
      spread[i] = typical.spread;
      range[i] = typical.range;
      excess[i] = norm(u[i] - typical.u);
      largest = std::max(largest, norm(typical.u));
    }
    for (size_t i = 0; i < u.size(); ++i) {
      const double tolerated = kSuspicious * (spread[i] + norm(readings[i].sigma));
      // The top of a sharp dent differs from its neighbors, but not by more than they differ from each other, nor by
      // more than the estimated motion by the indenter.
      if (excess[i] > std::max({tolerated, kNoticeable * largest, range[i], by_tip(experiment_.cases[c], X[i])}) &&
          ++outliers_ <= kMaxListed)
        findings_.warning(data_.source.position(c, static_cast<int>(i)),
                          name(readings[i].marker) + " in '" + experiment_.cases[c].name + "' is " +
                              three_digits(excess[i]) + " m away from the motion of its neighbors, which differ by " +
                              three_digits(spread[i]) + " m",
                          "correct the tracking, remove the row, or increase its sd");
    }
  }

  const DataSet& data_;
  const Experiment& experiment_;
  DataFindings& findings_;
  double size_;
  size_t outliers_ = 0;
};

}  // namespace

void diagnose_positions(const DataSet& data, DataFindings& findings) { PositionDiagnosis(data, findings).run(); }

}  // namespace aspic
