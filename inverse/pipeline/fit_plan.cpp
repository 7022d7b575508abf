#include "pipeline/fit_plan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number_chars.h"
#include "data/apparent_stiffness.h"
#include "estimate/cross_validation.h"
#include "estimate/law_errors.h"
#include "material/registry.h"
#include "model/limits.h"
#include "model/quantity.h"
#include "pipeline/law_choice.h"
#include "scene/scene_files.h"
#include "scene/schema.h"

namespace aspic {
namespace {

constexpr int kMaxTets = 5'000'000;  // of a refined mesh, chosen: steps on as many take 6 GB (docs/performance.md)

// Splits "young=tets".
std::pair<std::string, std::string> halves(const std::string& text, const std::string& example) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw InvalidInput("'" + text + "': give QUANTITY=VALUE, such as " + example);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_fitted(const FitPlan& plan, const std::string& quantity) {
  return std::any_of(plan.parameters.begin(), plan.parameters.end(),
                     [&](const FitParameter& u) { return u.quantity == quantity; });
}
bool is_known(const FitPlan& plan, const std::string& quantity) {
  return std::any_of(plan.known.begin(), plan.known.end(), [&](const auto& k) { return k.first == quantity; });
}

double default_value(const Quantity& quantity, const Measured& experiment) {
  return quantity.role == QuantityRole::stiffness ? apparent_young(experiment).value_or(quantity.typical)
                                                  : quantity.typical;
}

// Only E and nu are quantities of all laws.
void require_common(const std::string& quantity) {
  if (quantity != "young" && quantity != "poisson")
    throw InvalidInput("'" + quantity +
                       "': a choice of laws (auto) accepts young and poisson only; name one law to give '" + quantity +
                       "'");
}

void check_range(const std::string& quantity, double value) {
  const Range& range = scene_schema().key("material", quantity).range;
  if (!std::isfinite(value) || !range.contains(value))
    throw InvalidInput(quantity + " = " + number_text(value) + "; must be " + range.text());
}

void check_refinement(const FitPlan& plan, const TetMesh& mesh) {
  const int tets = mesh.tet_count();
  if (tets * std::pow(8.0, plan.refine) > kMaxTets)
    throw InvalidInput("refine = " + std::to_string(plan.refine) + " would simulate " + std::to_string(tets) + " x 8^" +
                       std::to_string(plan.refine) + " tets; " + std::to_string(kMaxTets) + " are the most");
}

bool is_direction_known(const FitPlan& plan) {
  return std::any_of(plan.known.begin(), plan.known.end(), [&](const auto& k) {
    return material_quantity(plan.model, k.first).role == QuantityRole::component;
  });
}

// Replaces an unknown direction of fibres by its tilts. It is unknown unless it is given.
void complete_direction(FitPlan& plan) {
  if (!fibre_components(plan.model)) return;
  const auto found = std::find_if(plan.parameters.begin(), plan.parameters.end(),
                                  [](const FitParameter& u) { return u.quantity == kFibreDirection; });
  FitParameter direction{.quantity = kFibreDirection, .parameterization = Parameterization::uniform};
  if (found != plan.parameters.end()) {
    direction = *found;
    if (direction.parameterization != Parameterization::uniform &&
        direction.parameterization != Parameterization::regions)
      throw InvalidInput("'" + text_of(direction) +
                         "': a direction of fibres is uniform or per region; use fibre_direction=regions");
    if (is_direction_known(plan))
      throw InvalidInput("fibre_direction is in --unknown, and --known gives its components; remove one of the two");
    plan.parameters.erase(found);
  } else if (is_direction_known(plan) || is_fitted(plan, kFibreTilts[0]) || is_fitted(plan, kFibreTilts[1])) {
    return;
  }
  for (const char* tilt : kFibreTilts)
    plan.parameters.push_back({.quantity = tilt,
                               .parameterization = direction.parameterization,
                               .handles = 0,
                               .guess = 0,
                               .prior_sigma = kWeakPrior});
}

// Index of the region of each tet among the ascending labels.
std::vector<int> regions_of(const TetMesh& mesh) {
  std::vector<int> labels = mesh.region, index;
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  for (const int label : mesh.region)
    index.push_back(static_cast<int>(std::lower_bound(labels.begin(), labels.end(), label) - labels.begin()));
  return index;
}

void set_directions(const FitPlan& plan, const TetMesh& mesh, std::vector<MaterialParameters>& parameters) {
  const std::optional<int> first = fibre_components(plan.model);
  if (!first || plan.fibre_directions.empty()) return;
  const std::vector<int> region = plan.fibre_directions.size() > 1 ? regions_of(mesh) : std::vector<int>{};
  for (size_t t = 0; t < parameters.size(); ++t)
    for (int r = 0; r < 3; ++r)
      parameters[t].extra[*first + r] = plan.fibre_directions[region.empty() ? 0 : region[t]][r];
}

}  // namespace

FitParameter parse_parameter(const std::string& text) {
  const std::string example = "young=tets, young=regions, young=handles:40 or poisson=uniform";
  const auto [quantity, parameterization] = halves(text, example);
  FitParameter parameter{.quantity = quantity, .guess = 0};
  if (parameterization == "tets") {
    parameter.parameterization = Parameterization::tets;
  } else if (parameterization == "regions") {
    parameter.parameterization = Parameterization::regions;
  } else if (parameterization == "uniform") {
    parameter.parameterization = Parameterization::uniform;
  } else if (parameterization.starts_with("handles:")) {
    parameter.parameterization = Parameterization::handles;
    const char *first = parameterization.data() + 8, *last = parameterization.data() + parameterization.size();
    const auto [end, error] = from_chars(first, last, parameter.handles);
    if (error != std::errc() || end != last || parameter.handles < 1)
      throw InvalidInput("'" + text + "': handles:N needs a whole number above 0, such as handles:40");
  } else {
    throw InvalidInput("'" + text + "': unknown parameterization '" + parameterization + "'" +
                       suggestion(parameterization, {"tets", "regions", "uniform", "handles:40"}));
  }
  return parameter;
}

std::string text_of(const FitParameter& parameter) {
  constexpr const char* kNames[] = {"uniform", "regions", "handles:", "tets"};
  return parameter.quantity + "=" + kNames[static_cast<size_t>(parameter.parameterization)] +
         (parameter.parameterization == Parameterization::handles ? std::to_string(parameter.handles) : "");
}

std::pair<std::string, double> parse_known(const std::string& text) {
  const auto [quantity, word] = halves(text, "poisson=0.45");
  double value = 0;
  const auto [end, error] = from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    throw InvalidInput("'" + text + "': '" + word + "' is not a finite number");
  return {quantity, value};
}

std::vector<FitParameter> single_values(std::vector<FitParameter> parameters) {
  for (FitParameter& u : parameters)
    if (!is_tilt(u.quantity)) u.parameterization = Parameterization::uniform, u.handles = 0;
  return parameters;
}

FitPlan completed(FitPlan plan, const Measured& experiment) {
  if (plan.model == kAutoLaw) {
    plan.model = "neo_hookean";  // has E and nu only, as all laws do
    for (const FitParameter& u : plan.parameters) require_common(u.quantity);
    for (const auto& [quantity, value] : plan.known) require_common(quantity);
    plan = completed(std::move(plan), experiment);
    plan.model = kAutoLaw;
    return plan;
  }
  for (const auto& [quantity, value] : plan.known) {
    material_quantity(plan.model, quantity);
    check_range(quantity, value);
  }
  complete_direction(plan);
  for (size_t i = 0; i < plan.parameters.size(); ++i) {
    const std::string& quantity = plan.parameters[i].quantity;
    const QuantityRole role = material_quantity(plan.model, quantity).role;
    const bool is_single_tilt = role == QuantityRole::tilt && plan.parameters[i].prior_sigma == 0;
    if (role == QuantityRole::component || is_single_tilt)
      throw InvalidInput("'" + text_of(plan.parameters[i]) + "': a direction has more coordinates; use " +
                         kFibreDirection + "=uniform or " + kFibreDirection + "=regions");
    if (is_known(plan, quantity))
      throw InvalidInput(quantity + " is in both --known and --unknown; remove one of the two");
    for (size_t j = 0; j < i; ++j)
      if (plan.parameters[j].quantity == quantity)
        throw InvalidInput(quantity + " is fitted twice; keep one --unknown for it");
    if (plan.parameters[i].parameterization == Parameterization::regions && experiment.mesh.region.empty())
      throw InvalidInput("'" + text_of(plan.parameters[i]) +
                         "': the mesh of the data has no region labels (try handles:40 or tets)");
  }
  // Default: stiffness per tet, all others uniform.
  for (const Quantity& quantity : material_quantities(plan.model))
    if (quantity.role != QuantityRole::component && !is_fitted(plan, quantity.name) && !is_known(plan, quantity.name))
      plan.parameters.push_back(
          {.quantity = quantity.name,
           .parameterization = is_stiffness(quantity.name) ? Parameterization::tets : Parameterization::uniform,
           .handles = 0,
           .guess = 0});
  for (FitParameter& u : plan.parameters)
    if (u.guess == 0) u.guess = default_value(material_quantity(plan.model, u.quantity), experiment);
  plan.law_errors = plan.law_errors && has_law_errors(plan.model);
  // Standard deviations that include the mesh correction exceed the random errors. The discrepancy principle would
  // treat the difference as noise and oversmooth the field.
  const bool is_field = std::any_of(plan.parameters.begin(), plan.parameters.end(),
                                    [](const FitParameter& u) { return u.parameterization == Parameterization::tets; });
  if (is_field && plan.mesh_errors && plan.fit.weight_rule == "auto") plan.fit.weight_rule = "evidence";
  if (is_field && experiment.scan_gravity)
    throw InvalidInput("the mesh was scanned under load (mesh_gravity), which allows " +
                       std::to_string(Misfit::kMaxUnloaded) +
                       " fitted values and no field of tets; use --unknown young=uniform, regions or handles:10");
  check_refinement(plan, experiment.mesh);
  const std::vector<std::string> groups = groups_of(experiment);
  for (const std::string& group : plan.left_out)
    if (!has(groups, group))
      throw InvalidInput("leave_out '" + group + "': the data have no such group" + suggestion(group, groups));
  if (std::all_of(experiment.cases.begin(), experiment.cases.end(),
                  [&](const LoadCase& c) { return is_left_out(plan.left_out, c); }))
    throw InvalidInput("leave_out leaves no case to fit; name fewer groups");
  return plan;
}

std::vector<FitParameter> stiffer(std::vector<FitParameter> parameters, double factor) {
  for (FitParameter& u : parameters)
    if (is_stiffness(u.quantity)) u.guess *= factor;
  return parameters;
}

FitOptions for_single_values(FitOptions options) {
  options.method = options.weight_rule = "auto";
  options.weight = -1;
  return options;
}

bool is_field(const FitPlan& plan) {
  return std::any_of(plan.parameters.begin(), plan.parameters.end(),
                     [](const FitParameter& u) { return u.parameterization != Parameterization::uniform; });
}

bool has_many_values(const FitParameter& parameter) {
  return parameter.parameterization == Parameterization::tets ||
         parameter.parameterization == Parameterization::handles;
}

bool has_many_values(const FitPlan& plan) {
  return std::any_of(plan.parameters.begin(), plan.parameters.end(),
                     [](const FitParameter& u) { return has_many_values(u); });
}

std::string text_of(const FitPlan& plan) {
  std::string text;
  const auto add = [&](const std::string& key, const std::string& value) { text += key + " = " + value + "\n"; };
  const auto quoted = [](const std::string& word) { return "\"" + word + "\""; };
  add("model", quoted(plan.model));
  for (const FitParameter& u : plan.parameters) {
    add("unknown." + u.quantity, quoted(text_of(u)));
    add("guess." + u.quantity, number_text(u.guess));
  }
  for (size_t k = 0; k < plan.fibre_directions.size(); ++k) {
    const Vec3d& a = plan.fibre_directions[k];
    add("fibre_direction." + std::to_string(k), number_text(a[0]) + " " + number_text(a[1]) + " " + number_text(a[2]));
  }
  for (const auto& [quantity, value] : plan.known) add("known." + quantity, number_text(value));
  const char* smooth[] = {"none", "h1", "tv"};
  add("smooth", quoted(smooth[static_cast<int>(plan.regularizer.smoothness)]));
  add("prior_deviation", number_text(plan.regularizer.prior_sigma));
  add("method", quoted(plan.fit.method));
  add("rule", quoted(plan.fit.weight_rule));
  add("weight", plan.fit.weight < 0 ? quoted("auto") : number_text(plan.fit.weight));
  add("starts", std::to_string(plan.fit.starts));
  add("tolerance", number_text(plan.fit.tolerance));
  add("max_iterations", std::to_string(plan.fit.max_iterations));
  for (const std::string& group : plan.left_out) add("leave_out." + group, "true");
  add("parts", std::to_string(plan.parts));
  add("branches", std::to_string(plan.branches));
  add("refine", std::to_string(plan.refine));
  if (plan.robust) add("loss", quoted("robust"));
  add("mesh_errors", plan.mesh_errors ? "true" : "false");
  add("law_errors", plan.law_errors ? "true" : "false");
  add("equilibrium.tolerance", number_text(plan.equilibrium.tolerance));
  return text;
}

std::string fingerprint_of(const Experiment& e) {
  Fingerprint hash;
  const auto add = [&](const auto& list) {
    const size_t count = list.size();
    hash.add(&count, sizeof count);
    hash.add(list.data(), count * sizeof(list[0]));
  };
  const auto add_vector = [&](const Vec3d& v) { hash.add(&v, sizeof v); };
  add(e.mesh.rest), add(e.mesh.tets), add(e.mesh.region), add(e.fixed), add(e.density);
  for (const SurfacePoint& m : e.markers) add(m.vertices), add(m.weights);
  for (const LoadCase& c : e.cases) {
    add(c.name), add(c.group), add(c.pressed);
    if (c.indenter) {
      const double indenter[] = {static_cast<double>(c.indenter->shape), static_cast<double>(c.indenter->contact),
                                 c.indenter->radius, c.indenter->stiffness};
      hash.add(indenter, sizeof indenter);
    }
    for (const IndenterPose* pose : {&c.touch, &c.pose})
      add_vector(pose->center), add_vector(pose->axis), add_vector(pose->rotation);
    if (c.grip) {
      add(c.grip->vertices);
      for (const Vec3d* v : {&c.grip->center, &c.grip->displacement, &c.grip->rotation}) add_vector(*v);
    }
    add_vector(c.gravity);
    hash.add(&c.pressure, sizeof c.pressure);
    if (c.is_dead_pressure) hash.add("dead", 4);
    for (const MarkerReading& r : c.positions)
      hash.add(&r.marker, sizeof r.marker), add_vector(r.position), add_vector(r.sigma);
    for (const std::optional<Vec3d>* reading : {&c.force, &c.torque})
      add_vector(reading->value_or(Vec3d{{1e300, 0, 0}}));
    add_vector(c.force_sigma), add_vector(c.torque_sigma);
    if (c.layer_sigma) hash.add("layer", 5), hash.add(&*c.layer_sigma, sizeof *c.layer_sigma);
    if (c.indenter && c.indenter->friction > 0) {
      const double friction[] = {c.indenter->friction, c.friction_sigma};
      hash.add("friction", 8), hash.add(friction, sizeof friction);
    }
    if (c.indenter && c.indenter->rim > 0) {
      const double rim[] = {c.indenter->rim, c.rim_sigma};
      hash.add("rim", 3), hash.add(rim, sizeof rim);
    }
    if (c.gauge) hash.add("gauge", 5), add_vector(*c.gauge);
    if (c.torque_gauge) hash.add("torque gauge", 12), add_vector(*c.torque_gauge);
  }
  for (const SystematicError& error : e.errors) {
    const double numbers[] = {static_cast<double>(error.kind), static_cast<double>(error.axis), error.sigma};
    add(error.scope), hash.add(numbers, sizeof numbers);
  }
  if (e.scan_gravity) hash.add("scan", 4), add_vector(*e.scan_gravity);
  if (!e.errors.empty())
    for (const LoadCase& c : e.cases) add(c.session), add(c.tip);
  return hash.text();
}

std::vector<MaterialParameters> known_parameters(const FitPlan& plan, const Measured& experiment) {
  const auto value = [&](const Quantity& quantity) {
    for (const auto& [known, number] : plan.known)
      if (known == quantity.name) return number;
    for (const FitParameter& u : plan.parameters)
      if (u.quantity == quantity.name) return u.guess;
    return default_value(quantity, experiment);
  };
  const std::vector<Quantity> quantities = material_quantities(plan.model);
  MaterialParameters parameters;
  parameters.lame = lame_from_young_poisson(value(quantities[0]), value(quantities[1]));
  for (size_t k = 2; k < quantities.size(); ++k) parameters.extra[k - 2] = value(quantities[k]);
  std::vector<MaterialParameters> all(experiment.mesh.tets.size(), parameters);
  set_directions(plan, experiment.mesh, all);
  return all;
}

bool is_left_out(const std::vector<std::string>& left_out, const LoadCase& load) { return has(left_out, load.group); }

}  // namespace aspic
