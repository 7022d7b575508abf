#include "model/motion_parameters.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dynamics/model_builder.h"
#include "energy/linear_load.h"
#include "energy/rayleigh_damping.h"
#include "model/quantity_scale.h"

namespace aspic {
namespace {

const char* const kAxes[] = {"_x", "_y", "_z"};
const QuantityScale kPoisson = QuantityScale::bounded(-1, 0.5);

bool are_equal(const std::vector<double>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return *largest - *least <= 1e-9 * std::abs(*largest);
}

double mean(const std::vector<double>& values, const std::vector<double>& volume) {
  if (are_equal(values)) return values[0];
  double sum = 0, total = 0;
  for (size_t t = 0; t < values.size(); ++t) sum += volume[t] * values[t], total += volume[t];
  return sum / total;
}

}  // namespace

std::span<const MotionParameters::Named> MotionParameters::named() {
  static constexpr Named kList[] = {{Kind::young, "young", "Pa"},
                                    {Kind::poisson, "poisson", ""},
                                    {Kind::density, "density", "kg/m^3"},
                                    {Kind::mass_damping, "mass_damping", "1/s"},
                                    {Kind::stiffness_damping, "stiffness_damping", "s"},
                                    {Kind::viscosity, "viscosity", "Pa s"},
                                    {Kind::velocity, "velocity", "m/s"},
                                    {Kind::angular_velocity, "angular_velocity", "rad/s"}};
  return kList;
}

std::vector<std::string> MotionParameters::names() {
  std::vector<std::string> names;
  for (const Named& parameter : named()) names.emplace_back(parameter.name);
  return names;
}

MotionParameters::MotionParameters(MotionModel model, const std::vector<std::string>& names, const MotionScales& scales)
    : model_(std::move(model)), gravity_(gravity_of(model_.model, model_.start.q)) {
  const Model& m = model_.model;
  if (m.bodies.size() > 1 || m.elasticity.size() != 1)
    throw InvalidInput("the model has " + std::to_string(m.bodies.size()) +
                       " bodies; a motion is fitted to one body, so keep only the one with the markers");
  material_ = m.elasticity[0]->parameters();
  density_ = m.density;
  for (int t = 0; t < m.mesh.tet_count(); ++t) volume_.push_back(volume(m.mesh, t));
  for (int v = 0; v < m.mesh.vertex_count(); ++v)
    center_ = center_ + m.mass->vertex_mass()[v] / m.mass->total() * point(model_.start.q, v);
  if (names.empty()) throw InvalidInput("no parameter to fit is given" + suggestion("", MotionParameters::names()));
  for (size_t i = 0; i < names.size(); ++i) {
    if (std::find(names.begin(), names.begin() + i, names[i]) != names.begin() + i)
      throw InvalidInput("the parameter '" + names[i] + "' is given twice");
    add(names[i], scales);
  }
}

void MotionParameters::add(const std::string& name, const MotionScales& scales) {
  const auto list = named();
  const auto found = std::find_if(list.begin(), list.end(), [&](const Named& n) { return n.name == name; });
  if (found == list.end()) throw InvalidInput("unknown parameter '" + name + "'" + suggestion(name, names()));
  const Kind kind = found->kind;
  const MotionParameter parameter{name, found->unit};
  const MotionValues guess = values({});
  const auto add_guess = [&](double own, double other, const char* note) {
    add_positive(kind, own > 0 ? MotionParameter{name, parameter.unit, own}
                               : MotionParameter{name, parameter.unit, other, note});
  };
  if ((kind == Kind::young || kind == Kind::poisson) && !(guess.young > 0))
    throw InvalidInput("'" + name + "' cannot be fitted: the body has no elasticity");
  switch (kind) {
    case Kind::young:
      return add_guess(guess.young, 0, "");
    case Kind::poisson:
      return add_poisson({name, parameter.unit, guess.poisson});
    case Kind::density:
      if (!gravity_) throw InvalidInput("'density' cannot be fitted: the load 'gravity' is not the weight of the body");
      return add_guess(guess.density, 0, "");
    case Kind::mass_damping:
      return add_guess(guess.mass_damping, 1 / scales.duration, "1 / duration of the data");
    case Kind::stiffness_damping:
      return add_guess(guess.stiffness_damping, scales.time_step, "the time step");
    case Kind::viscosity: {
      const double viscosity = scales.time_step * std::max(guess.young, guess.density * scales.speed * scales.speed);
      if (!(std::max(guess.viscosity, viscosity) > 0))
        throw InvalidInput("'viscosity' needs a guess > 0 (try --set damping.viscosity=1)");
      if (!(guess.viscosity > 0)) model_.viscosity.assign(volume_.size(), viscosity);
      return add_guess(guess.viscosity, viscosity, "young * time step");
    }
    case Kind::velocity: {
      const double speed = std::max(scales.speed, norm(guess.velocity));
      return add_vector(kind, parameter, guess.velocity, speed > 0 ? speed : 1);
    }
    case Kind::angular_velocity: {
      const double speed = std::max(scales.speed / scales.size, norm(guess.angular_velocity));
      return add_vector(kind, parameter, guess.angular_velocity, speed > 0 ? speed : 1);
    }
  }
}

void MotionParameters::add_poisson(const MotionParameter& parameter) {
  std::vector<double> poisson;
  for (const MaterialParameters& p : material_) poisson.push_back(poisson_ratio(p.lame));
  if (!are_equal(poisson))
    throw InvalidInput("'poisson' cannot be fitted: it differs from tet to tet (try --set material.poisson=0.4)");
  entries_.push_back({Kind::poisson});
  parameters_.push_back(parameter);
}

void MotionParameters::add_positive(Kind kind, const MotionParameter& parameter) {
  entries_.push_back({kind});
  parameters_.push_back(parameter);
  parameters_.back().can_vanish =
      kind == Kind::mass_damping || kind == Kind::stiffness_damping || kind == Kind::viscosity;
}

void MotionParameters::add_vector(Kind kind, const MotionParameter& parameter, const Vec3d& guess, double unit) {
  for (int axis = 0; axis < 3; ++axis) {
    entries_.push_back({kind, axis, unit});
    parameters_.push_back({parameter.name + kAxes[axis], parameter.unit, guess[axis]});
  }
}

double MotionParameters::value(int i, double p) const {
  const auto& [kind, axis, unit] = entries_[i];
  const double guess = parameters_[i].guess;
  if (kind == Kind::velocity || kind == Kind::angular_velocity) return guess + unit * p;
  return kind == Kind::poisson ? kPoisson.value(kPoisson.fitted(guess) + p) : guess * std::exp(p);
}

double MotionParameters::slope(int i, double p) const {
  const auto& [kind, axis, unit] = entries_[i];
  if (kind == Kind::velocity || kind == Kind::angular_velocity) return unit;
  return kind == Kind::poisson ? kPoisson.slope(kPoisson.fitted(parameters_[i].guess) + p) : value(i, p);
}

std::optional<double> MotionParameters::fitted(Kind kind, std::span<const double> p) const {
  for (size_t i = 0; i < p.size(); ++i)
    if (entries_[i].kind == kind) return value(static_cast<int>(i), p[i]);
  return {};
}

Vec3d MotionParameters::vector(Kind kind, std::span<const double> p, const Vec3d& fallback) const {
  Vec3d v = fallback;
  for (size_t i = 0; i < p.size(); ++i)
    if (entries_[i].kind == kind) v[entries_[i].axis] = value(static_cast<int>(i), p[i]);
  return v;
}

double MotionParameters::factor(Kind kind, std::span<const double> p) const {
  for (size_t i = 0; i < p.size(); ++i)
    if (entries_[i].kind == kind) return std::exp(p[i]);
  return 1;
}

MotionValues MotionParameters::values(std::span<const double> p) const {
  std::vector<double> young, poisson;
  for (const MaterialParameters& m : material(p)) {
    young.push_back(m.lame.mu > 0 ? young_modulus(m.lame) : 0);
    poisson.push_back(m.lame.mu > 0 ? poisson_ratio(m.lame) : 0);
  }
  return {.young = mean(young, volume_),
          .poisson = mean(poisson, volume_),
          .density = mean(density(p), volume_),
          .mass_damping = fitted(Kind::mass_damping, p).value_or(model_.mass_damping),
          .stiffness_damping = fitted(Kind::stiffness_damping, p).value_or(model_.stiffness_damping),
          .viscosity = model_.viscosity.empty() ? 0 : mean(viscosity(p), volume_),
          .velocity = vector(Kind::velocity, p, model_.velocity),
          .angular_velocity = vector(Kind::angular_velocity, p, model_.angular_velocity)};
}

std::vector<MaterialParameters> MotionParameters::material(std::span<const double> p) const {
  std::vector<MaterialParameters> material = material_;
  const double stiffer = factor(Kind::young, p);
  const std::optional<double> poisson = fitted(Kind::poisson, p);
  for (MaterialParameters& m : material) {
    if (poisson) m.lame = lame_from_young_poisson(young_modulus(m.lame), *poisson);
    m.lame.mu *= stiffer, m.lame.lambda *= stiffer;
  }
  return material;
}

std::vector<double> MotionParameters::density(std::span<const double> p) const {
  std::vector<double> density = density_;
  for (double& rho : density) rho *= factor(Kind::density, p);
  return density;
}

std::vector<double> MotionParameters::viscosity(std::span<const double> p) const {
  std::vector<double> viscosity = model_.viscosity;
  for (double& eta : viscosity) eta *= factor(Kind::viscosity, p);
  return viscosity;
}

Vec3d MotionParameters::arm(int vertex) const { return point(model_.start.q, vertex) - center_; }

State MotionParameters::start(std::span<const double> p) const {
  State start = model_.start;
  const Vec3d v = vector(Kind::velocity, p, model_.velocity) - model_.velocity;
  const Vec3d w = vector(Kind::angular_velocity, p, model_.angular_velocity) - model_.angular_velocity;
  for (int i = 0; i < static_cast<int>(start.qdot.size() / 3); ++i) {
    const Vec3d change = v + cross(w, arm(i));
    for (int axis = 0; axis < 3; ++axis) start.qdot[3 * i + axis] += change[axis];
  }
  return start;
}

void MotionParameters::set_density(const std::vector<double>& density) {
  Model& m = model_.model;
  m.density = density;
  *m.mass = MassMatrix(m.mesh, m.density, m.mass->kind());
  for (auto& load : m.loads)
    if (load->name() == "gravity") load = make_linear_load("gravity", weights(*m.mass, *gravity_));
}

void MotionParameters::set_damping(std::span<const double> p) {
  Model& m = model_.model;
  const double a = fitted(Kind::mass_damping, p).value_or(model_.mass_damping);
  const double b = fitted(Kind::stiffness_damping, p).value_or(model_.stiffness_damping);
  m.damping.clear();
  if (a > 0 || b > 0) m.damping.push_back(make_rayleigh_damping(*m.mass, a, m.elasticity[0].get(), b));
  const std::vector<double> eta = viscosity(p);
  if (std::any_of(eta.begin(), eta.end(), [](double e) { return e > 0; }))
    m.damping.push_back(make_strain_rate_damping(m.mesh, 0, eta));
}

Trajectory MotionParameters::trajectory(std::span<const double> p, const TrajectoryOptions& options) {
  if (factor(Kind::density, p) != 1 || model_.model.density != density_) set_density(density(p));
  set_damping(p);
  model_.model.elasticity[0]->set_parameters(material(p));
  return {std::move(model_.model), start(p), options};
}

}  // namespace aspic
