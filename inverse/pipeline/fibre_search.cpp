#include "pipeline/fibre_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "model/limits.h"
#include "model/quantity.h"

namespace aspic {
namespace {

// Smallest angle of another start from the best direction: below the 37.4 degrees within which a start is.
constexpr double kNewStart = 30 * std::numbers::pi / 180;
constexpr double kCone95 = 2.447747;  // quantile of Rayleigh's distribution, sqrt(-2 log 0.05)

// The six axes of an icosahedron. Every axis is within 37.4 degrees of one of them.
std::vector<Vec3d> first_directions() {
  constexpr double g = std::numbers::phi;
  std::vector<Vec3d> axes = {{{0, 1, g}}, {{0, 1, -g}}, {{1, g, 0}}, {{1, -g, 0}}, {{g, 0, 1}}, {{-g, 0, 1}}};
  for (Vec3d& a : axes) a = (1 / norm(a)) * a;
  return axes;
}

double largest_angle(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double largest = 0;
  for (size_t r = 0; r < a.size(); ++r) largest = std::max(largest, angle_between(a[r], b[r]));
  return largest;
}

class Search {
 public:
  Search(const FitPlan& plan, const FitFibres& fit) : first_(plan), fit_(fit) {}

  void run(int regions) {
    const std::vector<Vec3d> starts = first_directions();
    for (size_t k = 0; k < starts.size() && !is_stopped_; ++k) {
      FitPlan plan = first_;
      plan.fibre_directions.assign(static_cast<size_t>(regions), starts[k]);
      attempt(std::move(plan), std::to_string(k),
              "start " + std::to_string(k + 1) + " of " + std::to_string(starts.size()));
    }
    if (regions > 1 && best_) vary_regions(starts);
  }

  // Another direction in one region after another, with the best ones in the others.
  void vary_regions(const std::vector<Vec3d>& starts) {
    const size_t regions = best_->fibre_directions.size();
    for (size_t r = 0; r < regions; ++r) {
      const Vec3d now = best_->fibre_directions[r];
      for (size_t k = 0; k < starts.size() && !is_stopped_; ++k) {
        if (angle_between(now, starts[k]) < kNewStart) continue;
        FitPlan plan = *best_;
        plan.fibre_directions[r] = starts[k];
        attempt(std::move(plan), std::to_string(r) + "_" + std::to_string(k),
                "another start in region " + std::to_string(r + 1) + " of " + std::to_string(regions));
      }
    }
  }

  FibreSearch take(FitPlan& plan) {
    if (best_) plan = *best_, found_.failure.clear();
    std::stable_sort(found_.minima.begin(), found_.minima.end(),
                     [](const FibreMinimum& a, const FibreMinimum& b) { return a.objective < b.objective; });
    return std::move(found_);
  }

 private:
  void attempt(FitPlan plan, const std::string& name, const std::string& what) {
    const FibreTrial trial = fit_(plan, "fibres_" + name, what);
    is_stopped_ = trial.report.status == Status::interrupted;
    if (is_stopped_) return;
    if (!trial.failure.empty()) {
      if (found_.failure.empty()) found_.failure = trial.failure;
      return;
    }
    const FitReport& report = trial.report;
    const double objective = report.misfit + report.weight * report.roughness;
    add({objective, plan.fibre_directions});
    if (best_ && !(objective < objective_)) return;
    objective_ = objective;
    best_ = std::move(plan);
  }

  void add(FibreMinimum found) {
    for (FibreMinimum& known : found_.minima) {
      if (largest_angle(known.directions, found.directions) > kSameFibres) continue;
      if (found.objective < known.objective) known = std::move(found);
      return;
    }
    found_.minima.push_back(std::move(found));
  }

  FitPlan first_;
  const FitFibres& fit_;
  std::optional<FitPlan> best_;
  double objective_ = 0;  // of the best plan
  bool is_stopped_ = false;
  FibreSearch found_;
};

}  // namespace

bool fits_fibres(const FitPlan& plan) {
  return std::any_of(plan.parameters.begin(), plan.parameters.end(),
                     [](const FitParameter& u) { return u.quantity == kFibreTilts[0]; });
}

FibreTilts fibre_tilts(const ParameterMap& map) {
  FibreTilts tilts;
  for (size_t u = 0; u < map.fitted_parameters().size(); ++u)
    for (int k = 0; k < 2; ++k)
      if (map.fitted_parameters()[u].quantity == kFibreTilts[k])
        tilts.parameter[k] = static_cast<int>(u), tilts.first[k] = map.range(static_cast<int>(u)).first;
  const FieldBasis& basis = map.basis(tilts.parameter[0]);
  tilts.tet.assign(static_cast<size_t>(basis.size()), -1);
  basis.for_each_weight([&](int t, int j, double) {
    if (tilts.tet[j] < 0) tilts.tet[j] = t;
  });
  return tilts;
}

std::vector<Vec3d> fibre_directions(const ParameterMap& map, std::span<const double> p) {
  const int x = fibre_components(map.material()).value();
  const std::vector<MaterialParameters> parameters = map.parameters(p);
  std::vector<Vec3d> directions;
  for (const int t : fibre_tilts(map).tet) {
    const auto& extra = parameters[t].extra;
    directions.push_back({{extra[x], extra[x + 1], extra[x + 2]}});
  }
  return directions;
}

void adopt_values(const ParameterMap& map, std::span<const double> p, FitPlan& plan) {
  for (size_t u = 0; u < plan.parameters.size(); ++u)
    plan.parameters[u].guess = is_tilt(plan.parameters[u].quantity) ? 0 : map.values(static_cast<int>(u), p).front();
  if (fits_fibres(plan)) plan.fibre_directions = fibre_directions(map, p);
}

double angle_between(const Vec3d& a, const Vec3d& b) { return std::atan2(norm(cross(a, b)), std::abs(dot(a, b))); }

FibreSearch search_fibres(FitPlan& plan, int regions, const FitFibres& fit) {
  Search search(plan, fit);
  search.run(regions);
  return search.take(plan);
}

double cone_of(const TiltCovariance& c, const Vec3d& du, const Vec3d& dv) {
  // The largest eigenvalue of D C D' is that of D'D C, D = (du, dv).
  const double a = dot(du, du), b = dot(du, dv), d = dot(dv, dv);
  const double trace = a * c.uu + 2 * b * c.uv + d * c.vv;
  const double determinant = (a * d - b * b) * (c.uu * c.vv - c.uv * c.uv);
  const double largest = (trace + std::sqrt(std::max(trace * trace - 4 * determinant, 0.0))) / 2;
  const double cone = kCone95 * std::sqrt(largest);
  return cone <= kLinearRange ? cone : std::numbers::pi / 2;
}

}  // namespace aspic
