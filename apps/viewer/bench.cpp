#include "viewer/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "base/check.h"
#include "base/error.h"
#include "capture/bench_sites.h"
#include "capture/synthesis.h"
#include "fit/load_case.h"
#include "mesh/tet_shape.h"
#include "scene/toml_reader.h"

namespace aspic::viewer {
namespace {

constexpr double kMinSigma = 1e-4;      // relative sigma of exact readings
constexpr uint64_t kApart = 1'000'003;  // distance between the seeds of two cases

Vec3d gravity_of(const Scene& scene) {
  const Table document = read_toml(scene.resolved, scene.name);
  const Value* gravity = document.find("gravity");
  Vec3d g{};
  if (gravity && gravity->is_array())
    for (int i = 0; i < 3; ++i) g[i] = gravity->array()[i].number();
  return g;
}

std::vector<int> held_by(const Model& model) {
  std::vector<int> held;
  for (const Pin& pin : model.pins) {
    require_full(pin);
    held.insert(held.end(), pin.vertices.begin(), pin.vertices.end());
  }
  std::sort(held.begin(), held.end());
  if (held.empty()) throw InvalidInput("no pin holds the body against the indenter; pin it first (brush, B)");
  return held;
}

IndenterPose between(const IndenterPose& from, const IndenterPose& to, double s) {
  return {(1 - s) * from.center + s * to.center, to.axis, to.rotation};
}

}  // namespace

Bench::~Bench() = default;

Bench::Bench(const Scene& scene, const BenchOptions& options) : options_(options), truth_(true_material(scene)) {
  const Model& model = scene.simulation.model();
  const auto parameters = model.elasticity.front()->parameters();
  parameters_.assign(parameters.begin(), parameters.end());
  body_.mesh = model.mesh;
  body_.density = model.density;
  body_.fixed = held_by(model);
  gravity_ = gravity_of(scene);
  data_.name = scene.name;
  set_up_mesh(scene);
  place_markers();
}

void Bench::set_up_mesh(const Scene& scene) {
  std::optional<TetMesh> mesh;
  if (!options_.same_mesh) mesh = coarser_mesh(scene, {}, notes_);
  is_same_mesh_ = !mesh;
  if (!mesh) {
    mesh = to_user(scene.simulation.model().numbering, body_.mesh);
    notes_.emplace_back("The fit uses the mesh of the measurements (an inverse crime): it looks better than it is.");
  }
  data_.numbering = locality_numbering(*mesh);
  Experiment& data = data_.experiment;
  data.mesh = from_user(data_.numbering, *mesh);
  data.density = sample(truth_, *truth_.find("density"), data.mesh);
  data.fixed = held_vertices(body_.mesh, body_.fixed, data.mesh);
  if (data.fixed.size() < 3)
    throw InvalidInput(fmt::format("only {} vertices of the mesh of the fit lie where the body is held; pin more of it",
                                   data.fixed.size()));
  on_truth_ = std::make_unique<SurfaceProjection>(body_.mesh);
  on_data_ = std::make_unique<SurfaceProjection>(data.mesh);
  FittedMaterial numbered{.mesh = data.mesh, .model = truth_.model, .values = {}, .further = {}};
  std::vector<Vec3d> centroids;
  for (int t = 0; t < body_.mesh.tet_count(); ++t) centroids.push_back(centroid(body_.mesh, t));
  data_tet_ = sampling(numbered, centroids).tet;
}

void Bench::place_markers() {
  Experiment& data = data_.experiment;
  data.markers.clear(), body_.markers.clear(), marker_rest_.clear(), truth_rest_.clear();
  data_.marker_names.clear(), data_.marker_gap.clear();
  for (const ProjectedPoint& p : marker_sites(data.mesh, *on_data_, data.fixed, options_.markers, options_.seed)) {
    data_.marker_names.push_back(std::to_string(data.markers.size()));
    data_.marker_gap.push_back(0);
    data.markers.push_back(p.point);
    marker_rest_.push_back(p.position);
    const ProjectedPoint on_truth = on_truth_->nearest(p.position);
    body_.markers.push_back(on_truth.point);
    truth_rest_.push_back(on_truth.position);
  }
}

void Bench::set_options(const BenchOptions& options) {
  ASPIC_CHECK(options.same_mesh == options_.same_mesh);
  const bool same_markers = options.markers == options_.markers && options.seed == options_.seed;
  if (!same_markers && !data_.experiment.cases.empty())
    throw InvalidInput("the recorded cases have other markers; forget them first");
  options_ = options;
  if (!same_markers) place_markers();
}

// Markers below the indenter are hidden from the cameras.
void Bench::record(const FirstContact& touch, const IndenterPose& pose, int depths, const StopToken& stop) {
  LoadCase load;
  load.group = fmt::format("poke {}", groups_ + 1);
  load.indenter = touch.indenter;
  load.touch = touch.rest;
  load.gravity = gravity_;
  const double back = touch.indenter.shape == IndenterShape::sphere ? touch.indenter.radius : 0;
  const Vec3d site = touch.rest.center + back * touch.rest.axis;
  for (size_t m = 0; m < truth_rest_.size(); ++m)
    if (norm(truth_rest_[m] - site) > touch.indenter.radius)
      load.positions.push_back({static_cast<int>(m), {}, {{1, 1, 1}}});
  load.force = Vec3d{}, load.force_sigma = {{1, 1, 1}};
  const double deepest = dot(pose.center - touch.begun.center, touch.begun.axis);
  std::vector<double> last;
  for (int d = 1; d <= depths; ++d) {
    if (stop.stopped()) throw InvalidInput("interrupted; the measurements so far are kept");
    load.name = fmt::format("{}, depth {}", load.group, d);
    load.pose = between(touch.begun, pose, static_cast<double>(d) / depths);
    LoadedBody body(body_, load, truth_.model, parameters_, {});
    if (!body.solve(parameters_, last))
      throw InvalidInput(fmt::format("no equilibrium under this indenter: {}; press less deep", body.failure()));
    last = body.prediction().x;
    if (d == 1) ++groups_;
    add(load, body.prediction(), deepest * d / depths);
  }
}

// Touch and pose are relative to the surface, and the surface of the data set's mesh may differ slightly.
LoadCase Bench::as_data(const LoadCase& load) const {
  LoadCase data = load;
  const Vec3d site =
      load.touch.center + (load.indenter->shape == IndenterShape::sphere ? load.indenter->radius : 0) * load.touch.axis;
  const Vec3d shift = on_data_->nearest(site).position - site;
  data.touch.center = data.touch.center + shift;
  data.pose.center = data.pose.center + shift;
  return data;
}

void Bench::add(const LoadCase& load, const CasePrediction& found, double depth) {
  std::mt19937_64 random(options_.seed + kApart * ++recorded_);
  std::normal_distribution<double> normal;
  LoadCase read = as_data(load);
  double motion = 0;
  for (size_t k = 0; k < read.positions.size(); ++k)
    motion = std::max(motion, norm(found.markers[k] - truth_rest_[read.positions[k].marker]));
  const auto disturbed = [&](Vec3d value, double sigma) {
    for (int i = 0; i < 3; ++i) value[i] += sigma * normal(random);
    return value;
  };
  const auto with = [](double sigma) { return Vec3d{{sigma, sigma, sigma}}; };
  const double counted = std::max(options_.noise, kMinSigma);
  const double largest = motion > 0 ? motion : load.indenter->radius,
               force = std::max(norm(found.wrench.force), 1e-300);
  for (size_t k = 0; k < read.positions.size(); ++k) {
    MarkerReading& reading = read.positions[k];
    const Vec3d moved = found.markers[k] - truth_rest_[reading.marker];
    reading.position = disturbed(marker_rest_[reading.marker] + moved, options_.noise * largest);
    reading.sigma = with(counted * largest);
  }
  read.force = disturbed(found.wrench.force, options_.noise * force);
  read.force_sigma = with(counted * force);
  data_.experiment.cases.push_back(std::move(read));
  depths_.push_back(depth);
}

void Bench::forget(int c) {
  data_.experiment.cases.erase(data_.experiment.cases.begin() + c);
  depths_.erase(depths_.begin() + c);
}

void Bench::forget_all() {
  data_.experiment.cases.clear();
  depths_.clear();
  groups_ = 0;
}

std::vector<IndentationSite> Bench::sites(double radius, int count) const {
  return indentation_sites(body_.mesh, body_.fixed, radius, count);
}

std::vector<double> Bench::on_scene(std::span<const double> of_data) const {
  std::vector<double> values;
  for (const int t : data_tet_) values.push_back(of_data[t]);
  return values;
}

std::vector<double> Bench::true_young() const { return sample(truth_, *truth_.find("young"), data_.experiment.mesh); }

}  // namespace aspic::viewer
