#include "data/synthesis.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "base/error.h"
#include "data/bench_sites.h"
#include "data/data_findings.h"
#include "data/judge.h"
#include "data/unstated_values.h"
#include "estimate/indentation_sites.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"
#include "model/limits.h"
#include "model/load_case.h"

namespace aspic {
namespace {

constexpr double kGravity = 9.81;  // on Earth [m/s^2]
// Lever arm of a force about the center of an indenter, relative to its radius, for the noise of torques. Chosen.
constexpr double kMinArm = 0.01;

class Bench {
 public:
  Bench(const Scene& scene, const SynthesisOptions& options)
      : model_(scene.simulation.model()), options_(options), size_(std::cbrt(total_volume(model_.mesh))) {
    if (model_.bodies.size() != 1)
      throw InvalidInput(scene.name + ": has " + std::to_string(model_.bodies.size()) +
                         " bodies; the bench measures one: remove the others");
    result_.data.name = scene.name;
    result_.truth = true_material(scene);
    set_up_truth();
    set_up_data(scene);
    place_markers();
    add_indentations();
    for (const LoadCase& load : options.cases) add_indentation(load);
    add_gravity();
    if (truth_.cases.empty()) throw InvalidInput(scene.name + ": nothing is measured; give pokes or gravity");
  }

  Synthesis run(const SynthesisObserver& observe) {
    measure(observe);
    if (!data().cases.empty()) add_noise();
    return std::move(result_);
  }

 private:
  Measured& data() { return result_.data.experiment; }

  // Uses the body of the scene without its springs, weights and motions.
  void set_up_truth() {
    truth_.mesh = model_.mesh;
    truth_.density = model_.density;
    for (const Pin& pin : model_.pins) {
      require_full(pin);
      truth_.fixed.insert(truth_.fixed.end(), pin.vertices.begin(), pin.vertices.end());
      if (pin.motion) result_.notes.push_back("the pin '" + pin.name + "' moves in the scene; here it is fixed");
    }
    std::sort(truth_.fixed.begin(), truth_.fixed.end());
    if (truth_.fixed.empty())
      throw InvalidInput("nothing holds the body against pokes; add a [[body.pin]] to the scene");
    if (!model_.loads.empty())
      result_.notes.push_back("loads and springs of the scene are ignored: the body at rest is poked");
  }

  void set_up_data(const Scene& scene) {
    std::optional<TetMesh> mesh = options_.mesh;
    if (!mesh) mesh = coarser_mesh(scene, options_.mesher, result_.notes);
    if (!mesh) {
      result_.notes.push_back(
          "the data have the mesh of the scene: an inverse crime, with fits that look better than they "
          "are (give a coarser one with --mesh)");
      mesh = to_user(model_.numbering, model_.mesh);
    }
    DataSet& set = result_.data;
    set.numbering = locality_numbering(*mesh);
    data().mesh = from_user(set.numbering, *mesh);
    data().density = sample(result_.truth, *result_.truth.find("density"), data().mesh);
    if (options_.regions) label_regions();
    data().fixed = held_vertices(truth_.mesh, truth_.fixed, data().mesh);
    if (data().fixed.size() < 3)
      throw InvalidInput("only " + std::to_string(data().fixed.size()) +
                         " vertices of the data's mesh are where the body is held; it is too coarse, or elsewhere");
    on_truth_ = std::make_unique<SurfaceProjection>(truth_.mesh);
    on_data_ = std::make_unique<SurfaceProjection>(data().mesh);
  }

  void label_regions() {
    const std::vector<double>& young = *result_.truth.find("young");
    const std::vector<double> levels = levels_of(young);
    if (levels.empty()) throw InvalidInput("the stiffness varies from tet to tet; there are no regions to label");
    data().mesh.region.clear();
    for (const double E : sample(result_.truth, young, data().mesh)) {
      const auto next = std::lower_bound(levels.begin(), levels.end(), E * (1 - kSame));
      data().mesh.region.push_back(static_cast<int>(next - levels.begin()) + 1);
    }
  }

  // Material points of the data's surface. Where the surfaces differ, they follow the nearest point of the truth.
  void place_markers() {
    for (const ProjectedPoint& p :
         marker_sites(data().mesh, *on_data_, data().fixed, options_.markers, options_.seed)) {
      result_.data.marker_names.push_back(std::to_string(data().markers.size()));
      result_.data.marker_gap.push_back(0);
      data().markers.push_back(p.point);
      const ProjectedPoint on_truth = on_truth_->nearest(p.position);
      truth_.markers.push_back(on_truth.point);
      marker_rest_.push_back(p.position);
      truth_rest_.push_back(on_truth.position);
    }
  }

