#include "model/load_history.h"

#include <algorithm>
#include <cmath>

#include "dynamics/incremental_potential.h"
#include "dynamics/model_builder.h"
#include "energy/linear_load.h"
#include "energy/maxwell_branches.h"
#include "linalg/auto_solver.h"
#include "mesh/vertices.h"
#include "model/limits.h"
#include "model/load_case.h"
#include "optimize/newton.h"

namespace aspic {
namespace {

constexpr int kRampSteps = 8;   // minimum number per ramp. Chosen
constexpr int kHoldSteps = 10;  // first step of a hold: its length / 2^kHoldSteps; then lengths double. Chosen

Vec3d blend(const Vec3d& a, const Vec3d& b, double part) { return (1 - part) * a + part * b; }

bool is_equal(const Vec3d& a, const Vec3d& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }
bool is_equal(const IndenterPose& a, const IndenterPose& b) {
  return is_equal(a.center, b.center) && is_equal(a.axis, b.axis) && is_equal(a.rotation, b.rotation);
}

Vec3d marker_at(const SurfacePoint& point, std::span<const double> x) {
  Vec3d sum{};
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < 3; ++r) sum[r] += point.weights[k] * x[3 * point.vertices[k] + r];
  return sum;
}

LoadCase without_load(LoadCase load) {
  load.gravity = {};
  load.pressure = 0;
  load.pose = load.touch;
  if (load.grip) load.grip->displacement = load.grip->rotation = {};
  return load;
}

// Place in a history: between the waypoints segment and segment + 1.
struct Stop {
  double time;
  size_t segment;
  double part;
};

// The times at which steps end, segment by segment.
std::vector<Stop> stops_of(const LoadHistory& history) {
  const std::vector<double>& times = history.times;
  const double same = kFinest * (times.back() - times.front());
  std::vector<Stop> stops = {{times.front(), 0, 0}};
  for (size_t k = 0; k + 1 < times.size(); ++k) {
    const double begin = times[k], length = times[k + 1] - begin;
    std::vector<double> inside = {times[k + 1]};
    if (length > same) {
      for (const ForceReading& reading : history.forces)
        if (reading.time > begin && reading.time < times[k + 1]) inside.push_back(reading.time);
      if (is_same_load(history.waypoints[k], history.waypoints[k + 1]))
        for (int i = 1; i <= kHoldSteps; ++i) inside.push_back(begin + std::ldexp(length, -i));
      else
        for (int i = 1; i < kRampSteps; ++i) inside.push_back(begin + length * i / kRampSteps);
    }
    std::sort(inside.begin(), inside.end());
    double last = begin;
    for (const double t : inside) {
      if (t < times[k + 1] && (t - last <= same || times[k + 1] - t <= same)) continue;
      stops.push_back({t, k, length > same ? (t - begin) / length : 1});
      last = t;
    }
  }
  return stops;
}

// A body with branches at one time of its history.
class HistoryBody {
 public:
  HistoryBody(const Experiment& body, const LoadHistory& history, const ViscoelasticMaterial& material,
              const EquilibriumOptions& options)
      : body_(body),
        x_(rest_positions(body.mesh)),
        model_(make_model(history, material)),
        pins_(model_.pins, x_),
        E_(model_, pins_),
        newton_(make_linear_solver(options.linear)),
        z_(E_.terms().internal().size(), 0.0) {
    minimize_.tolerance = options.tolerance;
    minimize_.max_iterations = options.max_iterations;
    for (auto* v : {&start_, &force_}) v->resize(x_.size());
    z_start_ = z_;
  }

  // Advances from one load to another in a duration [s]. Returns false without an equilibrium.
  bool advance(const LoadCase& from, const LoadCase& to, double duration, int halvings = 0) {
    if (step(to, duration)) return true;
    if (halvings == kMaxHalvings) return false;
    const LoadCase middle = load_between(from, to, 0.5);
    return advance(from, middle, duration / 2, halvings + 1) && advance(middle, to, duration / 2, halvings + 1);
  }

  Wrench wrench(const LoadCase& load) {
    if (probe_) return probe_->wrench(x_);
    return load.grip ? wrench_of(*load.grip, x_, force_) : Wrench{};
  }
  std::span<const double> x() const { return x_; }

 private:
  Model make_model(const LoadHistory& history, const ViscoelasticMaterial& material) {
    const TetMesh& mesh = body_.mesh;
    const LoadCase& first = history.waypoints.front();
    ModelBuilder builder(mesh);
    builder.material(material.model, material.parameters)
        .density(body_.density)
        .mass(MassKind::lumped)
        .pin("fixed", body_.fixed);
    if (first.grip) {
      grip_ = std::make_shared<GripMotion>(*first.grip, 1);
      builder.pin("grip", first.grip->vertices, [motion = grip_](const Vec3d& X, double) { return (*motion)(X); });
    }
    Model model = builder.build();
    add_loads(history, model);
    if (!material.branches.empty()) model.damping.push_back(branches_of(material));
    return model;
  }

  std::unique_ptr<Energy> branches_of(const ViscoelasticMaterial& material) const {
    std::vector<MaxwellBranch> branches;
    for (const RelaxationBranch& b : material.branches) {
      MaxwellBranch& branch = branches.emplace_back();
      branch.relaxation_time = b.time;
      for (const MaterialParameters& m : material.parameters) branch.shear.push_back(b.ratio * m.lame.mu);
    }
    return make_maxwell_branches("viscoelastic", body_.mesh, 0, std::move(branches));
  }

