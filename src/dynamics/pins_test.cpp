// Pins with directions: rollers and symmetry planes.
#include "dynamics/pins.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <tuple>

#include "base/parallel.h"
#include "dynamics/models_test.h"
#include "results/explanation.h"

namespace aspic {
namespace {

using namespace testing_models;

const Vec3d kX{{1, 0, 0}}, kY{{0, 1, 0}}, kZ{{0, 0, 1}};

// Rotates (1, 0, 0) to (2, 2, 1) / 3.
const Mat3d kTurn =
    from_columns<double>({{2. / 3, 2. / 3, 1. / 3}}, {{-2. / 3, 1. / 3, 2. / 3}}, {{1. / 3, -2. / 3, 2. / 3}});

std::vector<double> turned(const std::vector<double>& x) {
  std::vector<double> result;
  for (int v = 0; v < static_cast<int>(x.size() / 3); ++v) {
    const Vec3d y = kTurn * point(x, v);
    result.insert(result.end(), y.a, y.a + 3);
  }
  return result;
}

struct Turned {
  bool is_turned;
  Vec3d operator()(const Vec3d& v) const { return is_turned ? kTurn * v : v; }
};

// A bar with weight between three symmetry planes, with its right face pulled.
Model rolling_bar(const Turned& turn, const ModelOptions& options) {
  ModelOptions turned = options;
  turned.gravity = turn(options.gravity);
  TetMesh mesh = make_box({{0, 0, 0}}, {{2, 1, 1}}, {3, 2, 2});
  const auto at = [&](int axis, double c) {
    return vertices_where(mesh, [=](const Vec3d& X) { return std::abs(X[axis] - c) < 1e-9; });
  };
  const std::vector<int> left = at(0, 0), below = at(1, 0), back = at(2, 0), right = at(0, 2);
  for (Vec3d& X : mesh.rest) X = turn(X);
  Model model = make_model(std::move(mesh), turned);
  const Vec3d across = turn(kX);
  model.pins.push_back({"left", left, {}, {across}});
  model.pins.push_back({"below", below, {}, {turn(kY)}});
  model.pins.push_back({"back", back, {}, {turn(kZ)}});
  model.pins.push_back(
      {"right", right, [=](const Vec3d& X, double t) { return X + (2 * t * t) * across + t * turn(kZ); }, {across}});
  return model;
}

TEST(PinsOfDirections, FixOnlyTheirDirections) {
  const Vec3d n = kTurn * kX;
  const std::vector<Pin> pins = {{"plane", {1}, [](const Vec3d& X, double t) { return X + Vec3d{{t, 0, 0}}; }, {n}}};
  const std::vector<double> start = {0, 0, 0, 1, 2, 3};
  const Pins held(pins, start);
  std::vector<double> x = {5, 6, 7, 4, -1, 2};
  const Vec3d before = point(x, 1);
  held.place(0.3, x);
  EXPECT_EQ(x[0], 5);
  EXPECT_NEAR(dot(n, point(x, 1) - point(start, 1)), 0.3 * n[0], 1e-14);
  EXPECT_LT(norm(held.free_part(1, point(x, 1) - before)), 1e-14);
  std::vector<double> v = {1, 2, 3, 4, 5, 6};
  held.set_zero(v);
  EXPECT_NEAR(dot(n, point(v, 1)), 0, 1e-14);
  EXPECT_EQ(v[2], 3);
}

TEST(PinsOfDirections, AlongAxesAreExact) {
  const std::vector<Pin> pins = {{"roller", {0}, {}, {kY, kZ}}};
  const Pins held(pins, std::vector<double>{0.1, 0.2, 0.3});
  std::vector<double> x = {7, 8, 9};
  held.place(0, x);
  EXPECT_EQ(x, (std::vector<double>{7, 0.2, 0.3}));
  EXPECT_TRUE(held.holds(0, 1) && !held.holds(0, 0));
}

TEST(PinsOfDirections, CombineOnObliquePlanes) {
  const Vec3d m{{0.6, 0.8, 0}};
  const auto along = [](const Vec3d& n, double size) { return [=](const Vec3d& X, double) { return X + size * n; }; };
  const std::vector<Pin> pins = {{"a", {0}, along(kX, 0.5), {kX}}, {"b", {0}, along(m, -0.25), {m}}};
  const Pins held(pins, std::vector<double>{1, 1, 1});
  std::vector<double> x = {3, 4, 5};
  held.place(0, x);
  const Vec3d u = point(x, 0) - Vec3d{{1, 1, 1}};
  EXPECT_NEAR(dot(kX, u), 0.5, 1e-14);
  EXPECT_NEAR(dot(m, u), -0.25, 1e-14);
  EXPECT_EQ(x[2], 5);
  const Vec3d f{{1, 2, 3}}, a = held.reaction_of(0, 0, f), b = held.reaction_of(1, 0, f);
  EXPECT_LT(norm(cross(a, kX)) + norm(cross(b, m)), 1e-14) << "each must be along its own direction";
  EXPECT_LT(norm(a + b - held.held_part(0, f)), 1e-14) << "they must sum to the reaction";
}

TEST(PinsOfDirections, ShareVerticesIfTheyAgree) {
  const Vec3d m{{0.6, 0.8, 0}}, start{{1, 2, 3}};
  const Motion lift = [](const Vec3d& X, double t) { return X + Vec3d{{0, 0, t}}; };
  const std::vector<Pin> pins = {{"grip", {0, 1}, lift}, {"plane", {1, 2}, {}, {m}}, {"rail", {2}, lift, {kX, kY}}};
  EXPECT_LT(disagreement(std::vector{&pins[0], &pins[1]}, start, 0.5), 1e-15);
  const Motion turn = [](const Vec3d& X, double t) { return X + Vec3d{{t, t, t}}; };
  EXPECT_GT(disagreement(std::vector<const Pin*>{&pins[1], std::vector<Pin>{{"grip", {0}, turn}}.data()}, start, 0.5),
            0.1);
  const Pins held(pins, std::vector<double>{1, 2, 3, 1, 2, 3, 1, 2, 3});
  EXPECT_TRUE(held.holds(0) && held.holds(1) && !held.holds(2) && held.holds(2, 1) && !held.holds(2, 2));
  std::vector<double> x(9, 7.0);
  held.place(0.5, x);
  EXPECT_LT(norm(point(x, 0) - Vec3d{{1, 2, 3.5}}) + norm(point(x, 1) - Vec3d{{1, 2, 3.5}}), 1e-14);
  EXPECT_LT(norm(point(x, 2) - Vec3d{{1, 2, 7}}), 1e-14);
  const Vec3d f{{4, 5, 6}};
  EXPECT_LT(norm(held.reaction_of(0, 1, f) + held.reaction_of(1, 0, f) - f), 1e-14);
  EXPECT_EQ(norm(held.reaction_of(0, 0, f) - f), 0);
  EXPECT_LT(norm(held.reaction_of(1, 1, f) + held.reaction_of(2, 0, f) - Vec3d{{4, 5, 0}}), 1e-14);
}

// The solution of a rotated body with rotated planes and weight is the rotated solution.
TEST(PinsOfDirections, FollowMotionInEveryIntegrator) {
  for (const std::string& integrator : integrator_names()) {
    SimulationOptions options{.h = is_explicit(integrator) ? 2e-4 : 0.02, .integrator = integrator, .solver = {}};
    options.solver.minimize.tolerance = 1e-10;
    const ModelOptions body{.young = 1e4, .poisson = 0.3, .gravity = {{0, -3, 1}}};
    Simulation one = simulate(rolling_bar({false}, body), options),
               other = simulate(rolling_bar({true}, body), options);
    for (int i = 0; i < 5; ++i) {
      const StepReport a = one.step(), b = other.step();
      ASSERT_TRUE(is_success(a.status) && is_success(b.status)) << integrator << " " << to_string(b.status);
      EXPECT_LT(largest_difference(turned(one.state().q), other.state().q), 1e-8) << integrator;
      EXPECT_NEAR(a.pin_work, b.pin_work, 1e-6 * std::abs(a.pin_work) + 1e-12) << integrator;
      EXPECT_LT(std::abs(b.ledger_error), 1e-11 * (b.kinetic + std::abs(b.potential_total))) << integrator;
    }
    const double pulled = 2 * one.state().time * one.state().time;
    for (int v = 0; v < one.model().mesh.vertex_count(); ++v) {
      const Vec3d &X = one.model().mesh.rest[v], x = point(one.state().q, v);
      for (int axis = 0; axis < 3; ++axis)
        if (X[axis] == 0) {
          EXPECT_EQ(x[axis], 0) << integrator;
        }
      if (X[0] == 2) {
        EXPECT_NEAR(x[0], 2 + pulled, 1e-14) << integrator;
      }
    }
  }
}

TEST(PinsOfDirections, YieldSameEquilibriumWithEverySolver) {
  const ModelOptions body{.young = 1e4, .poisson = 0.45, .gravity = {{0, -3, 1}}};
  SimulationOptions options{.h = 0.2, .integrator = "quasi_static", .solver = {}};
  options.solver.minimize.tolerance = 1e-11;
  Simulation expected = simulate(rolling_bar({false}, body), options);
  ASSERT_TRUE(is_success(expected.step().status));
  for (const std::string& linear : linear_solver_names()) {
    options.solver.linear = linear;
    Simulation turned_one = simulate(rolling_bar({true}, body), options);
    const StepReport report = turned_one.step();
    EXPECT_TRUE(is_success(report.status)) << linear << " " << to_string(report.status);
    EXPECT_LT(largest_difference(turned(expected.state().q), turned_one.state().q), 1e-8) << linear;
  }
}

TEST(PinsOfDirections, ConvergeWithEveryMethod) {
  for (const std::string& method : minimizer_names()) {
    SimulationOptions options{.h = 0.02, .solver = {}};
    options.solver.method = method;
    Simulation simulation = simulate(rolling_bar({true}, {.young = 1e3, .poisson = 0.3}), options);
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(is_success(simulation.step().status)) << method;
  }
}

TEST(PinsOfDirections, AreBitReproducibleAfterRestore) {
  for (const char* integrator : {"backward_euler", "tr_bdf2", "bdf2", "rk4", "forward_euler"}) {
    const SimulationOptions options{.h = is_explicit(integrator) ? 2e-4 : 0.02, .integrator = integrator, .solver = {}};
    const auto make = [&] { return simulate(rolling_bar({true}, {.young = 1e4, .poisson = 0.3}), options); };
    Simulation whole = make(), first = make(), second = make();
    for (int i = 0; i < 6; ++i) whole.step();
    for (int i = 0; i < 3; ++i) first.step();
    second.restore(first.snapshot());
    const int threads = thread_count();
    set_thread_count(1);
    for (int i = 0; i < 3; ++i) second.step();
    set_thread_count(threads);
    EXPECT_EQ(second.state().q, whole.state().q) << integrator;
    EXPECT_EQ(second.state().qdot, whole.state().qdot) << integrator;
  }
}

// Returns the mesh of one eighth and its mirror images, with shared vertices on the planes.
TetMesh mirrored(const TetMesh& eighth) {
  TetMesh whole;
  std::map<std::tuple<double, double, double>, int> known;
  for (int image = 0; image < 8; ++image)
    for (Tet tet : eighth.tets) {
      for (int& v : tet) {
        Vec3d X = eighth.rest[v];
        for (int axis = 0; axis < 3; ++axis)
          if (image >> axis & 1) X[axis] = -X[axis] + 0.0;
        const auto [place, is_new] = known.try_emplace({X[0], X[1], X[2]}, whole.vertex_count());
        if (is_new) whole.rest.push_back(X);
        v = place->second;
      }
      if (std::popcount(static_cast<unsigned>(image)) % 2 == 1) std::swap(tet[0], tet[1]);
      whole.tets.push_back(tet);
    }
  return whole;
}

TEST(PinsOfDirections, MakeEighthEqualWhole) {
  const TetMesh eighth = make_box({{0, 0, 0}}, {{2, 1, 1}}, {3, 2, 2});
  const ModelOptions body{.young = 1e4, .poisson = 0.4, .gravity = {}};
  const SimulationOptions options{.h = 1, .integrator = "quasi_static", .solver = {.minimize = {.tolerance = 1e-11}}};
  const auto pull = [](const Vec3d& X, double t) { return X + Vec3d{{X[0] > 0 ? 0.5 * t : -0.5 * t, 0, 0}}; };
  const auto run = [&](Model model) {
    model.pins.push_back({"end", vertices_where(model.mesh, [](const Vec3d& X) { return std::abs(X[0]) == 2; }), pull});
    Simulation simulation = simulate(std::move(model), options);
    EXPECT_TRUE(is_success(simulation.step().status));
    return simulation;
  };
  Model part = make_model(eighth, body);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d n{};
    n[axis] = 1;
    part.pins.push_back(
        {"plane", vertices_where(eighth, [=](const Vec3d& X) { return X[axis] == 0 && X[0] != 2; }), {}, {n}});
  }
  const Simulation one = run(std::move(part)), all = run(make_model(mirrored(eighth), body));
  const TetMesh& whole = all.model().mesh;
  int compared = 0;
  for (int v = 0; v < eighth.vertex_count(); ++v)
    for (int w = 0; w < whole.vertex_count(); ++w) {
      if (norm(whole.rest[w] - eighth.rest[v]) > 1e-12) continue;
      ++compared;
      EXPECT_LT(norm(point(all.state().q, w) - point(one.state().q, v)), 1e-9);
    }
  EXPECT_EQ(compared, eighth.vertex_count());
}

TEST(PinsOfDirections, ExplainSlidingBodyInStatics) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.gravity = {{1, -9.81, 0}}});
  model.pins.push_back({"floor", vertices_where(model.mesh, [](const Vec3d& X) { return X[1] == 0; }), {}, {kY}});
  SimulationOptions options{.integrator = "quasi_static", .solver = {}};
  options.solver.minimize.max_iterations = 3;
  Simulation simulation = simulate(std::move(model), options);
  const StepReport report = simulation.step();
  ASSERT_FALSE(is_success(report.status));
  EXPECT_NE(explain(simulation, report).place.find("slide"), std::string::npos);
}