  Indenter indenter() const {
    return {options_.shape, options_.contact,
            options_.indenter_radius > 0 ? options_.indenter_radius : kUsualRadius * size_, 0};
  }

  // Largest Young's modulus around the sites.
  double young_around(const std::vector<IndentationSite>& sites) const {
    std::vector<char> is_site(truth_.mesh.rest.size(), 0);
    for (const IndentationSite& s : sites) is_site[s.vertex] = 1;
    const std::vector<MaterialParameters> parameters = model_.elasticity.front()->parameters();
    double young = 0;
    for (int t = 0; t < truth_.mesh.tet_count(); ++t) {
      const TetNodes nodes = nodes_of(truth_.mesh, t);
      if (std::any_of(nodes.begin(), nodes.end(), [&](int v) { return is_site[v] != 0; }))
        young = std::max(young, young_modulus(parameters[t].lame));
    }
    return young;
  }

  void add_indentations() {
    if (options_.indentations == 0) return;
    Indenter with = indenter();
    const auto sites = indentation_sites(truth_.mesh, truth_.fixed, 2 * with.radius, options_.indentations);
    if (sites.empty())
      throw InvalidInput("there is no site for a tip of radius " + three_digits(with.radius) +
                         " m; use a smaller one (--tip), or hold less of the body");
    if (static_cast<int>(sites.size()) < options_.indentations)
      result_.notes.push_back("only " + std::to_string(sites.size()) + " sites were found for a tip of radius " +
                              number_text(with.radius) + " m can poke");
    with.stiffness = layer_stiffness(with, young_around(sites));
    for (size_t s = 0; s < sites.size(); ++s)
      for (int d = 1; d <= options_.depths; ++d)
        add_indentation(with, truth_.mesh.rest[sites[s].vertex], sites[s].inward, static_cast<int>(s) + 1, d);
  }

  void add_indentation(const Indenter& with, const Vec3d& site, const Vec3d& inward, int number, int d) {
    LoadCase load;
    load.group = "poke " + std::to_string(number);
    load.name = load.group + ", depth " + std::to_string(d);
    load.indenter = with;
    const double depth = options_.deepest * size_ * d / options_.depths;
    const Vec3d back = with.shape == IndenterShape::sphere ? with.radius * inward : Vec3d{};
    load.touch = {site - back, inward, {}};
    load.pose = {site - back + depth * inward, inward, {}};
    add_indentation(std::move(load));
  }

  // Touch and pose are relative to the surface, which may differ slightly in the mesh of the data.
  void add_indentation(LoadCase load) {
    const double back = load.indenter->shape == IndenterShape::sphere ? load.indenter->radius : 0;
    const Vec3d site = load.touch.center + back * load.touch.axis;
    add_case(std::move(load), on_data_->nearest(site).position - site, site);
  }

  void add_gravity() {
    for (size_t g = 0; g < options_.gravity.size(); ++g) {
      LoadCase load;
      load.name = load.group = "gravity " + std::to_string(g + 1);
      load.gravity = (kGravity / norm(options_.gravity[g])) * options_.gravity[g];
      add_case(std::move(load), {}, {});
    }
  }

  // Adds a case without the markers hidden by the indenter.
  void add_case(LoadCase load, const Vec3d& shift, const Vec3d& site) {
    for (size_t m = 0; m < truth_.markers.size(); ++m)
      if (!load.indenter || squared_norm(truth_rest_[m] - site) > load.indenter->radius * load.indenter->radius)
        load.positions.push_back({static_cast<int>(m), {}, {{1, 1, 1}}});
    if (load.positions.empty() && load.indenter) load.force = Vec3d{}, load.force_sigma = {{1, 1, 1}};
    truth_.cases.push_back(load);
    load.touch.center = load.touch.center + shift;
    load.pose.center = load.pose.center + shift;
    asked_.push_back(std::move(load));
  }

