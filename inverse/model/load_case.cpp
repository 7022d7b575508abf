#include "model/load_case.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "dynamics/model_builder.h"
#include "energy/linear_load.h"
#include "energy/pressure.h"
#include "mesh/surface.h"
#include "mesh/vertices.h"
#include "model/gauge.h"
#include "model/limits.h"

namespace aspic {
namespace {

constexpr char kAxis[] = "xyz";

Vec3d at(const SurfacePoint& point, std::span<const double> x) {
  Vec3d sum{};
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < 3; ++r) sum[r] += point.weights[k] * x[3 * point.vertices[k] + r];
  return sum;
}

Vec3d unit(const Vec3d& v) { return (1 / norm(v)) * v; }

IndenterPose between(const IndenterPose& a, const IndenterPose& b, double part) {
  const auto mix = [part](const Vec3d& x, const Vec3d& y) { return (1 - part) * x + part * y; };
  return {mix(a.center, b.center), mix(unit(a.axis), unit(b.axis)), mix(a.rotation, b.rotation)};
}

void require_positive(const Vec3d& sigma, const std::string& what) {
  for (int r = 0; r < 3; ++r)
    if (!(sigma[r] > 0) || !std::isfinite(sigma[r]))
      throw InvalidInput(what + ": the standard deviation along " + kAxis[r] + " is " + std::to_string(sigma[r]) +
                         "; it must be positive");
}

// A bonded indenter on a triangle with a held corner would press its layer against the support, with a force that
// depends on the conventional layer stiffness and not on the material. Such triangles get no layer, unless the indenter
// touches few others.
std::unique_ptr<Probe> make_probe_beside_support(const Experiment& experiment, const Indenter& indenter,
                                                 const IndenterPose& touch) {
  const TetMesh& mesh = experiment.mesh;
  const std::vector<Triangle> surface = boundary_triangles(mesh, 0, mesh.tet_count());
  if (indenter.contact != IndenterContact::bonded) return make_probe(mesh, surface, indenter, touch);
  std::vector<char> is_held(mesh.rest.size(), 0);
  for (const int v : experiment.fixed) is_held[v] = 1;
  std::vector<Triangle> free;
  for (const Triangle& t : surface)
    if (std::none_of(t.begin(), t.end(), [&](int v) { return is_held[v] != 0; })) free.push_back(t);
  const auto touched = [&](const std::vector<Triangle>& part) {
    return touched_points_at_rest(mesh, part, indenter, touch);
  };
  auto probe = make_probe(mesh, surface, indenter, touch);  // throws for invalid indenters
  return 2 * touched(free) < touched(surface) ? std::move(probe) : make_probe(mesh, free, indenter, touch);
}

}  // namespace

LoadedBody::LoadedBody(const Experiment& experiment, const LoadCase& load, const std::string& material,
                       std::span<const MaterialParameters> parameters, const EquilibriumOptions& options)
    : experiment_(experiment),
      load_(readable(experiment, load)),
      rest_(rest_positions(experiment.mesh)),
      equilibrium_(make_model(material, parameters), rest_, options) {
  for (auto* v : {&dx_, &xbar_, &start_, &force_}) v->resize(rest_.size());
  prediction_.x = rest_;
  prediction_.markers.resize(load.positions.size());
}

const LoadCase& LoadedBody::readable(const Experiment& experiment, const LoadCase& load) {
  if (load.positions.empty() && !load.force && !load.torque)
    throw InvalidInput(load.name + ": no measurements; give positions of markers, a force or a torque");
  if (!load.indenter && !load.grip && (load.force || load.torque))
    throw InvalidInput(load.name + ": a force or torque needs an indenter or a grip");
  if (load.indenter && load.grip) throw InvalidInput(load.name + ": an indenter and a grip exclude each other");
  for (const MarkerReading& reading : load.positions) {
    if (reading.marker < 0 || reading.marker >= static_cast<int>(experiment.markers.size()))
      throw InvalidInput(load.name + ": marker " + std::to_string(reading.marker) + " is unknown; there are " +
                         std::to_string(experiment.markers.size()));
    require_positive(reading.sigma, load.name + ": marker " + std::to_string(reading.marker));
  }
  if (load.force) require_positive(load.force_sigma, load.name + ": force");
  if (load.torque) require_positive(load.torque_sigma, load.name + ": torque");
  return load;
}

std::unique_ptr<Energy> make_pressure_of(const LoadCase& load, const TetMesh& mesh) {
  const std::vector<Face> patch = faces_of(mesh, load.pressed);
  if (load.is_dead_pressure) return make_dead_pressure(mesh, patch, load.pressure);
  return make_pressure(mesh, patch, load.pressure);
}

