#include "fit/law_errors.h"

#include "fit/predictions.h"

namespace aspic {

std::string rival_of(const std::string& material) {
  if (material == "neo_hookean" || material == "stable_neo_hookean" || material == "neo_hookean_log" ||
      material == "neo_hookean_log_j2")
    return "neo_hookean_isochoric";
  if (material == "neo_hookean_isochoric" || material == "neo_hookean_2020") return "neo_hookean_log";
  return "";
}

LawErrors law_errors(const Experiment& experiment, const std::string& material,
                     std::span<const MaterialParameters> parameters, const EquilibriumOptions& options) {
  const std::string rival = rival_of(material);
  if (rival.empty()) return {};
  const std::vector<MaterialParameters> own = of_tets(experiment, parameters);
  const Predictions ours = predicted(experiment, material, own, options);
  const Predictions theirs = predicted(experiment, rival, own, options);
  LawErrors errors{{}, ours.failure.empty() ? theirs.failure : ours.failure};
  if (!errors.failure.empty()) return errors;
  for (size_t c = 0; c < ours.cases.size(); ++c) {
    const CasePrediction &a = ours.cases[c], &b = theirs.cases[c];
    CommonError& error = errors.cases.emplace_back();
    for (size_t k = 0; k < a.markers.size(); ++k) error.markers.push_back(b.markers[k] - a.markers[k]);
    error.wrench = {b.wrench.force - a.wrench.force, b.wrench.torque - a.wrench.torque};
  }
  return errors;
}

}  // namespace aspic