  // Solves each indentation from the previous depth; a case without equilibrium ends its indentation.
  void measure(const SynthesisObserver& observe) {
    const std::vector<MaterialParameters> parameters = model_.elasticity.front()->parameters();
    const int count = static_cast<int>(truth_.cases.size());
    std::vector<double> last;
    std::string failed_group;
    for (int c = 0; c < count; ++c) {
      const LoadCase& load = truth_.cases[c];
      SynthesisStep step{c + 1, count, load.name, {}, 0, {}};
      if (c > 0 && load.group != truth_.cases[c - 1].group) last.clear();
      if (load.group == failed_group) {
        step.failure = "omitted: a smaller load has no equilibrium";
      } else {
        LoadedBody body(truth_, load, result_.truth.model, parameters, {});
        if (body.solve(parameters, last)) {
          last = body.prediction().x;
          step.wrench = body.prediction().wrench;
          step.iterations = body.prediction().solve.iterations;
          note_readings(c, body.prediction());
        } else {
          failed_group = load.group;
          step.failure = body.failure();
        }
      }
      if (!step.failure.empty()) {
        ++result_.failed;
        result_.notes.push_back(load.name + " is omitted: " + step.failure);
      }
      if (observe) observe(step);
      if (options_.stop.stopped()) {
        result_.interrupted = true;
        return;
      }
    }
  }

  void note_readings(int c, const CasePrediction& found) {
    LoadCase load = asked_[c];
    for (size_t k = 0; k < load.positions.size(); ++k) {
      const int m = load.positions[k].marker;
      const Vec3d moved = found.markers[k] - truth_rest_[m];
      largest_motion_ = std::max(largest_motion_, norm(moved));
      load.positions[k].position = marker_rest_[m] + moved;
    }
    load.force.reset();
    if (load.indenter && options_.forces) load.force = found.wrench.force;
    if (load.indenter && options_.torques) load.torque = found.wrench.torque;
    largest_force_ = std::max(largest_force_, norm(found.wrench.force));
    // The moment about the center of a frictionless sphere is zero and cannot be measured.
    const double arm = load.indenter ? kMinArm * load.indenter->radius : 0;
    largest_torque_ = std::max({largest_torque_, norm(found.wrench.torque), arm * norm(found.wrench.force)});
    data().cases.push_back(std::move(load));
  }

  void add_noise() {
    std::mt19937_64 random(options_.seed + 1);
    std::normal_distribution<double> normal;
    const auto disturb = [&](Vec3d& value, Vec3d& sigma, double noise, double largest) {
      const double sd = std::max(noise, kExactError) * (largest > 0 ? largest : 1);
      for (int i = 0; i < 3; ++i) value[i] += noise * largest * normal(random);
      sigma = {{sd, sd, sd}};
    };
    for (LoadCase& load : data().cases) {
      for (MarkerReading& r : load.positions) disturb(r.position, r.sigma, options_.noise, largest_motion_);
      if (load.force) disturb(*load.force, load.force_sigma, options_.force_noise, largest_force_);
      if (load.torque) disturb(*load.torque, load.torque_sigma, options_.force_noise, largest_torque_);
    }
  }

  const Model& model_;
  const SynthesisOptions& options_;
  double size_;  // size of the body [m]
  Synthesis result_;
  Experiment truth_;             // on the mesh of the scene, with the same markers and cases
  std::vector<LoadCase> asked_;  // requested cases of the data
  std::vector<Vec3d> marker_rest_, truth_rest_;
  std::unique_ptr<SurfaceProjection> on_truth_, on_data_;
  double largest_motion_ = 0, largest_force_ = 0, largest_torque_ = 0;
};

void check(const SynthesisOptions& o) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw InvalidInput(what);
  };
  require(o.indentations >= 0 && o.indentations <= 1000, "pokes must be 0 to 1000");
  require(o.depths >= 1 && o.depths <= 100, "depths must be 1 to 100");
  require(o.markers >= 0 && o.markers <= 100'000, "markers must be 0 to 100000");
  require(o.markers > 0 || o.forces || o.torques, "without markers, forces and torques there is nothing to measure");
  require(o.noise >= 0 && o.force_noise >= 0 && std::isfinite(o.noise + o.force_noise), "noise must be >= 0");
  require(o.indenter_radius >= 0 && std::isfinite(o.indenter_radius), "the radius of the tip must be > 0");
  require(o.deepest > 0 && o.deepest < 1, "the depth must be > 0 and < 1, relative to the size of the body");
  for (const Vec3d& g : o.gravity)
    require(norm(g) > 0 && std::isfinite(norm(g)), "gravity needs a direction, not 0,0,0");
}

}  // namespace

void require_full(const Pin& pin) {
  if (!pin.directions.empty())
    throw InvalidInput("pin '" + pin.name +
                       "' holds its vertices along some directions only; captured data need vertices held in "
                       "all (remove its axes or direction)");
}

Synthesis synthesize(const Scene& scene, const SynthesisOptions& options, const SynthesisObserver& observe) {
  check(options);
  return Bench(scene, options).run(observe);
}

}  // namespace aspic