std::unique_ptr<Probe> make_probe_of(const Experiment& experiment, const LoadCase& load) {
  auto probe = make_probe_beside_support(experiment, *load.indenter, load.touch);
  probe->set_pose(load.pose);
  return probe;
}

Model LoadedBody::make_model(const std::string& material, std::span<const MaterialParameters> parameters) {
  const TetMesh& mesh = experiment_.mesh;
  ModelBuilder builder(mesh);
  builder.material(material, parameters)
      .density(experiment_.density)
      .mass(MassKind::lumped)
      .pin("fixed", experiment_.fixed);
  if (load_.grip) {
    grip_ = std::make_shared<GripMotion>(*load_.grip, 1);
    builder.pin("grip", load_.grip->vertices, [motion = grip_](const Vec3d& X, double) { return (*motion)(X); });
  }
  Model model = builder.build();
  const auto add_scaled = [&](std::unique_ptr<Energy> load) {
    auto scaled = std::make_unique<ScaledLoad>(std::move(load));
    scaled_.push_back(scaled.get());
    model.loads.push_back(std::move(scaled));
  };
  if (dot(load_.gravity, load_.gravity) > 0) {
    std::vector<double> weight(rest_.size());
    for (int t = 0; t < mesh.tet_count(); ++t) add_body_force(mesh, t, model.density[t] * load_.gravity, weight);
    add_scaled(make_linear_load("gravity", std::move(weight)));
  }
  if (load_.pressure != 0) add_scaled(make_pressure_of(load_, mesh));
  if (load_.indenter) {
    auto probe = make_probe_of(experiment_, load_);
    probe_ = probe.get();
    model.loads.push_back(std::move(probe));
    if (load_.indenter->friction > 0) {
      auto friction = std::make_unique<ProbeFriction>(mesh, *probe_, *load_.indenter, load_.touch);
      friction_ = friction.get();
      model.damping.push_back(std::move(friction));
    }
  }
  return model;
}

std::string LoadedBody::what(int residual) const {
  const auto [reading, axis] = std::div(residual, 3);
  const int markers = static_cast<int>(load_.positions.size());
  const std::string of = reading < markers ? "marker " + std::to_string(load_.positions[reading].marker)
                         : reading == markers && has_force() ? "force"
                                                             : "torque";
  if ((of == "force" && load_.gauge) || (of == "torque" && load_.torque_gauge))
    return load_.name + ": " + of + " along the gauge";
  return load_.name + ": " + of + ", " + kAxis[axis];
}

void LoadedBody::apply(double part) {
  if (grip_) *grip_ = GripMotion(*load_.grip, part);
  for (ScaledLoad* load : scaled_) load->set_factor(part);
  if (probe_) probe_->set_pose(part == 1 ? load_.pose : between(load_.touch, load_.pose, part));
}

bool LoadedBody::try_from(std::span<const double> start) {
  equilibrium_.set_x(start);
  // A grip that moves too far at once would start from inverted tets, whose equilibria are others.
  if (grip_ && !(equilibrium_.model().elasticity[0]->min_det_F(equilibrium_.x()) > 0)) return false;
  const MinimizeReport report = equilibrium_.solve();
  ++counts_.equilibria;
  counts_.newton_iterations += report.iterations;
  counts_.factorizations += report.factorizations;
  prediction_.solve = report;
  return is_success(report.status);
}

// Load stepping from rest; the step is halved on failure and doubled on success.
bool LoadedBody::load_in_parts() {
  start_ = rest_;
  double done = 0, part = 0.5;
  while (done < 1) {
    apply(std::min(1.0, done + part));
    if (try_from(start_)) {
      std::copy(x().begin(), x().end(), start_.begin());
      done = std::min(1.0, done + part);
      part *= 2;
    } else {
      part /= 2;
      if (part < std::ldexp(1.0, -kMaxHalvings)) break;
    }
  }
  failure_ = done < 1
                 ? load_.name + ", at " + std::to_string(std::lround(100 * (done + 2 * part))) + " % of the load: " +
                       (equilibrium_.failure().empty() ? "the motion of the grip inverts tets that it holds"
                                                       : equilibrium_.failure())
                 : std::string();
  apply(1);
  return done == 1;
}

