#include "fit/bickel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/check.h"
#include "fit/incremental_body.h"
#include "fit/load_case.h"

namespace aspic {
namespace {

constexpr char kLinear[] = "corotated";

ParameterMap linear_map(const TetMesh& mesh, Parameterization parameterization, const BickelOptions& options) {
  std::vector<FitParameter> parameters = {{"young", parameterization, options.handles, options.young}};
  if (options.fits_poisson) parameters.push_back({"poisson", Parameterization::uniform, 0, options.poisson});
  const MaterialParameters known{lame_from_young_poisson(options.young, options.poisson), {}};
  return ParameterMap(mesh, kLinear, std::vector<MaterialParameters>(mesh.tets.size(), known), std::move(parameters));
}

struct LinearFit {
  bool ok = false;
  std::string failure;
  FitReport report;
  std::vector<MaterialParameters> parameters;
  std::vector<double> x;  // positions of the first case
};

LinearFit fit_linear(const Experiment& experiment, Parameterization parameterization, const BickelOptions& options) {
  const ParameterMap map = linear_map(experiment.mesh, parameterization, options);
  Misfit misfit(experiment, map, options.equilibrium);
  const auto prior = make_regularizer(experiment.mesh, map, options.prior);
  LinearFit done;
  done.report = fit(misfit, *prior, map.guess(), options.fit);
  std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
  if (done.report.p.empty() || !misfit.evaluate(done.report.p, r)) {
    done.failure = experiment.cases.front().name + ": no linear material fits it: " +
                   (misfit.failure().empty() ? done.report.message : misfit.failure());
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

// Distance of two indentations: difference of touch and of displacement.
double apart(const LoadCase& a, const LoadCase& b) {
  const Vec3d touch = a.touch.center - b.touch.center;
  const Vec3d way = (a.pose.center - a.touch.center) - (b.pose.center - b.touch.center);
  const Vec3d gravity = a.gravity - b.gravity;
  return std::sqrt(dot(touch, touch) + dot(way, way)) + norm(gravity) + std::abs(a.pressure - b.pressure);
}

std::vector<MaterialParameters> parameters_of(const StrainExample& example) {
  std::vector<MaterialParameters> parameters;
  for (size_t t = 0; t < example.young.size(); ++t)
    parameters.push_back({lame_from_young_poisson(example.young[t], example.poisson[t]), {}});
  return parameters;
}

struct Examples {
  std::vector<StrainExample> list;
  std::vector<int> cases;  // training cases
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
std::optional<CasePrediction> predict_linear(const Experiment& experiment, const LoadCase& load,
                                             const std::vector<MaterialParameters>& known, const BickelOptions& options,
                                             std::string& failure) {
  const Experiment one = only(experiment, load);
  LoadedBody body(one, one.cases.front(), kLinear, known, options.equilibrium);
  if (body.solve(known, {})) return body.prediction();
  failure = body.failure();
  return std::nullopt;
}

}  // namespace

std::string_view name(Baseline baseline) {
  constexpr std::array<std::string_view, 4> kNames = {"one modulus", "per-example linear", "bickel", "bickel, total"};
  return kNames[static_cast<size_t>(baseline)];
}

ExplainedCase explain(const Experiment& experiment, int load_case, const BickelOptions& options) {
  const LoadCase& load = experiment.cases[load_case];
  LinearFit linear = fit_linear(only(experiment, load), options.parameterization, options);
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
  BickelPrediction result;
  if (load.grip) {
    result.failure = load.name + ": the increments of this model have no grips";
    return result;
  }
  IncrementalBody body(experiment, load, moduli, options);
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
  const auto predict_case = [&](size_t c, const std::vector<MaterialParameters>& known) {
    auto prediction = predict_linear(left_out, left_out.cases[c], known, options, failed.failure);
    if (prediction) predictions[c] = std::move(*prediction);
    return prediction.has_value();
  };
  if (baseline == Baseline::homogeneous) {
    const LinearFit linear = fit_linear(training, Parameterization::uniform, options);
    if (!linear.ok) return fails(linear.failure);
    for (size_t c = 0; c < predictions.size(); ++c)
      if (!predict_case(c, linear.parameters)) return failed;
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
    if (!predict_case(c, parameters_of(examples.list[nearest]))) return failed;
  }
  return compare(left_out, predictions);
}

}  // namespace aspic
