#include <algorithm>
#include <cmath>
#include <set>

#include "data/data_findings.h"
#include "data/surface_projection.h"
#include "model/gauge.h"
#include "model/limits.h"

namespace aspic {
namespace {

// Limits of findings are chosen: they decide about messages and refusals, not about results.
constexpr size_t kMaxCompared = 300;  // motions; their comparison is quadratic in the number
constexpr double kSameMotion = 0.02;  // smallest relative difference between two distinct motions
constexpr int kFewNumbers = 30;       // measured numbers

bool nearly_same(const Vec3d& a, const Vec3d& b) { return norm(a - b) <= 1e-9 * (norm(a) + norm(b)); }

bool same_load(const LoadCase& a, const LoadCase& b) {
  if (a.indenter.has_value() != b.indenter.has_value() || a.pressure != b.pressure ||
      !nearly_same(a.gravity, b.gravity) || (a.pressure != 0 && a.is_dead_pressure != b.is_dead_pressure))
    return false;
  if (a.grip.has_value() != b.grip.has_value()) return false;
  if (a.grip && (a.grip->vertices != b.grip->vertices || !nearly_same(a.grip->displacement, b.grip->displacement) ||
                 !nearly_same(a.grip->rotation, b.grip->rotation)))
    return false;
  if (!a.pressed.empty() && a.pressed != b.pressed) return false;
  return !a.indenter || (a.indenter->radius == b.indenter->radius && a.indenter->shape == b.indenter->shape &&
                         nearly_same(a.touch.center, b.touch.center) && nearly_same(a.touch.axis, b.touch.axis) &&
                         nearly_same(a.pose.center, b.pose.center) && nearly_same(a.pose.rotation, b.pose.rotation));
}

bool same_readings(const LoadCase& a, const LoadCase& b) {
  if (a.positions.size() != b.positions.size() || a.force.has_value() != b.force.has_value()) return false;
  if (a.force && norm(*a.force - *b.force) > 0) return false;
  for (size_t i = 0; i < a.positions.size(); ++i)
    if (a.positions[i].marker != b.positions[i].marker || norm(a.positions[i].position - b.positions[i].position) > 0)
      return false;
  return true;
}

class ContentDiagnosis {
 public:
  ContentDiagnosis(const DataSet& data, DataFindings& findings)
      : data_(data), experiment_(data.experiment), findings_(findings) {}

  void run() {
    count_numbers();
    compare_cases();
    examine_rigid_motion();
    examine_rank();
  }

 private:
  std::string where(size_t c) const {
    return data_.source.load_case(static_cast<int>(c)) + " (" + experiment_.cases[c].name + ")";
  }

  void count_numbers() {
    int numbers = 0;
    std::set<int> seen;
    std::set<std::string> groups;
    for (size_t c = 0; c < experiment_.cases.size(); ++c) {
      const LoadCase& load = experiment_.cases[c];
      const int here = 3 * (static_cast<int>(load.positions.size()) + (load.force ? 1 : 0) + (load.torque ? 1 : 0));
      if (here == 0)
        findings_.error(where(c), "no measurements: no position, no force, no torque",
                        "remove the row, or check that positions name this case");
      numbers += here;
      groups.insert(load.group);
      for (const MarkerReading& r : load.positions) seen.insert(r.marker);
    }
    if (numbers < kFewNumbers && data_.histories.empty())
      findings_.warning(seen.empty() ? data_.source.cases : data_.source.positions,
                        "only " + std::to_string(numbers) + " numbers were measured in " +
                            std::to_string(experiment_.cases.size()) +
                            (experiment_.cases.size() == 1 ? " case" : " cases"),
                        "enough for one value of the whole body; locating stiff parts needs more markers or cases");
    if (groups.size() == 1 && experiment_.cases.size() > 1)
      findings_.note(data_.source.cases, "all cases are of one group",
                     "poke at several sites: distant parts stay undetermined, and no group can be held out to "
                     "test the fit");
    const size_t unseen = experiment_.markers.size() - seen.size();
    if (unseen > 0 && !seen.empty())
      findings_.note(data_.source.markers,
                     std::to_string(unseen) + (unseen == 1 ? " marker was" : " markers were") + " never measured",
                     "check their names in positions");
  }

  void compare_cases() {
    const std::vector<LoadCase>& cases = experiment_.cases;
    for (size_t b = 1; b < std::min(cases.size(), 5 * kMaxCompared); ++b)
      for (size_t a = 0; a < b; ++a) {
        if (!same_load(cases[a], cases[b])) continue;
        const std::string what = "has the same load as '" + cases[a].name + "'";
        if (same_readings(cases[a], cases[b])) {
          findings_.warning(where(b), what + " and the same readings to the last digit",
                            "a copy counts twice; remove it");
        } else {
          findings_.note(where(b), what, "a repetition; both are fitted");
        }
        break;
      }
  }