// ---------------------------------------------------------------- forces of pins, loads and bodies

Vec3d total(const std::vector<Resultant>& all) {
  Vec3d sum{};
  for (const Resultant& one : all) sum = sum + one.force;
  return sum;
}

Vec3d momentum_of(const Simulation& simulation) {
  std::vector<double> p(simulation.state().q.size());
  simulation.model().mass->multiply(simulation.state().qdot, p);
  Vec3d sum{};
  for (int v = 0; v < static_cast<int>(p.size() / 3); ++v) sum = sum + point(p, v);
  return sum;
}

TEST(Resultants, ReactionsBalanceLoadsInStatics) {
  Model model = rolling_bar({true}, {.young = 1e4, .poisson = 0.3});
  model.loads.push_back(make_point_springs("pull", {{20, 50, [](double) { return Vec3d{{2, 3, 1}}; }}}));
  Simulation simulation = simulate(std::move(model), {.h = 0.1, .integrator = "quasi_static", .solver = {}});
  const StepReport report = simulation.step();
  const Resultants& sums = report.resultants;
  ASSERT_EQ(sums.pins.size(), 4u);
  ASSERT_EQ(sums.loads.size(), 2u);
  const double bound = std::sqrt(simulation.model().mesh.vertex_count()) * report.residual + 1e-9;
  EXPECT_LT(norm(total(sums.pins) + total(sums.loads)), bound);
  EXPECT_LT(norm(sums.bodies.at(0).force), bound);
  EXPECT_LT(norm(sums.bodies.at(0).moment), 10 * bound);
  EXPECT_GT(norm(sums.pins[3].force), 100) << "the pull must have a reaction";
  EXPECT_LT(norm(cross(sums.pins[3].force, kTurn * kX)), 1e-9) << "a roller must exert no force along its plane";
  const double weight = 2 * 1000 * 9.81;
  EXPECT_NEAR(norm(sums.loads[0].force), weight, 1e-9 * weight);
  Vec3d center = kTurn * Vec3d{{1, 0.5, 0.5}};  // center of the body at rest; dead weight acts at its current position
  EXPECT_LT(norm(sums.loads[0].moment - cross(center, sums.loads[0].force)), weight)
      << "the moment must be about the origin";
}

