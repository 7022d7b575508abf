#include "estimate/law_errors.h"

#include <algorithm>

namespace aspic {
namespace {

constexpr const char* kCoupled[] = {"neo_hookean", "stable_neo_hookean", "neo_hookean_log", "neo_hookean_log_j2"};
constexpr const char* kIsochoric[] = {"neo_hookean_isochoric", "neo_hookean_2020"};

template <class Names>
bool is_one_of(const Names& names, const std::string& material) {
  return std::find(std::begin(names), std::end(names), material) != std::end(names);
}

CommonError difference(const std::string& cause, const CasePrediction& from, const CasePrediction& to) {
  CommonError error{.cause = "the law, by its " + cause, .markers = {}, .wrench = {}};
  for (size_t k = 0; k < from.markers.size(); ++k) error.markers.push_back(to.markers[k] - from.markers[k]);
  error.wrench = {to.wrench.force - from.wrench.force, to.wrench.torque - from.wrench.torque};
  return error;
}

}  // namespace

bool has_law_errors(const std::string& material) {
  return is_one_of(kCoupled, material) || is_one_of(kIsochoric, material);
}

LawErrors law_errors(const Experiment& experiment, const std::string& material,
                     std::span<const MaterialParameters> parameters, const EquilibriumOptions& options,
                     ErrorPredictions* last) {
  if (!has_law_errors(material)) return {};
  const std::vector<MaterialParameters> own = of_tets(experiment, parameters);
  std::vector<MaterialParameters> stiffening = own;
  for (MaterialParameters& p : stiffening) p.extra = {kStiffening};
  const bool is_coupled = is_one_of(kCoupled, material);
  ErrorPredictions first;
  ErrorPredictions& p = last ? *last : first;
  const auto starting = [&](const Predictions& before) -> const Predictions& {
    return before.cases.empty() ? p.on_mesh : before;
  };
  p.on_mesh = predicted(experiment, material, own, options, p.on_mesh);
  p.other_law = predicted(experiment, is_coupled ? "neo_hookean_isochoric" : "neo_hookean_log", own, options,
                          starting(p.other_law));
  p.stiffening_law = predicted(experiment, "yeoh", stiffening, options, starting(p.stiffening_law));
  LawErrors errors;
  for (const Predictions* each : {&p.on_mesh, &p.other_law, &p.stiffening_law})
    if (errors.failure.empty()) errors.failure = each->failure;
  if (!errors.failure.empty()) return errors;
  for (size_t c = 0; c < p.on_mesh.cases.size(); ++c) {
    const CasePrediction &ours = p.on_mesh.cases[c], &rival = p.other_law.cases[c];
    errors.cases.push_back({difference("coupling of shear and volume", ours, rival),
                            difference("stiffening", is_coupled ? rival : ours, p.stiffening_law.cases[c])});
  }
  return errors;
}

}  // namespace aspic