  // Fixed parts should not move: examines markers between fixed vertices as one rigid body.
  void examine_rigid_motion() {
    std::vector<char> fixed(experiment_.mesh.rest.size(), 0);
    for (const int v : experiment_.fixed) fixed[v] = 1;
    const auto is_still = [&](const SurfacePoint& p) {
      double held = 0;
      for (int i = 0; i < 3; ++i) held += fixed[p.vertices[i]] ? p.weights[i] : 0;
      return held > 0.999;
    };
    for (size_t c = 0; c < experiment_.cases.size(); ++c) {
      std::vector<Vec3d> X, u;
      double sigma = 0;
      for (const MarkerReading& r : experiment_.cases[c].positions) {
        if (!is_still(experiment_.markers[r.marker])) continue;
        X.push_back(position(experiment_.markers[r.marker], experiment_.mesh.rest));
        u.push_back(displacement(experiment_, r));
        sigma = std::max(sigma, norm(r.sigma));
      }
      if (!X.empty()) examine_motion_of_fixed(where(c), X, u, sigma);
    }
  }

  void examine_motion_of_fixed(const std::string& place, const std::vector<Vec3d>& X, const std::vector<Vec3d>& u,
                               double sd) {
    const double n = static_cast<double>(X.size());
    Vec3d center{}, t{}, moment{};
    for (size_t i = 0; i < X.size(); ++i) center = center + (1 / n) * X[i], t = t + (1 / n) * u[i];
    // Least squares of u = t + w x r: (sum |r|^2 I - r r') w = sum r x u.
    Mat3d J{};
    for (size_t i = 0; i < X.size(); ++i) {
      const Vec3d r = X[i] - center;
      J = J + dot(r, r) * identity3<double>() - from_columns(r[0] * r, r[1] * r, r[2] * r);
      moment = moment + cross(r, u[i]);
    }
    const double scale = trace(J);
    const bool turns = X.size() >= 3 && determinant(J) > 1e-9 * scale * scale * scale;
    const Vec3d w = turns ? inverse(J) * moment : Vec3d{};
    // Both over their standard deviations: that of w is sd J^-1/2, large for markers that are close together.
    const bool has_moved = norm(t) > kManySigmas * sd / std::sqrt(n),
               has_turned = dot(w, moment) > std::pow(kManySigmas * sd, 2);
    if (!has_moved && !has_turned) return;
    const std::string shift = has_moved ? three_digits(norm(t)) + " m" : "",
                      turn = has_turned ? three_digits(norm(w)) + " rad" : "";
    findings_.warning(place,
                      "fixed vertices moved: by " + shift + (has_moved && has_turned ? " and " : "") + turn +
                          ", seen at " + std::to_string(X.size()) + " markers",
                      "remove this rigid motion from positions and pose of the case, or fix the camera");
  }

  // Finds motions that are combinations of others up to noise, by Gram-Schmidt on the cases.
  void examine_rank() {
    const std::vector<LoadCase>& cases = experiment_.cases;
    std::set<std::string> groups;
    std::vector<std::vector<double>> basis;
    int motions = 0;
    for (size_t c = 0; c < std::min(cases.size(), kMaxCompared); ++c) {
      std::vector<double> u(3 * experiment_.markers.size(), 0.0);
      double noise = 0;
      for (const MarkerReading& r : cases[c].positions) {
        const Vec3d d = displacement(experiment_, r);
        for (int i = 0; i < 3; ++i)
          if (is_measured(r.sigma, i)) u[3 * r.marker + i] = d[i], noise += r.sigma[i] * r.sigma[i];
      }
      double whole = 0, left = 0;
      for (const double x : u) whole += x * x;
      if (whole <= 4 * noise) continue;  // it does not move
      ++motions;
      groups.insert(cases[c].group);
      for (const std::vector<double>& b : basis) {
        double along = 0;
        for (size_t i = 0; i < u.size(); ++i) along += b[i] * u[i];
        for (size_t i = 0; i < u.size(); ++i) u[i] -= along * b[i];
      }
      for (const double x : u) left += x * x;
      if (left <= std::max(kSameMotion * kSameMotion * whole, 4 * noise)) continue;
      for (double& x : u) x /= std::sqrt(left);
      basis.push_back(std::move(u));
    }
    report_rank(motions, groups.size(), basis.size());
  }

  void report_rank(int motions, size_t groups, size_t rank) {
    const bool has_positions = std::any_of(experiment_.cases.begin(), experiment_.cases.end(),
                                           [](const LoadCase& load) { return !load.positions.empty(); });
    if (has_positions && motions == 0)
      return findings_.warning(data_.source.positions, "no case moves the markers by more than their noise",
                               "poke deeper, place markers nearer to the indenter, or check sd");
    if (groups > 1 && rank < groups)
      findings_.warning(data_.source.positions,
                        "the data are rank-deficient: the motions of " + std::to_string(groups) +
                            " groups are combinations of " + std::to_string(rank) + ", but for noise",
                        "poke at other sites, in other directions; the same motion again adds no information");
  }

  const DataSet& data_;
  const Experiment& experiment_;
  DataFindings& findings_;
};

}  // namespace

void diagnose_content(const DataSet& data, DataFindings& findings) { ContentDiagnosis(data, findings).run(); }

}  // namespace aspic
