#include "fit/law_errors.h"

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
  auto& [ours, on_fine_mesh, rival, stiffer] = last ? *last : first;
  const auto starting = [&](const Predictions& before) -> const Predictions& {
    return before.cases.empty() ? ours : before;
  };
  ours = predicted(experiment, material, own, options, ours);
  rival =
      predicted(experiment, is_coupled ? "neo_hookean_isochoric" : "neo_hookean_log", own, options, starting(rival));
  stiffer = predicted(experiment, "yeoh", stiffening, options, starting(stiffer));
  LawErrors errors;
  for (const Predictions* p : {&ours, &rival, &stiffer})
    if (errors.failure.empty()) errors.failure = p->failure;
  if (!errors.failure.empty()) return errors;
  for (size_t c = 0; c < ours.cases.size(); ++c) {
    const CasePrediction& isochoric = is_coupled ? rival.cases[c] : ours.cases[c];
    errors.cases.push_back({difference("coupling of shear and volume", ours.cases[c], rival.cases[c]),
                            difference("stiffening", isochoric, stiffer.cases[c])});
  }
  return errors;
}

}  // namespace aspic