TEST(Resultants, EqualRateOfMomentum) {
  for (const std::string& integrator : integrator_names()) {
    if (integrator == "quasi_static" || integrator == "bdf2") continue;  // no velocities; a rate over two steps
    const SimulationOptions options{.h = is_explicit(integrator) ? 1e-4 : 0.01, .integrator = integrator, .solver = {}};
    Model model = beam(2, {.young = 1e5, .poisson = 0.3});
    Simulation simulation = simulate(std::move(model), options);
    for (int i = 0; i < 3; ++i) {
      const Vec3d before = momentum_of(simulation);
      const StepReport report = simulation.step();
      const Vec3d rate = (1 / options.h) * (momentum_of(simulation) - before);
      const double bound = 1e-8 * norm(report.resultants.loads[0].force) + 20 * report.residual;
      EXPECT_LT(norm(rate - report.resultants.bodies.at(0).force), bound) << integrator << " step " << i + 1;
      EXPECT_LT(norm(rate - total(report.resultants.pins) - total(report.resultants.loads)), bound) << integrator;
    }
  }
}

TEST(Resultants, AreMeansOverSubsteps) {
  const SimulationOptions options{.h = 0.04, .adaptive = {.tolerance = 1e-4}, .solver = {}};
  Simulation simulation = simulate(beam(2, {.young = 1e5, .poisson = 0.3}), options);
  const StepReport report = simulation.step();
  ASSERT_GT(report.substeps, 2);
  const Vec3d rate = (1 / options.h) * momentum_of(simulation);
  EXPECT_LT(norm(rate - report.resultants.bodies.at(0).force), 1e-3 * norm(report.resultants.loads[0].force));
}

