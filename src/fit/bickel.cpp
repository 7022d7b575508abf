#include "fit/bickel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "energy/linear_load.h"
#include "energy/pressure.h"
#include "fit/load_case.h"
#include "fit/scaled_load.h"
#include "linalg/linear_solver.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

constexpr char kLinear[] = "corotated";
constexpr int kMaxHalvings = 12;

ParameterMap linear_map(const TetMesh& mesh, Spread spread, const BickelOptions& options) {
  std::vector<Unknown> unknowns = {{"young", spread, options.handles, options.young}};
  if (options.fits_poisson) unknowns.push_back({"poisson", Spread::uniform, 0, options.poisson});
  const MaterialParameters known{lame_from_young_poisson(options.young, options.poisson), {}};
  return ParameterMap(mesh, kLinear, std::vector<MaterialParameters>(mesh.tets.size(), known), std::move(unknowns));
}

struct LinearFit {
  bool ok = false;
  std::string failure;
  FitReport report;
  std::vector<MaterialParameters> parameters;
  std::vector<double> x;  // of the first case
};

LinearFit fit_linear(const Experiment& experiment, Spread spread, const BickelOptions& options) {
  const ParameterMap map = linear_map(experiment.mesh, spread, options);
  Misfit misfit(experiment, map, options.equilibrium);
  const auto prior = make_regularizer(experiment.mesh, map, options.prior);
  LinearFit done;
  done.report = fit(misfit, *prior, map.guess(), options.fit);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  if (done.report.p.empty() || !misfit.evaluate(done.report.p, r)) {
    done.failure = experiment.cases.front().name + ": no linear material explains it: " +
                   (misfit.failure().empty() ? done.report.words : misfit.failure());
    return done;
  }
  done.parameters = map.parameters(done.report.p);
  done.x = misfit.prediction(0).x;
  done.ok = true;
  return done;
}

Experiment only(const Experiment& experiment, const LoadCase& load) {
  Experiment one = subset(experiment, [](const LoadCase&) { return false; });
  one.cases = {load};
  return one;
}

TipPose between(const TipPose& a, const TipPose& b, double part) {
  const auto mix = [part](const Vec3d& x, const Vec3d& y) { return (1 - part) * x + part * y; };
  return {mix(a.center, b.center), mix(a.axis, b.axis), mix(a.rotation, b.rotation)};
}

double norm(std::span<const double> x) {
  double sum = 0;
  for (const double xi : x) sum += xi * xi;
  return std::sqrt(sum);
}

