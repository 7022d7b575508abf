#include "dynamics/velocity_form.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/models_test.h"
#include "optimize/newton.h"

namespace aspic {
namespace {

constexpr double kStep = 0.01;

// The first step of a beam that starts to fall with an initial velocity.
class Velocities : public ::testing::Test {
 protected:
  Velocities() : model(testing_models::beam(2)), state(at_rest(model.mesh)) {
    for (size_t i = 0; i < state.qdot.size(); ++i) state.qdot[i] = 0.3 * std::sin(static_cast<double>(i));
    pins.set_zero(state.qdot);
    for (size_t i = 0; i < state.q.size(); ++i) predicted.push_back(state.q[i] + kStep * state.qdot[i]);
    E.at({.predicted = predicted, .factor = kStep * kStep, .context = StepContext{state.q, kStep, kStep}});
  }

  Model model;
  State state;
  Pins pins{model.pins, state.q};
  IncrementalPotential E{model, pins};
  std::vector<double> predicted;
  VelocityForm form{E, state.q, kStep};
};

TEST_F(Velocities, ValueIsKineticPlusPotentialEnergy) {
  std::vector<double> v(state.q.size()), dv(v.size()), Mdv(v.size());
  for (size_t i = 0; i < v.size(); ++i) v[i] = 0.5 * std::cos(3.0 * static_cast<double>(i));
  for (size_t i = 0; i < v.size(); ++i) dv[i] = v[i] - state.qdot[i];
  model.mass->multiply(dv, Mdv);
  double expected = 0;
  for (size_t i = 0; i < v.size(); ++i) expected += dv[i] * Mdv[i] / 2;
  for (const ActiveTerm& V : E.terms().potential()) expected += V.value(form.position(v));
  EXPECT_NEAR(form.value(v), expected, 1e-12 * std::abs(expected));
}

TEST_F(Velocities, GradientAndHessianAreDerivatives) {
  const size_t n = state.q.size();
  std::vector<double> v = state.qdot, d(n), g(n), ahead(n), behind(n), Hd(n);
  for (size_t i = 0; i < n; ++i) d[i] = std::sin(2.0 * static_cast<double>(i) + 1);
  pins.set_zero(d);
  form.gradient(v, g);
  form.hessian(v, {}).multiply(d, Hd);
  const double s = 1e-4;
  for (size_t i = 0; i < n; ++i) ahead[i] = v[i] + s * d[i], behind[i] = v[i] - s * d[i];
  const double slope = form.dot(g, d);
  EXPECT_NEAR((form.value(ahead) - form.value(behind)) / (2 * s), slope, 1e-7 * std::abs(slope));
  std::vector<double> g_ahead(n), g_behind(n);
  form.gradient(ahead, g_ahead);
  form.gradient(behind, g_behind);
  const double size = std::sqrt(form.dot(Hd, Hd));
  for (size_t i = 0; i < n; ++i) EXPECT_NEAR((g_ahead[i] - g_behind[i]) / (2 * s), Hd[i], 1e-6 * size);
}

TEST_F(Velocities, NewtonVisitsSamePointsAsInPositions) {
  const auto iterates = [&](Objective& objective, std::vector<double> x) {
    Newton newton(make_linear_solver("cholesky"));
    std::vector<std::vector<double>> visited;
    const MinimizeReport report = Minimizer().minimize(objective, newton, x, {}, [&](const LiveIteration& iteration) {
      visited.emplace_back(iteration.x_next.begin(), iteration.x_next.end());
    });
    EXPECT_TRUE(is_success(report.status));
    return visited;
  };
  const auto positions = iterates(E, state.q);
  const auto velocities = iterates(form, std::vector<double>(state.q.size(), 0.0));
  ASSERT_EQ(positions.size(), velocities.size());
  ASSERT_GT(positions.size(), 1u);
  for (size_t k = 0; k < positions.size(); ++k) {
    const auto q = form.position(velocities[k]);
    for (size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(q[i], positions[k][i], 1e-11);  // for a beam 4 m long
  }
}

}  // namespace
}  // namespace aspic
