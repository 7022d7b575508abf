// Branches fitted to closed forms of a bar of a generalized Maxwell solid. With Poisson's ratio 0 a bar is uniaxial:
// a branch has Young's modulus 2 G, as its Poisson's ratio is 0 too, so that the relaxation modulus is
//   E(t) = E (1 + sum of ratio_i exp(-t / tau_i)),   G = E / 2.
#include "estimate/relaxation_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mesh/generators.h"
#include "mesh/surface.h"
#include "model/history_misfit.h"
#include "model/indented_block_test.h"

namespace aspic {
namespace {

constexpr double kYoung = 2e4, kLength = 0.04, kSide = 0.01, kStrain = 1e-4, kRamp = 0.5;

struct RelaxingBar {
  Experiment body;
  ViscoelasticMaterial material{"neo_hookean", {}, {}};
};

// Between slippery ends: the lower end is held where it stays by symmetry.
RelaxingBar bar() {
  RelaxingBar b;
  b.body.mesh = make_box({{0, 0, 0}}, {{kSide, kSide, kLength}}, {1, 1, 2});
  b.body.density.assign(b.body.mesh.tets.size(), 1000);
  for (int v = 0; v < b.body.mesh.vertex_count(); ++v)
    if (b.body.mesh.rest[v][2] < 1e-9) b.body.fixed.push_back(v);
  MaterialParameters m;
  m.lame = lame_from_young_poisson(kYoung, 0);
  b.material.parameters.assign(b.body.mesh.tets.size(), m);
  return b;
}

LoadCase stretched(const RelaxingBar& b, double strain) {
  LoadCase c{.name = "stretch"};
  Grip grip;
  for (int v = 0; v < b.body.mesh.vertex_count(); ++v)
    if (b.body.mesh.rest[v][2] > kLength - 1e-9) grip.vertices.push_back(v);
  grip.center = {{kSide / 2, kSide / 2, kLength}};
  grip.radius = kSide;
  grip.displacement = {{0, 0, strain * kLength}};
  c.grip = grip;
  return c;
}

// Force after a ramp to kStrain in kRamp seconds: rate times the integral of E(t) over the time since each increment.
double force_at(double t, const std::vector<RelaxationBranch>& branches) {
  const double rate = kStrain / kRamp, from = std::max(t - kRamp, 0.0);
  double sum = t - from;
  for (const RelaxationBranch& b : branches)
    sum += b.ratio * b.time * (std::exp(-from / b.time) - std::exp(-t / b.time));
  return kSide * kSide * kYoung * rate * sum;
}

LoadHistory ramp_and_hold(const RelaxingBar& b, const std::vector<RelaxationBranch>& branches, double noise,
                          unsigned seed) {
  LoadHistory history{.name = "hold", .times = {0, kRamp, 200}};
  history.waypoints = {stretched(b, 0), stretched(b, kStrain), stretched(b, kStrain)};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const double peak = force_at(kRamp, branches), sigma = std::max(noise, 1e-4) * peak;
  const auto add = [&](double t) {
    const double value = force_at(t, branches) + (noise > 0 ? sigma * normal(random) : 0);
    history.forces.push_back({t, {{0, 0, 1}}, value, sigma});
  };
  for (int i = 1; i <= 5; ++i) add(kRamp * i / 5);
  for (double wait = 0.05; wait < 199; wait *= 1.25) add(kRamp + wait);
  return history;
}

const std::vector<RelaxationBranch> kOne = {{0.6, 4}}, kTwo = {{0.5, 1.5}, {0.8, 30}};

TEST(LoadHistory, MatchesRampAndHoldOfMaxwellSolid) {
  const RelaxingBar b = bar();
  const LoadHistory history = ramp_and_hold(b, kTwo, 0, 1);
  ViscoelasticMaterial material = b.material;
  material.branches = kTwo;
  const HistoryPrediction prediction = simulate(b.body, history, material, {});
  ASSERT_TRUE(prediction.is_ok()) << prediction.failure;
  ASSERT_EQ(prediction.forces.size(), history.forces.size());
  for (size_t i = 0; i < history.forces.size(); ++i)
    EXPECT_NEAR(prediction.forces[i] / history.forces[i].value, 1, 5e-4) << history.forces[i].time;
}

// A step of the load: the strain is the load over E times the creep function of a standard linear solid,
//   1 - ratio / (1 + ratio) exp(-t / (tau (1 + ratio))).
TEST(LoadHistory, MatchesCreepOfStandardLinearSolid) {
  RelaxingBar b = bar();
  LoadHistory history{.name = "creep", .times = {0}};
  LoadCase load{.name = "weight"};
  const double pull = kStrain * kYoung;
  load.pressure = -pull;
  load.is_dead_pressure = true;
  const TetMesh& mesh = b.body.mesh;
  for (const Triangle& t : boundary_triangles(mesh, 0, mesh.tet_count()))
    if (std::all_of(t.begin(), t.end(), [&](int v) { return mesh.rest[v][2] > kLength - 1e-9; }))
      load.pressed.push_back(t);
  b.body.markers.push_back({load.pressed.front(), {1, 0, 0}});
  const Vec3d rest = mesh.rest[load.pressed.front()[0]];
  load.positions = {{0, rest, {{1e-6, 1e-6, 1e-6}}}};
  history.waypoints.push_back(load);
  for (int i = 1; i <= 80; ++i) history.times.push_back(0.25 * i), history.waypoints.push_back(load);
  ViscoelasticMaterial material = b.material;
  material.branches = kOne;
  const HistoryPrediction prediction = simulate(b.body, history, material, {});
  ASSERT_TRUE(prediction.is_ok()) << prediction.failure;
  ASSERT_EQ(prediction.markers.size(), history.times.size());
  const double ratio = kOne[0].ratio, tau = kOne[0].time * (1 + ratio);
  for (size_t i = 0; i < history.times.size(); ++i) {
    const double creep = kStrain * (1 - ratio / (1 + ratio) * std::exp(-history.times[i] / tau));
    EXPECT_NEAR((prediction.markers[i][2] - kLength) / kLength / creep, 1, 1e-3) << history.times[i];
  }
}

// After a long hold the branches carry no stress: the body is that of a static case with the same indenter.
TEST(LoadHistory, LongHoldOfIndenterEndsLikeStatics) {
  test::IndentedBlock block;
  block.add_indentation(test::IndentedBlock::sites()[0], 0.006, 0.01);
  const ParameterMap map = block.map();
  Misfit statics(block.experiment, map);
  std::vector<double> r(statics.residual_count());
  ASSERT_TRUE(statics.evaluate(map.guess(), r));
  const LoadCase& pressed = block.experiment.cases[0];
  LoadCase touching = pressed;
  touching.pose = touching.touch;
  touching.positions.clear();
  LoadHistory history{.name = "poke", .times = {0, 1, 1000}, .waypoints = {touching, touching, pressed}};
  history.waypoints[1] = pressed;
  history.waypoints[1].positions.clear();
  for (const double t : {0.5, 1.0, 2.0, 1000.0}) history.forces.push_back({t, {{0, 0, 1}}, 0, 1});
  const ViscoelasticMaterial material{map.material(), map.parameters(map.guess()), {{1.0, 3.0}}};
  const HistoryPrediction prediction = simulate(block.experiment, history, material, {});
  ASSERT_TRUE(prediction.is_ok()) << prediction.failure;
  const CasePrediction& expected = statics.prediction(0);
  EXPECT_NEAR(prediction.forces.back(), expected.wrench.force[2], 1e-4 * norm(expected.wrench.force));
  EXPECT_GT(std::abs(prediction.forces[1]), 1.3 * std::abs(prediction.forces.back()));
  ASSERT_EQ(prediction.markers.size(), expected.markers.size());
  for (size_t m = 0; m < expected.markers.size(); ++m)
    EXPECT_LT(norm(prediction.markers[m] - expected.markers[m]), 1e-4 * 0.006);
}

// Loads beyond one Newton solve are divided; the path has no effect on a body without branches.
TEST(LoadHistory, SuddenLoadIsDividedUntilItConverges) {
  const RelaxingBar b = bar();
  LoadHistory history{.name = "pull", .times = {0, 1}, .waypoints = {stretched(b, 1.5), stretched(b, 1.5)}};
  history.forces.push_back({0.5, {{0, 0, 1}}, 0, 1});
  const HistoryPrediction sudden = simulate(b.body, history, b.material, {});
  ASSERT_TRUE(sudden.is_ok()) << sudden.failure;
  history.waypoints[0] = stretched(b, 0);
  history.times = {0, 10, 11};
  history.waypoints.push_back(history.waypoints.back());
  history.forces[0].time = 10.5;
  const HistoryPrediction slow = simulate(b.body, history, b.material, {});
  ASSERT_TRUE(slow.is_ok()) << slow.failure;
  EXPECT_NEAR(sudden.forces[0] / slow.forces[0], 1, 1e-6);
}

TEST(LoadHistory, CollapsedGripHasNoEquilibrium) {
  const RelaxingBar b = bar();
  LoadHistory history{.name = "crush", .times = {0, 1}, .waypoints = {stretched(b, 0), stretched(b, -1.5)}};
  history.forces.push_back({1, {{0, 0, 1}}, 0, 1});
  const HistoryPrediction prediction = simulate(b.body, history, b.material, {});
  EXPECT_FALSE(prediction.is_ok());
  EXPECT_NE(prediction.failure.find("crush: no equilibrium"), std::string::npos);
}

TEST(HistoryMisfit, JacobianMatchesCentralDifferences) {
  const RelaxingBar b = bar();
  const std::vector<LoadHistory> histories = {ramp_and_hold(b, kTwo, 0, 1)};
  const EquilibriumOptions options;
  HistoryMisfit misfit(b.body, histories, b.material, 2, options);
  const std::vector<double> p = {0.1, -0.5, 0.3, -0.2, 3}, dp = {1, -0.4, 0.8, 0.3, -0.6};
  std::vector<double> r(misfit.residual_count()), up = r, down = r, dr = r;
  constexpr double kStep = 1e-3;
  std::vector<double> at = p;
  for (size_t i = 0; i < p.size(); ++i) at[i] = p[i] + kStep * dp[i];
  ASSERT_TRUE(misfit.evaluate(at, up));
  for (size_t i = 0; i < p.size(); ++i) at[i] = p[i] - kStep * dp[i];
  ASSERT_TRUE(misfit.evaluate(at, down));
  ASSERT_TRUE(misfit.evaluate(p, r) && misfit.linearize());
  misfit.multiply(dp, dr);
  for (size_t i = 0; i < r.size(); ++i) EXPECT_NEAR(dr[i], (up[i] - down[i]) / (2 * kStep), 1e-3 * std::abs(r[i]) + 2);
}

TEST(RelaxationFit, FindsTwoBranchesAndTheirNumber) {
  const RelaxingBar b = bar();
  const RelaxationFit fit = fit_relaxation(b.body, {ramp_and_hold(b, kTwo, 0.003, 1)}, b.material, {});
  ASSERT_TRUE(fit.is_ok()) << fit.failure;
  ASSERT_EQ(fit.branches.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(fit.branches[i].ratio / kTwo[i].ratio, 1, 0.03);
    EXPECT_NEAR(fit.branches[i].time / kTwo[i].time, 1, 0.05);
  }
  EXPECT_NEAR(fit.scale, 1, 0.01);
  EXPECT_NEAR(fit.branches[0].fraction, 0.5 / 2.3, 0.01);
}

TEST(RelaxationFit, OneBranchIsEnoughForOne) {
  const RelaxingBar b = bar();
  const RelaxationFit fit = fit_relaxation(b.body, {ramp_and_hold(b, kOne, 0.003, 2)}, b.material, {});
  ASSERT_TRUE(fit.is_ok()) << fit.failure;
  ASSERT_EQ(fit.branches.size(), 1u);
  EXPECT_NEAR(fit.branches[0].time / kOne[0].time, 1, 0.03);
}

// 40 data sets with other noise: values within 3 %, and intervals that contain the truth in about 95 %.
TEST(RelaxationFit, IntervalsCoverTheTruth) {
  const RelaxingBar b = bar();
  int inside = 0, total = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const RelaxationFit fit =
        fit_relaxation(b.body, {ramp_and_hold(b, kOne, 0.003, 100 + seed)}, b.material, {.branches = 1});
    ASSERT_TRUE(fit.is_ok()) << fit.failure;
    const FittedBranch& found = fit.branches[0];
    const auto count = [&](const Interval& interval, double truth) {
      inside += interval.lower < truth && truth < interval.upper;
      ++total;
    };
    count(found.ratio_interval, kOne[0].ratio);
    count(found.time_interval, kOne[0].time);
    count(fit.scale_interval, 1);
    EXPECT_NEAR(found.ratio / kOne[0].ratio, 1, 0.03);
    EXPECT_NEAR(found.time / kOne[0].time, 1, 0.03);
  }
  RecordProperty("inside", inside);
  EXPECT_GT(inside, 0.88 * total) << total;
  EXPECT_LT(inside, total);
}

}  // namespace
}  // namespace aspic
