#include "fit/incremental_body.h"

#include <cmath>

#include "energy/linear_load.h"
#include "fit/load_case.h"
#include "math/vectors.h"
#include "mesh/surface.h"
#include "mesh/vertices.h"

namespace aspic {
namespace {

constexpr int kMaxHalvings = 12;

IndenterPose mixed(const IndenterPose& a, const IndenterPose& b, double part) {
  const auto mix = [part](const Vec3d& x, const Vec3d& y) { return (1 - part) * x + part * y; };
  return {mix(a.center, b.center), mix(a.axis, b.axis), mix(a.rotation, b.rotation)};
}

}  // namespace

IncrementalBody::IncrementalBody(const Experiment& experiment, const LoadCase& load, const StrainSpaceModuli& moduli,
                                 const BickelOptions& options)
    : experiment_(experiment), load_(load), options_(options), body_(experiment.mesh, moduli, options.rule) {
  x_ = rest_positions(experiment.mesh);
  held_.assign(experiment.mesh.rest.size(), false);
  for (const int v : experiment.fixed) held_[v] = true;
  add_loads();
  Couplings couplings;
  body_.add_couplings(couplings);
  for (const auto& energy : energies_) energy->add_couplings(couplings);
  pattern_ = make_pattern(experiment.mesh.vertex_count(), std::move(couplings));
  for (const auto& energy : energies_) energy->bind(pattern_);
  solver_ = make_linear_solver("cholesky");
  solver_->analyze(pattern_);
}

bool IncrementalBody::go_to(double part) {
  for (ScaledLoad* load : scaled_) load->set_factor(part);
  if (probe_) probe_->set_pose(mixed(load_.touch, load_.pose, part));
  if (!balance()) {
    failure_ = load_.name + ", at " + std::to_string(std::lround(100 * part)) +
               " % of the load: the forces of the increment do not balance";
    return false;
  }
  body_.accept(x_);
  return true;
}

CasePrediction IncrementalBody::prediction() const {
  CasePrediction p;
  p.x = x_;
  for (const MarkerReading& reading : load_.positions) {
    const SurfacePoint& point = experiment_.markers[reading.marker];
    Vec3d at{};
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) at[r] += point.weights[k] * x_[3 * point.vertices[k] + r];
    p.markers.push_back(at);
  }
  if (probe_) p.wrench = probe_->wrench(x_);
  return p;
}

void IncrementalBody::add_loads() {
  const TetMesh& mesh = experiment_.mesh;
  const auto add_scaled = [&](std::unique_ptr<Energy> load) {
    auto scaled = std::make_unique<ScaledLoad>(std::move(load));
    scaled_.push_back(scaled.get());
    energies_.push_back(std::move(scaled));
  };
  if (dot(load_.gravity, load_.gravity) > 0) {
    std::vector<double> weight(x_.size());
    for (int t = 0; t < mesh.tet_count(); ++t) add_body_force(mesh, t, experiment_.density[t] * load_.gravity, weight);
    add_scaled(make_linear_load("gravity", std::move(weight)));
  }
  if (load_.pressure != 0) add_scaled(make_pressure_of(load_, mesh));
  if (load_.indenter) {
    auto probe = make_probe(mesh, boundary_triangles(mesh, 0, mesh.tet_count()), *load_.indenter, load_.touch);
    probe_ = probe.get();
    energies_.push_back(std::move(probe));
  }
}

std::vector<double> IncrementalBody::residual(std::span<const double> x, double& size) const {
  std::vector<double> load(x.size(), 0.0), inner(x.size(), 0.0);
  for (const auto& energy : energies_) ActiveTerm(*energy).add_gradient(x, 1, load);
  body_.add_gradient(x, inner);
  clear_held(load);
  clear_held(inner);
  size = std::fmax(size, std::fmax(norm(load), norm(inner)));
  for (size_t i = 0; i < x.size(); ++i) inner[i] += load[i];
  return inner;
}

void IncrementalBody::clear_held(std::vector<double>& g) const {
  for (size_t v = 0; v < held_.size(); ++v)
    if (held_[v]) g[3 * v] = g[3 * v + 1] = g[3 * v + 2] = 0;
}

bool IncrementalBody::balance() {
  double& size = force_size_;
  std::vector<double> g = residual(x_, size), d(x_.size()), trial(x_.size());
  for (int i = 0; i < options_.max_iterations; ++i, ++iterations_) {
    const double before = norm(g);
    if (before <= options_.tolerance * size || before == 0) return true;
    if (!factorize() || !solver_->solve(g, d, 1e-10).ok) return false;
    double step = 1;
    bool moved = false;
    for (int h = 0; h < kMaxHalvings && !moved; ++h, step /= 2) {
      for (size_t k = 0; k < x_.size(); ++k) trial[k] = x_[k] - step * d[k];
      std::vector<double> next = residual(trial, size);
      if (!(norm(next) < before)) continue;
      x_ = trial, g = std::move(next), moved = true;
    }
    if (!moved) return norm(g) <= 1e3 * options_.tolerance * size;
  }
  return false;
}

bool IncrementalBody::factorize() {
  if (!matrix_) matrix_ = std::make_unique<BlockSparse>(pattern_);
  matrix_->set_zero();
  body_.add_stiffness(x_, *matrix_);
  for (const auto& energy : energies_)
    ActiveTerm(*energy).add_hessian(x_, 1, {.kind = Definiteness::clamped}, *matrix_);
  for (int r = 0; r < pattern_.rows(); ++r)
    for (int64_t s = pattern_.row_start[r]; s < pattern_.row_start[r + 1]; ++s)
      if (held_[r] || held_[pattern_.column[s]])
        matrix_->block[s] = s == pattern_.diagonal(r) ? identity3<double>() : Mat3d{};
  return solver_->factorize(*matrix_);
}

}  // namespace aspic