bool LoadedBody::solve(std::span<const MaterialParameters> parameters, std::span<const double> start) {
  equilibrium_.set_parameters(parameters);
  const std::vector<double>& last = prediction_.x;
  const bool has_start = !start.empty() && equilibrium_.model().elasticity[0]->min_det_F(start) > 0;
  is_solved_ = (has_start && try_from(start)) || try_from(last) || load_in_parts();
  if (is_solved_) predict_readings();
  return is_solved_;
}

void LoadedBody::predict_readings() {
  std::copy(x().begin(), x().end(), prediction_.x.begin());
  for (size_t k = 0; k < load_.positions.size(); ++k) {
    const int marker = load_.positions[k].marker;
    prediction_.markers[k] = at(experiment_.markers[marker], x());
    if (!experiment_.marker_offset.empty())
      prediction_.markers[k] = prediction_.markers[k] + experiment_.marker_offset[marker];
  }
  prediction_.wrench = wrench();
}

Wrench LoadedBody::wrench() {
  if (probe_) return friction_ ? probe_->wrench(x()) + friction_->wrench(x()) : probe_->wrench(x());
  if (!grip_) return {};
  std::fill(force_.begin(), force_.end(), 0.0);
  equilibrium_.add_forces(force_);
  return wrench_of(*load_.grip, x(), force_);
}

Wrench LoadedBody::wrench_product(std::span<const double> dx) const {
  const std::span<const double> x = equilibrium_.linearized_x();
  return friction_ ? probe_->wrench_product(x, dx) + friction_->wrench_product(x, dx) : probe_->wrench_product(x, dx);
}

Wrench LoadedBody::wrench_change(std::span<const double> dtheta) {
  if (!has_wrench()) return {};
  if (probe_) return wrench_product(dx_);
  equilibrium_.force_tangent(dtheta, dx_, force_);
  return wrench_of(*load_.grip, equilibrium_.linearized_x(), force_);
}

void LoadedBody::add_wrench_transposed(const Wrench& bar, std::span<double> thetabar) {
  const std::span<const double> x = equilibrium_.linearized_x();
  if (friction_) friction_->add_wrench_transposed(x, bar, 1, xbar_);
  if (probe_) return probe_->add_wrench_transposed(x, bar, 1, xbar_);
  std::fill(force_.begin(), force_.end(), 0.0);
  add_wrench_of_transposed(*load_.grip, x, bar, force_);
  equilibrium_.add_force_transposed(force_, xbar_, thetabar);
}

void LoadedBody::residuals(std::span<double> r) const {
  size_t i = 0;
  const auto put = [&](const Vec3d& predicted, const Vec3d& measured, const Vec3d& sigma) {
    for (int k = 0; k < 3; ++k) r[i++] = (predicted[k] - measured[k]) / sigma[k];
  };
  for (size_t k = 0; k < load_.positions.size(); ++k)
    put(prediction_.markers[k], load_.positions[k].position, load_.positions[k].sigma);
  if (has_force())
    put(to_gauge(load_.gauge, prediction_.wrench.force), to_gauge(load_.gauge, *load_.force),
        gauge_sigma(load_.gauge, load_.force_sigma));
  if (has_torque()) {
    const auto& gauge = load_.torque_gauge;
    put(to_gauge(gauge, prediction_.wrench.torque), to_gauge(gauge, *load_.torque),
        gauge_sigma(gauge, load_.torque_sigma));
  }
}

void LoadedBody::restore(std::span<const double> x) {
  accepted_.assign(x.begin(), x.end());
  prediction_.x = accepted_;
}

// Later results depend only on the linearization point, not on trials in between.
bool LoadedBody::linearize(std::span<const MaterialParameters> parameters) {
  equilibrium_.set_x(accepted_);
  prediction_.x = accepted_;
  equilibrium_.set_parameters(parameters);
  ++counts_.factorizations;
  if (equilibrium_.factorize()) return store_wrench(), true;
  failure_ = load_.name + ": " + equilibrium_.failure();
  return false;
}

bool LoadedBody::predict(std::span<const double> dtheta, std::span<double> x) {
  ++counts_.solves;
  if (!equilibrium_.tangent(dtheta, x).ok) return false;
  const std::span<const double> from = equilibrium_.linearized_x();
  for (size_t i = 0; i < x.size(); ++i) x[i] += from[i];
  return true;
}

bool LoadedBody::solved(const SolveReport& report) {
  if (report.ok) return true;
  failure_ =
      load_.name + (report.indefinite ? ": the equilibrium is unstable"
                                      : ": a system with the stiffness matrix was solved to a relative residual of " +
                                            std::to_string(report.relative_residual) + " only");
  return false;
}

