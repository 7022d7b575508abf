#include "pipeline/fitted_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/formatted.h"
#include "model/quantity.h"
#include "model/regularizer.h"

namespace aspic {
namespace {

// Representative tets: the only one, one per region, or minimum, median and maximum of a field.
std::vector<std::pair<std::string, int>> telling_tets(const FittedQuantity& quantity, const TetMesh& mesh) {
  const std::vector<double>& v = quantity.values;
  if (v.empty()) return {};
  if (quantity.parameterization == Parameterization::uniform) return {{"everywhere", 0}};
  std::vector<std::pair<std::string, int>> tets;
  if (quantity.parameterization == Parameterization::regions) {
    for (const int label : std::set<int>(mesh.region.begin(), mesh.region.end())) {
      const auto first = std::find(mesh.region.begin(), mesh.region.end(), label);
      tets.emplace_back("region " + std::to_string(label), static_cast<int>(first - mesh.region.begin()));
    }
    return tets;
  }
  std::vector<int> order(v.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return v[a] < v[b]; });
  const bool is_young = is_stiffness(quantity.name);
  return {{is_young ? "softest tet" : "lowest", order.front()},
          {"median tet", order[order.size() / 2]},
          {is_young ? "stiffest tet" : "highest", order.back()}};
}

// End of a range from -1 to 1, and fraction of the largest distance of a field from its guess. Chosen.
constexpr double kAtEnd = 0.9995, kNearWall = 0.9;

bool is_at_bound(const ParameterMap& map, int parameter, double fitted) {
  const FitParameter& u = map.fitted_parameters()[static_cast<size_t>(parameter)];
  if (is_stiffness(u.quantity) && has_many_values(u))
    return std::abs(fitted - std::log(u.guess)) > kNearWall * kFarthestOfField;
  return std::abs(map.place_in_range(parameter, fitted)) > kAtEnd;
}

}  // namespace

std::vector<FittedQuantity> fitted_quantities(const ParameterMap& map, const TetMesh& mesh, std::span<const double> p,
                                              const Posterior* posterior) {
  std::vector<FittedQuantity> result;
  for (size_t u = 0; u < map.fitted_parameters().size(); ++u) {
    const FitParameter& parameter = map.fitted_parameters()[u];
    if (is_tilt(parameter.quantity)) continue;  // see FoundFibres
    const int index = static_cast<int>(u);
    FittedQuantity& q = result.emplace_back();
    q.name = parameter.quantity;
    q.unit = material_quantity(map.material(), q.name).unit;
    q.parameterization = parameter.parameterization;
    q.values = map.values(index, p);
    if (posterior) q.sigma = posterior->sigma[u], q.reduction = posterior->reduction[u];
    for (const auto& [where, tet] : telling_tets(q, mesh)) {
      ValueRow& row = q.rows.emplace_back(ValueRow{where, q.values[tet], {}});
      if (posterior) row.interval = interval(*posterior, map, p, {index, tet});
    }
  }
  return result;
}

void show_parts(const FoundParts& parts, std::vector<FittedQuantity>& quantities) {
  const auto stiffness = std::find_if(quantities.begin(), quantities.end(), [](const FittedQuantity& q) {
    return is_stiffness(q.name) && q.parameterization == Parameterization::tets;
  });
  if (stiffness == quantities.end()) return;
  stiffness->rows.clear();
  for (size_t k = 0; k < parts.values.size(); ++k) {
    ValueRow& row = stiffness->rows.emplace_back(ValueRow{"part " + std::to_string(k + 1), parts.values[k], {}});
    if (!parts.intervals.empty()) row.interval = parts.intervals[k];
  }
}

std::vector<std::string> values_at_bound(const ParameterMap& map, std::span<const double> p) {
  std::vector<std::string> found;
  for (size_t u = 0; u < map.fitted_parameters().size(); ++u) {
    const int parameter = static_cast<int>(u);
    const std::vector<double> fitted = map.fitted_values(parameter, p);
    const auto count =
        std::count_if(fitted.begin(), fitted.end(), [&](double z) { return is_at_bound(map, parameter, z); });
    if (count == 0) continue;
    const bool is_single = map.fitted_parameters()[u].parameterization == Parameterization::uniform;
    found.push_back(map.fitted_parameters()[u].quantity + (is_single ? "" : " in " + std::to_string(count) + " tets"));
  }
  return found;
}

FittedMaterial fitted_material(const DataSet& data, const ParameterMap& map, std::span<const double> p,
                               const std::vector<FittedQuantity>& quantities) {
  const Renumbering& tet = data.numbering.tet;
  FittedMaterial material{.mesh = to_user(data.numbering, data.experiment.mesh), .model = map.material()};
  const std::vector<MaterialParameters> parameters = map.parameters(p);
  for (const Quantity& quantity : material_quantities(map.material())) {
    std::vector<double> values;
    for (const MaterialParameters& m : parameters) values.push_back(quantity.of(m));
    material.values.emplace_back(quantity.name, tet.to_user(values));
  }
  const std::vector<double>& density = data.experiment.density;
  if (std::all_of(density.begin(), density.end(), [](double rho) { return rho > 0; }) && !density.empty())
    material.values.emplace_back("density", tet.to_user(density));
  for (const FittedQuantity& q : quantities) {
    if (q.sigma.empty()) continue;
    material.further.emplace_back(q.name + "_deviation", tet.to_user(q.sigma));
    material.further.emplace_back(q.name + "_reduction", tet.to_user(q.reduction));
  }
  return material;
}

std::string fibre_text(const FoundFibres& fibres) {
  const auto axis_text = [](const Vec3d& a) { return formatted("(%.3f, %.3f, %.3f)", a[0], a[1], a[2]); };
  std::string text = axis_text(fibres.direction);
  if (fibres.cone >= 90) text += ", undetermined: 95 % within 90 degrees";
  if (fibres.cone >= 0 && fibres.cone < 90) text += formatted(", 95 %% within %.2g degrees", fibres.cone);
  for (const Vec3d& other : fibres.others) text += ", or " + axis_text(other);
  return text;
}

std::string describe_mesh(const FitOutcome& outcome) {
  std::string text = "a material per tet of " + std::to_string(outcome.material.mesh.tet_count()) + ", simulated on " +
                     std::to_string(outcome.simulated_tets) +
                     (outcome.plan.refine > 0 ? " (refine = " + std::to_string(outcome.plan.refine) + ")" : " tets");
  if (outcome.mesh_error < 0) return text;
  return text +
         formatted("; positions err by %.2g %% of the peak motion, which was corrected", 100 * outcome.mesh_error);
}

}  // namespace aspic
