#include "dynamics/model_builder.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "energy/linear_load.h"
#include "energy/maxwell_branches.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"

namespace aspic {
namespace {

std::string text_of(double x) { return formatted("%g", x); }

void require(bool holds, const std::string& otherwise) {
  if (!holds) throw InvalidInput(otherwise);
}

void require_not_negative(double value, const char* what) {
  if (!(value >= 0) || !std::isfinite(value))
    throw InvalidInput(std::string(what) + " = " + text_of(value) + "; it must be finite and not negative");
}

void require_one_per_tet(size_t given, int tets, const std::string& what) {
  require(given == static_cast<size_t>(tets),
          std::to_string(given) + " values of " + what + " for " + std::to_string(tets) + " tets; give one per tet");
}

void check(const TetMesh& mesh, const std::string& body) {
  require(!mesh.tets.empty(), "the mesh of '" + body + "' has no tets");
  const auto fail = [&](int t, const std::string& what) {
    throw InvalidInput("the mesh of '" + body + "': tet " + std::to_string(t) + " has " + what);
  };
  for (int t = 0; t < mesh.tet_count(); ++t) {
    for (const int v : mesh.tets[t])
      if (v < 0 || v >= mesh.vertex_count())
        fail(t, "the vertex " + std::to_string(v) + "; there are " + std::to_string(mesh.vertex_count()));
    if (const double size = volume(mesh, t); !(size > 0))
      fail(t, "the volume " + text_of(size) + " m^3; it must be positive (exchange two of its vertices)");
  }
}

std::string list_of(const std::vector<ExtraParameter>& extra) {
  std::string list;
  for (const ExtraParameter& e : extra) list += (list.empty() ? "" : ", ") + e.name;
  return list.empty() ? "none" : list;
}

}  // namespace

MaterialParameters material_parameters(const std::string& material, const ElasticConstants& constants) {
  const std::vector<ExtraParameter>& extra = material_info(material).extra;
  const auto [young, poisson, given] = constants;
  require(young > 0 && std::isfinite(young), material + ": young = " + text_of(young) + " Pa; it must be positive");
  require(poisson > -1 && poisson < 0.5,
          material + ": poisson = " + text_of(poisson) + "; it must be between -1 and 0.5 (try 0.45)");
  require(given.empty() || given.size() == extra.size(),
          material + ": " + std::to_string(given.size()) + " extra parameters; it has " + list_of(extra));
  MaterialParameters parameters{lame_from_young_poisson(young, poisson), {}};
  for (size_t k = 0; k < extra.size(); ++k) {
    const ExtraParameter& e = extra[k];
    const double value = parameters.extra[k] = given.empty() ? e.fallback : given[k];
    require(value >= e.min && value <= e.max, material + ": " + e.name + " = " + text_of(value) +
                                                  "; it must be between " + text_of(e.min) + " and " + text_of(e.max));
  }
  return parameters;
}

std::vector<double> weights(const MassMatrix& mass, const Vec3d& acceleration) {
  std::vector<double> force;
  force.reserve(3 * mass.row_sums().size());
  for (const double m : mass.row_sums())
    for (int r = 0; r < 3; ++r) force.push_back(m * acceleration[r]);
  return force;
}

ModelBuilder::ModelBuilder(TetMesh mesh, std::string body) {
  check(mesh, body);
  model_.mesh = std::move(mesh);
  model_.bodies = {{std::move(body), 0, model_.mesh.vertex_count(), 0, tet_count()}};
}

ModelBuilder& ModelBuilder::material(const std::string& name, const ElasticConstants& constants) {
  return material(name, std::vector<MaterialParameters>(tet_count(), material_parameters(name, constants)));
}

ModelBuilder& ModelBuilder::material(const std::string& name, std::span<const MaterialParameters> parameters) {
  material_info(name);  // throws for an unknown name
  require_one_per_tet(parameters.size(), tet_count(), "the parameters of " + name);
  parameters_.assign(parameters.begin(), parameters.end());
  make_elasticity_ = [name](const TetMesh& mesh, int first, std::span<const MaterialParameters> p) {
    return make_tet_elasticity(name, mesh, first, p);
  };
  return *this;
}

ModelBuilder& ModelBuilder::material(ElasticityMaker maker, const MaterialParameters& parameters) {
  make_elasticity_ = std::move(maker);
  parameters_.assign(tet_count(), parameters);
  return *this;
}

ModelBuilder& ModelBuilder::density(double density) { return this->density(std::vector<double>(tet_count(), density)); }

ModelBuilder& ModelBuilder::density(std::vector<double> densities) {
  require_one_per_tet(densities.size(), tet_count(), "density");
  for (const double d : densities) require_not_negative(d, "density [kg/m^3]");
  model_.density = std::move(densities);
  return *this;
}

ModelBuilder& ModelBuilder::mass(MassKind kind) {
  mass_kind_ = kind;
  return *this;
}

ModelBuilder& ModelBuilder::gravity(const Vec3d& acceleration) {
  for (const double g : acceleration.a)
    require(std::isfinite(g), "gravity has the component " + text_of(g) + "; it must be finite");
  gravity_ = acceleration;
  return *this;
}

std::vector<int> ModelBuilder::vertices_for(const std::string& user, const Predicate& where) const {
  std::vector<int> vertices = vertices_where(model_.mesh, where);
  if (!vertices.empty()) return vertices;
  Vec3d low = model_.mesh.rest[0], high = low;
  for (const Vec3d& X : model_.mesh.rest)
    for (int r = 0; r < 3; ++r) low[r] = std::min(low[r], X[r]), high[r] = std::max(high[r], X[r]);
  const auto text = [](const Vec3d& X) {
    return "(" + text_of(X[0]) + ", " + text_of(X[1]) + ", " + text_of(X[2]) + ")";
  };
  throw InvalidInput(user + " selects no vertex; the mesh reaches from " + text(low) + " to " + text(high) +
                     " m (compare coordinates with a tolerance)");
}

ModelBuilder& ModelBuilder::pin(std::string name, const Predicate& where, Motion motion,
                                std::vector<Vec3d> directions) {
  std::vector<int> vertices = vertices_for("pin '" + name + "'", where);
  return pin(std::move(name), std::move(vertices), std::move(motion), std::move(directions));
}

ModelBuilder& ModelBuilder::pin(std::string name, std::vector<int> vertices, Motion motion,
                                std::vector<Vec3d> directions) {
  const int count = model_.mesh.vertex_count();
  for (const int v : vertices)
    if (v < 0 || v >= count)
      throw InvalidInput("pin '" + name + "' has the vertex " + std::to_string(v) + "; there are " +
                         std::to_string(count));
  model_.pins.push_back({std::move(name), std::move(vertices), std::move(motion), std::move(directions)});
  return *this;
}

ModelBuilder& ModelBuilder::springs(std::string name, const Predicate& where, double stiffness, const Motion& motion) {
  require_not_negative(stiffness, "stiffness of springs [N/m]");
  std::vector<PointSpring> springs;
  for (const int v : vertices_for("springs '" + name + "'", where)) {
    const Vec3d X = model_.mesh.rest[v];
    springs.push_back({v, stiffness, [X, motion](double t) { return motion ? motion(X, t) : X; }});
  }
  return load(make_point_springs(std::move(name), std::move(springs)));
}

ModelBuilder& ModelBuilder::pressure(std::string name, std::vector<Face> patch, std::function<double(double)> value) {
  require(!patch.empty(), "pressure '" + name + "' has no face");
  pressures_.push_back({std::move(name), std::move(patch), std::move(value)});
  return *this;
}

ModelBuilder& ModelBuilder::load(std::unique_ptr<Energy> term) {
  model_.loads.push_back(std::move(term));
  return *this;
}

ModelBuilder& ModelBuilder::rayleigh_damping(double mass_factor, double stiffness_factor) {
  require_not_negative(mass_factor, "mass_factor of Rayleigh damping [1/s]");
  require_not_negative(stiffness_factor, "stiffness_factor of Rayleigh damping [s]");
  rayleigh_ = {mass_factor, stiffness_factor};
  return *this;
}

ModelBuilder& ModelBuilder::strain_rate_damping(double viscosity) {
  require_not_negative(viscosity, "viscosity [Pa s]");
  viscosity_ = viscosity;
  return *this;
}

ModelBuilder& ModelBuilder::maxwell_branch(double shear, double relaxation_time) {
  require_not_negative(shear, "shear modulus of a Maxwell branch [Pa]");
  require(relaxation_time > 0 && std::isfinite(relaxation_time),
          "relaxation time of a Maxwell branch = " + text_of(relaxation_time) + " s; it must be positive and finite");
  branches_.emplace_back(shear, relaxation_time);
  return *this;
}

Model ModelBuilder::build() {
  require(make_elasticity_ != nullptr, "the model has no material; call material() before build()");
  require(!model_.density.empty(), "the model has no density; call density() before build()");
  Model model = std::exchange(model_, {});
  model.mass = std::make_unique<MassMatrix>(model.mesh, model.density, mass_kind_);
  model.elasticity.push_back(make_elasticity_(model.mesh, 0, parameters_));
  if (gravity_) model.loads.insert(model.loads.begin(), make_linear_load("gravity", weights(*model.mass, *gravity_)));
  for (const PressureLoad& pressure : pressures_) add_pressure(pressure, model);
  if (rayleigh_)
    model.damping.push_back(
        make_rayleigh_damping(*model.mass, rayleigh_->first, model.elasticity[0].get(), rayleigh_->second));
  if (viscosity_)
    model.damping.push_back(
        make_strain_rate_damping(model.mesh, 0, std::vector<double>(model.mesh.tet_count(), *viscosity_)));
  std::vector<MaxwellBranch> branches;
  for (const auto& [shear, time] : branches_)
    branches.push_back({std::vector<double>(model.mesh.tet_count(), shear), time});
  if (!branches.empty()) model.damping.push_back(make_maxwell_branches("viscoelastic", model.mesh, 0, branches));
  return model;
}

}  // namespace aspic