  void add_loads(const LoadHistory& history, Model& model) {
    const auto add_scaled = [&](std::unique_ptr<Energy> load) {
      auto scaled = std::make_unique<ScaledLoad>(std::move(load));
      ScaledLoad* pointer = scaled.get();
      model.loads.push_back(std::move(scaled));
      return pointer;
    };
    for (int axis = 0; axis < 3; ++axis) {
      if (std::all_of(history.waypoints.begin(), history.waypoints.end(),
                      [&](const LoadCase& c) { return c.gravity[axis] == 0; }))
        continue;
      Vec3d unit{};
      unit[axis] = 1;
      std::vector<double> weight(x_.size());
      for (int t = 0; t < body_.mesh.tet_count(); ++t) add_body_force(body_.mesh, t, body_.density[t] * unit, weight);
      gravity_[axis] = add_scaled(make_linear_load("gravity", std::move(weight)));
    }
    for (const LoadCase& c : history.waypoints) {
      if (c.pressure == 0 || pressure_) continue;
      LoadCase unit = c;
      unit.pressure = 1;
      pressure_ = add_scaled(make_pressure_of(unit, body_.mesh));
    }
    if (!history.waypoints.front().indenter) return;
    auto probe = make_probe_of(body_, history.waypoints.front());
    probe_ = probe.get();
    model.loads.push_back(std::move(probe));
  }

  void apply(const LoadCase& load) {
    if (grip_) *grip_ = GripMotion(*load.grip, 1);
    for (int axis = 0; axis < 3; ++axis)
      if (gravity_[axis]) gravity_[axis]->set_factor(load.gravity[axis]);
    if (pressure_) pressure_->set_factor(load.pressure);
    if (probe_) probe_->set_pose(load.pose);
  }

  bool step(const LoadCase& load, double duration) {
    start_ = x_;
    z_start_ = z_;
    apply(load);
    pins_.place(0, x_);
    const StepContext context{start_, 0, 0};
    E_.at({.predicted = start_, .inertia = 0, .context = context, .internal = z_start_, .duration = duration});
    const bool is_valid = !grip_ || model_.elasticity[0]->min_det_F(x_) > 0;
    if (!is_valid || !is_success(minimizer_.minimize(E_, newton_, x_, minimize_, {}).status)) {
      x_ = start_;
      return false;
    }
    std::fill(force_.begin(), force_.end(), 0.0);
    for (const ActiveTerm& V : E_.terms().potential()) V.add_gradient(x_, 1, force_);
    for (const ActiveTerm& D : E_.terms().damping()) D.add_gradient(x_, 1, force_);
    if (!z_.empty()) E_.terms().end_internal(x_, z_);
    return true;
  }

  const Experiment& body_;
  std::vector<double> x_;
  std::shared_ptr<GripMotion> grip_;
  Probe* probe_ = nullptr;  // in the model, as the loads below
  ScaledLoad *gravity_[3] = {}, *pressure_ = nullptr;
  Model model_;
  Pins pins_;
  IncrementalPotential E_;
  Newton newton_;
  Minimizer minimizer_;
  MinimizeOptions minimize_;
  std::vector<double> z_, z_start_;    // stresses of the branches
  std::vector<double> start_, force_;  // x at the start of the step; forces on the vertices at its end
};

}  // namespace

LoadCase load_between(const LoadCase& a, const LoadCase& b, double part) {
  if (part == 1) return b;
  LoadCase load = a;
  load.gravity = blend(a.gravity, b.gravity, part);
  load.pressure = (1 - part) * a.pressure + part * b.pressure;
  if (load.grip && b.grip) {
    load.grip->displacement = blend(a.grip->displacement, b.grip->displacement, part);
    load.grip->rotation = blend(a.grip->rotation, b.grip->rotation, part);
  }
  load.pose = {blend(a.pose.center, b.pose.center, part), blend(a.pose.axis, b.pose.axis, part),
               blend(a.pose.rotation, b.pose.rotation, part)};
  return load;
}

bool is_same_load(const LoadCase& a, const LoadCase& b) {
  const bool is_same_grip =
      !a.grip || !b.grip ||
      (is_equal(a.grip->displacement, b.grip->displacement) && is_equal(a.grip->rotation, b.grip->rotation));
  return is_same_grip && is_equal(a.gravity, b.gravity) && a.pressure == b.pressure && is_equal(a.pose, b.pose);
}

HistoryPrediction simulate(const Experiment& body, const LoadHistory& history, const ViscoelasticMaterial& material,
                           const EquilibriumOptions& options) {
  HistoryPrediction prediction;
  HistoryBody now(body, history, material, options);
  const double same = kFinest * (history.times.back() - history.times.front());
  const auto read_markers = [&](const LoadCase& load) {
    for (const MarkerReading& reading : load.positions)
      prediction.markers.push_back(marker_at(body.markers[static_cast<size_t>(reading.marker)], now.x()));
  };
  LoadCase last = without_load(history.waypoints.front());
  double time = history.times.front();
  for (const Stop& stop : stops_of(history)) {
    const bool is_first = stop.part == 0;
    const LoadCase& end = history.waypoints[stop.segment + (is_first ? 0 : 1)];
    const LoadCase load = is_first ? end : load_between(history.waypoints[stop.segment], end, stop.part);
    if (!now.advance(last, load, stop.time - time)) {
      prediction.failure = history.name + ": no equilibrium was found at the time " + std::to_string(stop.time) + " s";
      return prediction;
    }
    last = load;
    time = stop.time;
    while (prediction.forces.size() < history.forces.size() &&
           history.forces[prediction.forces.size()].time <= time + same)
      prediction.forces.push_back(dot(now.wrench(load).force, history.forces[prediction.forces.size()].axis));
    prediction.end = now.wrench(load);
    if (is_first || stop.part == 1) read_markers(end);
  }
  return prediction;
}

}  // namespace aspic
