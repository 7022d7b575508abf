#include "estimate/motion_fit.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "dynamics/model_builder.h"
#include "mesh/generators.h"
#include "model/taylor_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;

// A beam of unlike tets, held at one end or free, with all kinds of damping.
MotionModel beam(bool is_held = true, const Vec3d& gravity = {{1, -9.81, 0}}) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{0.8, 0.2, 0.2}}, {4, 1, 1});
  std::vector<MaterialParameters> material;
  std::vector<double> density, viscosity;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    material.push_back({lame_from_young_poisson(4e4 * (1 + 0.3 * std::sin(t)), 0.35), {}});
    density.push_back(1000 * (1 + 0.2 * std::cos(t)));
    viscosity.push_back(40 + 20 * std::sin(2.0 * t));
  }
  ModelBuilder builder = ModelBuilder(mesh);
  builder.material("neo_hookean", material).density(density).gravity(gravity);
  if (is_held) builder.pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; });
  MotionModel model{.model = builder.build(),
                    .start = at_rest(mesh),
                    .mass_damping = 1.5,
                    .stiffness_damping = 2e-3,
                    .viscosity = viscosity,
                    .velocity = {{0.2, 0.5, -0.3}},
                    .angular_velocity = {{0.5, -0.4, 1}}};
  for (size_t i = 0; i < model.start.qdot.size(); ++i) model.start.qdot[i] = model.velocity[static_cast<int>(i % 3)];
  return model;
}

TrajectoryOptions steps_of(double h) { return {.h = h, .tolerance = 1e-13, .adjoint_tolerance = 1e-13}; }

// Three markers that follow an arbitrary path, partly between time steps of 0.02 s.
MotionData some_data(const MotionModel& model) {
  MotionData data;
  const int last = model.model.mesh.vertex_count() - 1;
  data.markers = {{{last, last - 1, last - 2}, {0.2, 0.3, 0.5}},
                  {{last - 3, last - 1, last}, {1, 0, 0}},
                  {{last - 2, last - 3, last - 4}, {0.5, 0, 0.5}}};
  data.offset = {{{0, 0, 0.01}}, {}, {}};
  for (int k = 1; k <= 9; ++k)
    for (int m = 0; m < 3; ++m)
      data.samples.push_back({m, 0.017 * k, {{0.8 + 0.01 * k, 0.1 - 0.02 * k, 0.1 * m}}, 0.01 + 0.01 * m});
  data.has_sigma = true;
  return data;
}

// Marker positions of the motion with the parameters p.
MotionData observed(MotionObjective& objective, std::span<const double> p) {
  MotionData data = objective.data();
  const MotionPoint point = objective.simulate(p);
  EXPECT_TRUE(point.ok) << point.message;
  for (size_t s = 0; s < data.samples.size(); ++s) data.samples[s].position = point.simulated[s];
  data.has_sigma = false;
  for (MotionSample& sample : data.samples) sample.sigma = 1;
  return data;
}

MotionObjective objective_of(const std::vector<std::string>& names, MotionData data, MotionModel model) {
  return {std::move(model), std::move(data), names, steps_of(0.02)};
}

TEST(MotionFit, GradientHasTaylorSlope2ForEveryParameter) {
  std::vector<std::string> names = MotionParameters::names();
  MotionModel model = beam();
  const MotionData data = some_data(model);
  MotionObjective f = objective_of(names, data, std::move(model));
  std::vector<double> at(f.parameters().size(), 0.1);
  const MotionPoint point = f.differentiate(at);
  ASSERT_TRUE(point.ok) << point.message;
  EXPECT_EQ(point.value, f.simulate(at).value);
  for (int i = 0; i < f.parameters().size(); ++i) {
    const std::string& name = f.parameters().parameters()[i].name;
    taylor::expect_slope_2(
        [&](double eps) {
          std::vector<double> p = at;
          p[i] += eps;
          return std::vector<double>{f.simulate(p).value};
        },
        {point.gradient[i]}, name == "young" || name == "density" ? 0.01 : 0.1, name, 3);
  }
}

TEST(MotionFit, SlopeOfValueAgreesWithDifferences) {
  MotionModel model = beam();
  const MotionData data = some_data(model);
  const MotionObjective f = objective_of(MotionParameters::names(), data, std::move(model));
  for (int i = 0; i < f.parameters().size(); ++i)
    EXPECT_NEAR((f.parameters().value(i, 0.3 + 1e-5) - f.parameters().value(i, 0.3 - 1e-5)) / 2e-5,
                f.parameters().slope(i, 0.3), 1e-8 * std::abs(f.parameters().slope(i, 0.3)));
}

TEST(MotionFit, RecoversParametersFromSyntheticMotion) {
  const std::vector<std::string> names = {"young", "mass_damping", "velocity"};
  MotionModel model = beam();
  MotionObjective truth = objective_of(names, some_data(model), beam());
  const std::vector<double> p = {0.4, -0.5, 0.02, -0.03, 0.01};
  MotionObjective f = objective_of(names, observed(truth, p), beam());
  const MotionFitReport report = fit_motion(f, {});
  EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
  EXPECT_LT(report.after.rms, 1e-8);
  for (int i = 0; i < f.parameters().size(); ++i) {
    const double expected = truth.parameters().value(i, p[i]);
    EXPECT_NEAR(report.values[i].value, expected, 1e-5 * std::abs(expected)) << report.values[i].parameter.name;
    EXPECT_LT(report.values[i].sigma, 1e-4 * std::abs(expected));
  }
}

