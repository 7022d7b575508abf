#include <algorithm>
#include <cmath>

#include "mesh/tet_mesh.h"
#include "model/quantity.h"
#include "pipeline/material_fit.h"

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

}  // namespace

std::vector<double> MaterialFit::divided(FitModel& model) {
  const FitReport& report = outcome_.report;
  const auto young = std::find_if(plan_.parameters.begin(), plan_.parameters.end(), [](const FitParameter& u) {
    return is_stiffness(u.quantity) && u.parameterization == Parameterization::tets;
  });
  if (plan_.parts == 0 || young == plan_.parameters.end() || is_stopped()) return report.p;
  const int parameter = static_cast<int>(young - plan_.parameters.begin());
  FoundParts& found = outcome_.parts.emplace();
  const int fewest = plan_.parts > 0 ? plan_.parts : 2, most = plan_.parts > 0 ? plan_.parts : kMaxParts;
  for (int count = fewest; count <= most && !found.are_kept && !is_stopped(); ++count, ++found.tried) {
    begin(FitStage::parts, std::to_string(count) + " parts");
    const Parts parts = find_parts(model.data(), {model.map, mesh(), report.p}, parameter, count);
    found.squares = parts.squares;
    found.are_kept = are_as_good(parts, 2 * report.misfit, outcome_.residuals);
    if (!found.are_kept) continue;
    outcome_.report.misfit = parts.squares / 2;
    if (outcome_.posterior) std::erase(outcome_.warnings, outcome_.posterior->misfit_warning);  // that of the field
    return keep(parts, model.map, parameter, found);
  }
  return report.p;
}

std::vector<double> MaterialFit::keep(const Parts& parts, const ParameterMap& map, int parameter, FoundParts& found) {
  const PartsEstimate& e = parts.estimate;
  for (size_t k = 0; k < e.levels.size(); ++k) {
    found.values.push_back(map.value(parameter, e.levels[k]));
    found.volume.push_back(share_of_body(mesh(), e.share[k]));
  }
  if (!outcome_.posterior || !outcome_.posterior->ok) return parts.p;
  set_sigmas(e.sigma, parameter, *outcome_.posterior);
  for (size_t k = 0; k < e.levels.size(); ++k) {
    const double s = kSigmas95 * e.level_sigma[k];
    found.intervals.push_back({map.value(parameter, e.levels[k] - s), map.value(parameter, e.levels[k] + s)});
  }
  const double contrast = found.values.back() / found.values.front(), s = std::exp(kSigmas95 * e.contrast_sigma);
  found.contrast = Interval{contrast / s, contrast * s};
  return parts.p;
}

}  // namespace aspic
