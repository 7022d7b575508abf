// Directions of fibres: the search for the best minimum, and the result with its uncertainty.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "model/limits.h"
#include "model/quantity.h"
#include "pipeline/fit_stages.h"
#include "pipeline/fit_troubles.h"

namespace aspic {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
// Maximum per start, and relative decrement, for a choice among starts whose best one is fitted again. Chosen.
constexpr int kSearchIterations = 10;
constexpr double kSearchTolerance = 1e-2;
// Upper over lower end of the interval of fibre_ratio: fibres may have no effect. Chosen.
constexpr double kWeakestRatio = 10;

std::vector<std::string> names_of_regions(const TetMesh& mesh, size_t count) {
  std::vector<std::string> names;
  if (count == 1) return {"everywhere"};
  for (const int label : std::set<int>(mesh.region.begin(), mesh.region.end()))
    names.push_back("region " + std::to_string(label));
  return names;
}

// The sign for which the largest component is positive.
Vec3d as_axis(const Vec3d& a) {
  int largest = 0;
  for (int r = 1; r < 3; ++r)
    if (std::abs(a[r]) > std::abs(a[largest])) largest = r;
  return a[largest] < 0 ? -1.0 * a : a;
}

bool may_have_no_effect(const std::vector<FittedQuantity>& quantities, size_t region) {
  for (const FittedQuantity& q : quantities) {
    if (q.name != kFibreRatio || q.rows.empty()) continue;
    const std::optional<Interval>& ratio = q.rows[std::min(region, q.rows.size() - 1)].interval;
    if (ratio && ratio->upper > kWeakestRatio * ratio->lower) return true;
  }
  return false;
}

FibreTrial fit_fibres(FitState& state, FitPlan& plan, const std::string& name, const std::string& what) {
  state.begin(FitStage::uniform, "direction of the fibres, " + what);
  FitOptions options = for_single_values(state.plan.fit);
  options.starts = 1;
  options.max_iterations = std::min(options.max_iterations, kSearchIterations);
  options.tolerance = std::max(options.tolerance, kSearchTolerance);
  FitModel model = state.model_of(plan, single_values(plan.parameters), name);
  FibreTrial trial{fit_model(state, FitStage::uniform, model, options), ""};
  const FitReport& report = trial.report;
  state.outcome.report = report;
  if (is_success(report.status) || report.status == Status::iteration_limit)
    adopt_values(model.map, report.p, plan);
  else
    trial.failure = describe_failure(state.data, report, model.misfit.failure());
  return trial;
}

double cone_of_fibres(const Posterior* posterior, const ParameterMap& map, std::span<const double> p, size_t region) {
  if (!posterior || !posterior->gaussian) return -1;
  const FibreTilts tilts = fibre_tilts(map);
  const size_t count = static_cast<size_t>(map.size());
  std::vector<double> unit(count), u(count), v(count);
  const auto entry = [&](int k) { return static_cast<size_t>(tilts.first[k]) + region; };
  const auto covariance = [&](int k, std::vector<double>& column) {
    std::fill(unit.begin(), unit.end(), 0.0);
    unit[entry(k)] = 1;
    posterior->gaussian->covariance(unit, column);
  };
  covariance(0, u), covariance(1, v);
  // Derivatives of the direction.
  const int x = fibre_components(map.material()).value(), n = map.parameters_per_tet();
  std::vector<double> rates(static_cast<size_t>(n) * map.tet_count());
  Vec3d slope[2];
  for (int k = 0; k < 2; ++k) {
    std::fill(unit.begin(), unit.end(), 0.0);
    unit[entry(k)] = 1;
    map.multiply(p, unit, rates);
    for (int r = 0; r < 3; ++r) slope[k][r] = rates[static_cast<size_t>(n) * tilts.tet[region] + 2 + x + r];
  }
  return cone_of({u[entry(0)], v[entry(0)], v[entry(1)]}, slope[0], slope[1]);
}

}  // namespace

bool find_fibres(FitState& state) {
  FitPlan plan = state.plan;
  const auto tilt = std::find_if(plan.parameters.begin(), plan.parameters.end(),
                                 [](const FitParameter& u) { return is_tilt(u.quantity); });
  const bool is_regional = tilt->parameterization == Parameterization::regions;
  const std::set<int> labels(state.mesh().region.begin(), state.mesh().region.end());
  const int regions = is_regional ? static_cast<int>(labels.size()) : 1;
  state.fibres = search_fibres(plan, regions, [&](FitPlan& trial, const std::string& name, const std::string& what) {
    return fit_fibres(state, trial, name, what);
  });
  if (state.is_stopped())
    state.outcome.failure = "stopped before the directions of the fibres were found; --resume continues the search";
  else
    state.outcome.failure = state.fibres.failure;
  if (!state.outcome.failure.empty()) return false;
  state.plan.fibre_directions = plan.fibre_directions;
  for (size_t u = 0; u < state.plan.parameters.size(); ++u) state.plan.parameters[u].guess = plan.parameters[u].guess;
  return true;
}

std::vector<FoundFibres> found_fibres(const FitState& state, const ParameterMap& map, std::span<const double> p) {
  std::vector<FoundFibres> all;
  const std::vector<Vec3d> directions = fibre_directions(map, p);
  const std::vector<std::string> names = names_of_regions(state.mesh(), directions.size());
  const Posterior* posterior = state.outcome.known_posterior();
  const double factor = posterior ? posterior->applied_factor : 1;
  for (size_t r = 0; r < directions.size(); ++r) {
    FoundFibres& found = all.emplace_back(FoundFibres{.where = names[r], .direction = as_axis(directions[r])});
    double cone = cone_of_fibres(posterior, map, p, r);
    const double own = cone;
    for (const FibreMinimum& other : state.fibres.minima) {
      const double angle = angle_between(other.directions[r], directions[r]);
      const bool is_as_good =
          other.objective - state.fibres.minima.front().objective < kStrongEvidence * factor * factor;
      if (own < 0 || !is_as_good || angle <= own || angle <= kSameFibres) continue;
      found.others.push_back(as_axis(other.directions[r]));
      cone = std::max(cone, std::min(angle + own, std::numbers::pi / 2));
    }
    // A cone is that of the fitted ratio.
    if (cone >= 0 && may_have_no_effect(state.outcome.quantities, r)) cone = std::numbers::pi / 2;
    found.cone = cone < 0 ? -1 : kDegrees * cone;
  }
  return all;
}

}  // namespace aspic
