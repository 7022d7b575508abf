#include "pipeline/compared_laws.h"

#include <algorithm>
#include <set>

#include "model/limits.h"

namespace aspic {
namespace {

constexpr char kReference[] = "neo_hookean";

const Law& law_named(const std::string& name) {
  return *std::find_if(compared_laws().begin(), compared_laws().end(),
                       [&](const Law& law) { return law.name == name; });
}

int region_count(const TetMesh& mesh) {
  return static_cast<int>(std::set<int>(mesh.region.begin(), mesh.region.end()).size());
}

}  // namespace

// Isotropic laws with at most two values besides E and nu. The priors span the published materials.
const std::vector<Law>& compared_laws() {
  static const std::vector<Law> all = {{kReference, {}, {}},
                                       {"neo_hookean_isochoric", {}, {}},
                                       {"mooney_rivlin", {{"share", 0.5, 2, {0.5}}}, {}},
                                       {"yeoh", {{"b2", 0.1, 0.2, {0.1, 1}}, {"b3", 0.01, 2, {0.01, 0.1}}}, {}},
                                       {"gent", {{"limit", 10, 2, {10, 100, 2}}}, {}},
                                       {"fung", {{"b", 1, 2, {1, 0.1, 5}}}, {}},
                                       {"ogden", {{"alpha", 2, 0.2, {2.5, 8, -8}}}, {{"alpha_2", -2}, {"share_2", 0}}}};
  return all;
}

FitPlan with_law(FitPlan plan, const Law& law) {
  plan.model = law.name;
  for (const OwnParameter& own : law.own)
    plan.parameters.push_back({.quantity = own.name,
                               .parameterization = Parameterization::uniform,
                               .handles = 0,
                               .guess = own.mean,
                               .prior_sigma = own.sigma});
  plan.known.insert(plan.known.end(), law.known.begin(), law.known.end());
  return plan;
}

FitPlan simplified(FitPlan plan, const TetMesh& mesh, std::string* what) {
  const int regions = region_count(mesh);
  const bool has_regions = regions > 1 && regions <= kMaxPhases;
  for (FitParameter& u : plan.parameters) {
    if (!has_many_values(u)) continue;
    u.parameterization = has_regions ? Parameterization::regions : Parameterization::uniform;
    u.handles = 0;
    if (what) *what = has_regions ? "one value per region instead of a field" : "one value instead of a field";
  }
  plan.parts = 0;
  plan.fit = for_single_values(plan.fit);
  plan.fit.starts = 1;
  return plan;
}

FitPlan plan_with_law(const FitPlan& plan, const LawChoice& choice) {
  const Law& law = law_named(choice.chosen < 0 ? kReference : choice.trials[static_cast<size_t>(choice.chosen)].law);
  FitPlan chosen = with_law(plan, law);
  if (choice.chosen < 0) return chosen;
  for (FitParameter& u : chosen.parameters)
    for (const LawValue& value : choice.trials[static_cast<size_t>(choice.chosen)].values)
      if (value.quantity == u.quantity && value.where == "everywhere") u.guess = value.value;
  for (FitParameter& u : chosen.parameters) u.prior_sigma = 0;
  return chosen;
}

}  // namespace aspic