TEST(StartReport, HasInitialEnergies) {
  Simulation simulation = simulate(beam(2));
  const StepReport start = simulation.start_report();
  EXPECT_EQ(start.step, 0);
  EXPECT_EQ(start.time, 0);
  EXPECT_EQ(start.potential, simulation.potential_energies());
  EXPECT_NEAR(start.min_det_F, 1, 1e-12);
  EXPECT_TRUE(std::isnan(start.resultants.pins.at(0).force[0])) << "must be unknown before a step";
  const StepReport first = simulation.step();
  EXPECT_NEAR(first.kinetic + first.potential_total,
              start.kinetic + start.potential_total + first.pin_work - first.damping_loss - first.numerical_loss +
                  first.residual_work,
              1e-10 * std::abs(start.potential_total));
}

TEST(VaryingLoad, RampsInStaticsWithWork) {
  Model model = beam(2, {.young = 1e5, .poisson = 0.3, .gravity = {}});
  const size_t n = 3 * model.mesh.rest.size();
  model.loads.push_back(make_linear_load("ramp", std::vector<double>(n, 0.0), [](double t, std::span<double> force) {
    for (size_t i = 1; i < force.size(); i += 3) force[i] -= 2 * t;
  }));
  Simulation simulation = simulate(std::move(model), {.h = 0.25, .integrator = "quasi_static", .solver = {}});
  for (int i = 1; i <= 4; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status));
    EXPECT_NEAR(report.resultants.loads.back().force[1], -2 * 0.25 * i * static_cast<double>(n / 3), 1e-9);
    EXPECT_LT(std::abs(report.ledger_error), 1e-10);
    EXPECT_NE(report.target_work.back(), 0);
  }
}

}  // namespace
}  // namespace aspic