// The body with the loads of a case, balanced increment by increment.
class IncrementalBody {
 public:
  IncrementalBody(const Experiment& experiment, const LoadCase& load, const StrainSpaceModuli& moduli,
                  const BickelOptions& options)
      : experiment_(experiment), load_(load), options_(options), body_(experiment.mesh, moduli, options.rule) {
    for (const Vec3d& X : experiment.mesh.rest) x_.insert(x_.end(), {X[0], X[1], X[2]});
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

  // Applies this part of the load and balances; false: failure() tells why.
  bool go_to(double part) {
    for (ScaledLoad* load : scaled_) load->set_factor(part);
    if (probe_) probe_->set_pose(between(load_.touch, load_.pose, part));
    if (!balance()) {
      failure_ = load_.name + ", at " + std::to_string(std::lround(100 * part)) +
                 " % of the load: the forces of the increment do not balance";
      return false;
    }
    body_.accept(x_);
    return true;
  }

  CasePrediction prediction() const {
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
  const std::string& failure() const { return failure_; }
  int iterations() const { return iterations_; }
  double work() const { return body_.work(); }

 private:
  void add_loads() {
    const TetMesh& mesh = experiment_.mesh;
    const auto add_scaled = [&](std::unique_ptr<Energy> load) {
      auto scaled = std::make_unique<ScaledLoad>(std::move(load));
      scaled_.push_back(scaled.get());
      energies_.push_back(std::move(scaled));
    };
    if (dot(load_.gravity, load_.gravity) > 0) {
      std::vector<double> weight(x_.size());
      for (int t = 0; t < mesh.tet_count(); ++t)
        add_body_force(mesh, t, experiment_.density[t] * load_.gravity, weight);
      add_scaled(make_linear_load("gravity", std::move(weight)));
    }
    if (load_.pressure != 0) add_scaled(make_pressure(mesh, load_.pressed, load_.pressure));
    if (load_.tip) {
      auto probe = make_probe(mesh, boundary_triangles(mesh, 0, mesh.tet_count()), *load_.tip, load_.touch);
      probe_ = probe.get();
      energies_.push_back(std::move(probe));
    }
  }

  // Forces that do not balance; `size`: the largest that have acted so far.
  std::vector<double> residual(std::span<const double> x, double& size) const {
    std::vector<double> load(x.size(), 0.0), inner(x.size(), 0.0);
    for (const auto& energy : energies_) energy->add_gradient(x, 1, load);
    body_.add_gradient(x, inner);
    clear_held(load);
    clear_held(inner);
    size = std::fmax(size, std::fmax(norm(load), norm(inner)));
    for (size_t i = 0; i < x.size(); ++i) inner[i] += load[i];
    return inner;
  }
  void clear_held(std::vector<double>& g) const {
    for (size_t v = 0; v < held_.size(); ++v)
      if (held_[v]) g[3 * v] = g[3 * v + 1] = g[3 * v + 2] = 0;
  }

  bool balance() {
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

  bool factorize() {
    if (!matrix_) matrix_ = std::make_unique<BlockSparse>(pattern_);
    matrix_->set_zero();
    body_.add_stiffness(x_, *matrix_);
    for (const auto& energy : energies_) energy->add_hessian(x_, 1, {.kind = Definiteness::clamped}, *matrix_);
    for (int r = 0; r < pattern_.rows(); ++r)
      for (int64_t s = pattern_.row_start[r]; s < pattern_.row_start[r + 1]; ++s)
        if (held_[r] || held_[pattern_.column[s]])
          matrix_->block[s] = s == pattern_.diagonal(r) ? identity3<double>() : Mat3d{};
    return solver_->factorize(*matrix_);
  }

  const Experiment& experiment_;
  const LoadCase& load_;
  const BickelOptions& options_;
  IncrementalElasticity body_;
  std::vector<std::unique_ptr<Energy>> energies_;
  std::vector<ScaledLoad*> scaled_;
  Probe* probe_ = nullptr;
  BlockPattern pattern_;
  std::unique_ptr<BlockSparse> matrix_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> x_;
  std::vector<bool> held_;
  std::string failure_;
  int iterations_ = 0;
  double force_size_ = 0;
};

// How far two pokes are apart: where they touch, and by how much they go in.
double apart(const LoadCase& a, const LoadCase& b) {
  const Vec3d touch = a.touch.center - b.touch.center;
  const Vec3d way = (a.pose.center - a.touch.center) - (b.pose.center - b.touch.center);
  const Vec3d gravity = a.gravity - b.gravity;
  return std::sqrt(dot(touch, touch) + dot(way, way)) + std::sqrt(dot(gravity, gravity)) +
         std::abs(a.pressure - b.pressure);
}

std::vector<MaterialParameters> parameters_of(const StrainExample& example) {
  std::vector<MaterialParameters> parameters;
  for (size_t t = 0; t < example.young.size(); ++t)
    parameters.push_back({lame_from_young_poisson(example.young[t], example.poisson[t]), {}});
  return parameters;
}

struct Examples {
  std::vector<StrainExample> list;
  std::vector<int> cases;  // of the training
  std::string failure;
};
Examples explain_all(const Experiment& training, const BickelOptions& options) {
  Examples examples;
  for (int c = 0; c < static_cast<int>(training.cases.size()); ++c) {
    ExplainedCase explained = explain(training, c, options);
    if (explained.ok) {
      examples.list.push_back(std::move(explained.example));
      examples.cases.push_back(c);
    } else {
      examples.failure += (examples.failure.empty() ? "" : "; ") + explained.failure;
    }
  }
  return examples;
}

// One case with a given linear material.
bool predict_linear(const Experiment& experiment, const LoadCase& load, const std::vector<MaterialParameters>& known,
                    const BickelOptions& options, CasePrediction& prediction, std::string& failure) {
  const Experiment one = only(experiment, load);
  LoadedBody body(one, one.cases.front(), kLinear, known, options.equilibrium);
  if (!body.solve(known, {})) {
    failure = body.failure();
    return false;
  }
  prediction = body.prediction();
  return true;
}

}  // namespace

std::string_view name(Baseline baseline) {
  constexpr std::array<std::string_view, 4> kNames = {"one modulus", "per-example linear", "bickel", "bickel, total"};
  return kNames[static_cast<size_t>(baseline)];
}

ExplainedCase explain(const Experiment& experiment, int load_case, const BickelOptions& options) {
  const LoadCase& load = experiment.cases[load_case];
  LinearFit linear = fit_linear(only(experiment, load), options.spread, options);
  ExplainedCase explained{.ok = linear.ok, .failure = linear.failure, .example = {}, .report = linear.report};
  explained.example.name = load.name;
  for (const MaterialParameters& p : linear.parameters) {
    explained.example.young.push_back(young_modulus(p.lame));
    explained.example.poisson.push_back(poisson_ratio(p.lame));
  }
  explained.example.x = std::move(linear.x);
  return explained;
}

BickelPrediction simulate(const Experiment& experiment, const LoadCase& load, const StrainSpaceModuli& moduli,
                          const BickelOptions& options, Path path) {
  ASPIC_CHECK(moduli.tet_count() == experiment.mesh.tet_count() && options.increments > 0);
  IncrementalBody body(experiment, load, moduli, options);
  BickelPrediction result;
  result.ok = true;
  const int n = options.increments, steps = path == Path::load ? n : 2 * n;
  for (int k = 1; k <= steps && result.ok; ++k) result.ok = body.go_to(static_cast<double>(k <= n ? k : 2 * n - k) / n);
  result.failure = body.failure();
  result.prediction = body.prediction();
  result.iterations = body.iterations();
  result.work = body.work();
  return result;
}

HeldOut predict(Baseline baseline, const Experiment& training, const Experiment& left_out,
                const BickelOptions& options) {
  HeldOut failed{.group = left_out.cases.empty() ? "" : left_out.cases.front().group};
  std::vector<CasePrediction> predictions(left_out.cases.size());
  const auto fails = [&](const std::string& why) {
    failed.failure = why;
    return failed;
  };
  if (baseline == Baseline::homogeneous) {
    const LinearFit linear = fit_linear(training, Spread::uniform, options);
    if (!linear.ok) return fails(linear.failure);
    for (size_t c = 0; c < predictions.size(); ++c)
      if (!predict_linear(left_out, left_out.cases[c], linear.parameters, options, predictions[c], failed.failure))
        return failed;
    return compare(left_out, predictions);
  }
  const Examples examples = explain_all(training, options);
  if (examples.list.empty()) return fails(examples.failure);
  if (baseline == Baseline::bickel || baseline == Baseline::bickel_total) {
    BickelOptions simulated = options;
    simulated.rule = baseline == Baseline::bickel ? StressRule::incremental : StressRule::total;
    const StrainSpaceModuli moduli(training.mesh, examples.list);
    for (size_t c = 0; c < predictions.size(); ++c) {
      BickelPrediction result = simulate(left_out, left_out.cases[c], moduli, simulated);
      if (!result.ok) return fails(result.failure);
      predictions[c] = std::move(result.prediction);
    }
    return compare(left_out, predictions);
  }
  for (size_t c = 0; c < predictions.size(); ++c) {
    size_t nearest = 0;
    for (size_t i = 1; i < examples.list.size(); ++i)
      if (apart(training.cases[examples.cases[i]], left_out.cases[c]) <
          apart(training.cases[examples.cases[nearest]], left_out.cases[c]))
        nearest = i;
    if (!predict_linear(left_out, left_out.cases[c], parameters_of(examples.list[nearest]), options, predictions[c],
                        failed.failure))
      return failed;
  }
  return compare(left_out, predictions);
}

}  // namespace aspic
