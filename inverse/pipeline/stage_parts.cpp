#include <algorithm>
#include <cmath>

#include "estimate/parts.h"
#include "mesh/tet_mesh.h"
#include "model/quantity.h"
#include "pipeline/fit_stages.h"

namespace aspic {
namespace {

// Keeps the prior of single tets.
void set_sigmas(const std::vector<double>& sigma, int parameter, Posterior& posterior) {
  for (size_t t = 0; t < sigma.size(); ++t) {
    double& own = posterior.sigma[parameter][t];
    double& reduction = posterior.reduction[parameter][t];
    const double before = own * own / std::max(1 - reduction, 1e-12);
    own = sigma[t];
    reduction = std::clamp(1 - own * own / before, 0.0, 1.0);
  }
}

double share_of_body(const TetMesh& mesh, const std::vector<double>& share) {
  double part = 0, all = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) all += volume(mesh, t), part += volume(mesh, t) * share[t];
  return part / all;
}

std::vector<double> keep(FitState& state, const Parts& parts, int parameter, FoundParts& found) {
  const ParameterMap& map = state.model->map;
  const PartsEstimate& e = parts.estimate;
  for (size_t k = 0; k < e.levels.size(); ++k) {
    found.values.push_back(map.value(parameter, e.levels[k]));
    found.volume.push_back(share_of_body(state.mesh(), e.share[k]));
  }
  if (!state.outcome.known_posterior()) return parts.p;
  set_sigmas(e.sigma, parameter, *state.outcome.posterior);
  for (size_t k = 0; k < e.levels.size(); ++k) {
    const double s = kSigmas95 * e.level_sigma[k];
    found.intervals.push_back({map.value(parameter, e.levels[k] - s), map.value(parameter, e.levels[k] + s)});
  }
  const double contrast = found.values.back() / found.values.front(), s = std::exp(kSigmas95 * e.contrast_sigma);
  found.contrast = Interval{contrast / s, contrast * s};
  return parts.p;
}

}  // namespace

std::vector<double> divided_into_parts(FitState& state) {
  FitModel& model = *state.model;
  const FitReport& report = state.outcome.report;
  const auto young = std::find_if(
      state.plan.parameters.begin(), state.plan.parameters.end(),
      [](const FitParameter& u) { return is_stiffness(u.quantity) && u.parameterization == Parameterization::tets; });
  if (state.plan.parts == 0 || young == state.plan.parameters.end() || state.is_stopped()) return report.p;
  const int parameter = static_cast<int>(young - state.plan.parameters.begin());
  FoundParts& found = state.outcome.parts.emplace();
  const int fewest = state.plan.parts > 0 ? state.plan.parts : 2,
            most = state.plan.parts > 0 ? state.plan.parts : kMaxParts;
  for (int count = fewest; count <= most && !found.are_kept && !state.is_stopped(); ++count, ++found.tried) {
    state.begin(FitStage::parts, std::to_string(count) + " parts");
    const Parts parts = find_parts(model.data(), {model.map, state.mesh(), report.p}, parameter, count);
    found.squares = parts.squares;
    found.are_kept = are_as_good(parts, 2 * report.misfit, state.outcome.residuals);
    if (!found.are_kept) continue;
    state.outcome.report.misfit = parts.squares / 2;
    if (state.outcome.posterior)
      std::erase(state.outcome.warnings, state.outcome.posterior->misfit_warning);  // that of the field
    return keep(state, parts, parameter, found);
  }
  return report.p;
}

}  // namespace aspic