TEST(MotionFit, StandardDeviationsScaleWithTheNoise) {
  const std::vector<std::string> names = {"young", "mass_damping"};
  MotionModel model = beam();
  MotionObjective truth = objective_of(names, some_data(model), beam());
  const MotionData exact = observed(truth, std::vector<double>{0.3, 0.2});
  const auto fitted = [&](double scatter, double sigma) {
    MotionData data = exact;
    taylor::Numbers noise(3);
    for (MotionSample& sample : data.samples) {
      const std::vector<double> e = noise(3);
      sample.sigma = sigma;
      for (int axis = 0; axis < 3; ++axis) sample.position[axis] += std::sqrt(3.0) * scatter * e[axis];
    }
    data.has_sigma = true;
    MotionObjective f = objective_of(names, data, beam());
    const MotionFitReport report = fit_motion(f, {});
    EXPECT_NEAR(report.chi_squared, std::pow(scatter / sigma, 2), 0.4 * std::pow(scatter / sigma, 2));
    EXPECT_LT(std::abs(report.values[0].value - truth.parameters().value(0, 0.3)), 4 * report.values[0].sigma);
    return report.values[0].sigma;
  };
  const double sigma = fitted(1e-4, 1e-4);
  EXPECT_NEAR(fitted(2e-4, 2e-4), 2 * sigma, 0.05 * sigma);
  EXPECT_NEAR(fitted(1e-4, 1e-5), sigma, 0.3 * sigma);  // residuals exceed the stated sigma
}

TEST(MotionFit, UndeterminedParametersHaveNoSigma) {
  const auto fitted = [](const std::vector<std::string>& names, bool is_held) {
    const auto undamped = [=] {
      MotionModel model = beam(is_held);
      model.stiffness_damping = 0, model.mass_damping = 0, model.angular_velocity = {}, model.viscosity.clear();
      return model;
    };
    MotionObjective truth = objective_of(names, some_data(undamped()), undamped());
    std::vector<double> p(truth.parameters().size(), 0.1);
    MotionObjective f = objective_of(names, observed(truth, p), undamped());
    return fit_motion(f, {});
  };
  const MotionFitReport flight = fitted({"young", "density", "velocity"}, false);
  for (const int i : {0, 1}) {
    EXPECT_EQ(flight.values[i].sigma, INFINITY);
    EXPECT_THAT(flight.values[i].message, HasSubstr("does not depend"));
    EXPECT_NEAR(flight.values[i].value, flight.values[i].parameter.guess, 1e-3 * flight.values[i].parameter.guess);
  }
  EXPECT_LT(flight.values[2].sigma, 1e-4);
  const MotionFitReport beside = fitted({"young", "density"}, true);  // only their ratio matters
  for (const int i : {0, 1}) {
    EXPECT_EQ(beside.values[i].sigma, INFINITY);
    EXPECT_THAT(beside.values[i].message, HasSubstr("together"));
  }
}

TEST(MotionFit, IsBitReproducibleForAnyNumberOfThreads) {
  MotionModel model = beam();
  const MotionData data = some_data(model);
  std::vector<std::vector<double>> found;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    MotionObjective f = objective_of({"young", "velocity"}, data, beam());
    found.push_back(fit_motion(f, {.max_iterations = 5}).p);
  }
  set_thread_count(0);
  EXPECT_EQ(found[0], found[1]);
}

TEST(MotionFit, StopsOnRequestWithBestParameters) {
  MotionModel model = beam();
  const MotionData data = some_data(model);
  TrajectoryOptions options = steps_of(0.02);
  int polls = 0;
  options.stop = StopToken([&] { return ++polls > 400; });
  MotionObjective f(std::move(model), data, {"young", "mass_damping"}, options);
  const MotionFitReport report = fit_motion(f, {});
  EXPECT_TRUE(report.stopped);
  EXPECT_TRUE(report.before.ok);
  EXPECT_LE(report.after.value, report.before.value);
  EXPECT_EQ(report.values[0].sigma, INFINITY);
}

TEST(MotionFit, FailedSimulationOfGuessIsReported) {
  MotionModel model = beam();
  const MotionData data = some_data(model);
  TrajectoryOptions options = steps_of(0.02);
  options.max_iterations = 1;
  MotionObjective f(std::move(model), data, {"young"}, options);
  const MotionFitReport report = fit_motion(f, {});
  EXPECT_EQ(report.status, Status::undefined);
  EXPECT_THAT(report.message, HasSubstr("did not converge"));
}

TEST(MotionFit, RefusesQuantitiesThatCannotBeFitted) {
  const auto refused = [](const std::vector<std::string>& names, const std::string& expected) {
    MotionModel model = beam();
    const MotionData data = some_data(model);
    try {
      objective_of(names, data, std::move(model));
      FAIL() << expected;
    } catch (const InvalidInput& e) {
      EXPECT_THAT(e.what(), HasSubstr(expected));
    }
  };
  refused({}, "no parameter");
  refused({"yuong"}, "did you mean 'young'");
  refused({"young", "young"}, "twice");
}

}  // namespace
}  // namespace aspic