void LoadedBody::common_error(int k, std::span<double> dr) const {
  const CommonError& error = load_.common_errors.at(k);
  size_t i = 0;
  const auto put = [&](const Vec3d& e, const Vec3d& sigma) {
    for (int axis = 0; axis < 3; ++axis) dr[i++] = e[axis] / sigma[axis];
  };
  for (size_t m = 0; m < load_.positions.size(); ++m) put(error.markers.at(m), load_.positions[m].sigma);
  if (has_force()) put(to_gauge(load_.gauge, error.wrench.force), gauge_sigma(load_.gauge, load_.force_sigma));
  if (has_torque())
    put(to_gauge(load_.torque_gauge, error.wrench.torque), gauge_sigma(load_.torque_gauge, load_.torque_sigma));
}

void LoadedBody::put_change(const Wrench& change, std::span<double> dr) const {
  size_t i = 0;
  const auto put = [&](const Vec3d& d, const Vec3d& sigma) {
    for (int k = 0; k < 3; ++k) dr[i++] = d[k] / sigma[k];
  };
  for (const MarkerReading& reading : load_.positions) put(at(experiment_.markers[reading.marker], dx_), reading.sigma);
  if (has_force()) put(to_gauge(load_.gauge, change.force), gauge_sigma(load_.gauge, load_.force_sigma));
  if (has_torque())
    put(to_gauge(load_.torque_gauge, change.torque), gauge_sigma(load_.torque_gauge, load_.torque_sigma));
}

bool LoadedBody::multiply(std::span<const double> dtheta, std::span<double> dr) {
  ++counts_.solves;
  if (!solved(equilibrium_.tangent(dtheta, dx_))) return false;
  put_change(wrench_change(dtheta), dr);
  return true;
}

// V_probe, friction and their wrench are proportional to k: K dx = -grad V_probe - q.
bool LoadedBody::multiply_by_layer(std::span<double> dr) {
  const std::span<const double> x = equilibrium_.linearized_x();
  std::fill(xbar_.begin(), xbar_.end(), 0.0);
  probe_->add_gradient(x, -1, xbar_);
  if (!friction_) return move_along_force(probe_->wrench(x), dr);
  friction_->add_friction(x, -1, xbar_);
  return move_along_force(probe_->wrench(x) + friction_->wrench(x), dr);
}

bool LoadedBody::multiply_by_friction(std::span<double> dr) {
  const std::span<const double> x = equilibrium_.linearized_x();
  std::fill(xbar_.begin(), xbar_.end(), 0.0);
  friction_->add_friction(x, -1, xbar_);
  return move_along_force(friction_->wrench(x), dr);
}

bool LoadedBody::multiply_by_rim(std::span<double> dr) {
  std::fill(xbar_.begin(), xbar_.end(), 0.0);
  const Wrench own = probe_->add_rim_gradient(equilibrium_.linearized_x(), -1, xbar_);
  return move_along_force(own, dr);
}

bool LoadedBody::move_along_force(Wrench own, std::span<double> dr) {
  ++counts_.solves;
  if (!solved(equilibrium_.solve_stiffness(xbar_, dx_))) return false;
  put_change(wrench_product(dx_) + own, dr);
  return true;
}

bool LoadedBody::add_transposed(std::span<const double> w, std::span<double> thetabar) {
  if (std::all_of(w.begin(), w.end(), [](double x) { return x == 0; })) return true;
  std::fill(xbar_.begin(), xbar_.end(), 0.0);
  size_t i = 0;
  const auto take = [&](const Vec3d& sigma) {
    const Vec3d bar{{w[i] / sigma[0], w[i + 1] / sigma[1], w[i + 2] / sigma[2]}};
    i += 3;
    return bar;
  };
  for (const MarkerReading& reading : load_.positions) {
    const SurfacePoint& point = experiment_.markers[reading.marker];
    const Vec3d bar = take(reading.sigma);
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) xbar_[3 * point.vertices[k] + r] += point.weights[k] * bar[r];
  }
  if (has_wrench()) {
    Wrench bar;
    if (has_force()) bar.force = from_gauge(load_.gauge, take(gauge_sigma(load_.gauge, load_.force_sigma)));
    if (has_torque())
      bar.torque = from_gauge(load_.torque_gauge, take(gauge_sigma(load_.torque_gauge, load_.torque_sigma)));
    add_wrench_transposed(bar, thetabar);
  }
  ++counts_.solves;
  return solved(equilibrium_.add_adjoint(xbar_, thetabar));
}

}  // namespace aspic
