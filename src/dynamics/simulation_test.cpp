#include "dynamics/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "dynamics/models_test.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"

namespace aspic {
namespace {

using namespace testing_models;

TEST(Simulation, EveryIntegratorFallsFreelyAsItsFormulaSays) {
  // After n steps: backward, linearly implicit and symplectic Euler g h^2 n(n+1)/2, forward Euler g h^2 n(n-1)/2.
  const int n = 20;
  const double h = 0.01, g = 9.81;
  const std::vector<std::pair<std::string, double>> expected = {{"backward_euler", n * (n + 1) / 2.0},
                                                                {"linearly_implicit_euler", n * (n + 1) / 2.0},
                                                                {"symplectic_euler", n * (n + 1) / 2.0},
                                                                {"forward_euler", n * (n - 1) / 2.0}};
  for (const auto& [integrator, steps] : expected) {
    SimulationOptions options{.h = h, .integrator = integrator, .solver = {}};
    options.solver.minimize.tolerance = 1e-14;
    // Soft enough for the explicit schemes to be stable.
    Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e3});
    Simulation simulation = simulate(std::move(model), options);
    for (int i = 0; i < n; ++i) ASSERT_TRUE(is_success(simulation.step().status)) << integrator;
    for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v)
      EXPECT_NEAR(simulation.state().q[3 * v + 1], simulation.model().mesh.rest[v][1] - g * h * h * steps, 1e-12)
          << integrator;
  }
}

TEST(Simulation, TheBenchmarkBeamFallsToTheAgreedDisplacement) {
  SimulationOptions options;
  options.solver.minimize.criterion = Criterion::first_gradient;
  Simulation simulation = simulate(beam(7), options);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(simulation.step().status, Status::converged);
  const int tip = 28 * 8 * 8;  // (4, 0, 0)
  EXPECT_NEAR(simulation.state().q[3 * tip + 1], -0.0539775432, 1e-8);
}

double largest_term(const StepReport& report) {
  double largest = std::abs(report.kinetic);
  for (const double V : report.potential) largest = std::max(largest, std::abs(V));
  return largest;
}

Model damped_beam_with_moving_pins_and_targets() {
  Model model = beam(2, {.young = 1e5, .poisson = 0.3});
  model.pins.push_back({"crank", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; }),
                        [](const Vec3d& X, double t) {
                          return X + Vec3d{{0, 0.2 * std::sin(8 * t), 0}};
                        }});
  model.loads.push_back(make_point_springs("pull", {{20, 500, [](double t) { return Vec3d{{2, t, 0}}; }}}));
  model.damping.push_back(make_rayleigh_damping(*model.mass, 0.5, model.elasticity[0].get(), 1e-3));
  model.damping.push_back(make_strain_rate_damping(model.mesh, 0, std::vector<double>(model.mesh.tet_count(), 50.0)));
  return model;
}

TEST(Simulation, TheLedgerAddsUpForEveryIntegratorWithPinsTargetsAndDamping) {
  for (const std::string& integrator : integrator_names()) {
    const bool is_explicit = integrator == "symplectic_euler" || integrator == "forward_euler";
    Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(),
                                     {.h = is_explicit ? 1e-4 : 0.01, .integrator = integrator, .solver = {}});
    double largest = 0, pin_work = 0;
    for (int i = 0; i < 20; ++i) {
      const StepReport report = simulation.step();
      ASSERT_TRUE(is_success(report.status)) << integrator << " " << to_string(report.status);
      largest = std::max(largest, largest_term(report));
      pin_work += std::abs(report.pin_work);
      EXPECT_LT(std::abs(report.ledger_error), 1e-11 * largest) << integrator;
    }
    EXPECT_GT(pin_work, 0) << integrator;
  }
}

TEST(Simulation, BackwardEulerLosesEnergyAndForwardEulerGainsIt) {
  for (const auto& [integrator, sign] : {std::pair{"backward_euler", 1.0}, {"forward_euler", -1.0}}) {
    Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e4, .gravity = {}});
    State start = at_rest(model.mesh);
    for (size_t i = 0; i < start.q.size(); i += 3) start.q[i] *= 1.1;
    Simulation simulation(std::move(model), start, {.h = 1e-3, .integrator = integrator, .solver = {}});
    double loss = 0;
    for (int i = 0; i < 50; ++i) loss += simulation.step().numerical_loss;
    EXPECT_GT(sign * loss, 0) << integrator;
  }
}

Vec3d momentum(const Simulation& simulation, bool angular) {
  std::vector<double> p(simulation.state().q.size());
  simulation.model().mass->multiply(simulation.state().qdot, p);
  Vec3d total{};
  for (size_t i = 0; i < p.size(); i += 3) {
    const Vec3d pi{{p[i], p[i + 1], p[i + 2]}};
    const double* q = &simulation.state().q[i];
    total = total + (angular ? cross(Vec3d{{q[0], q[1], q[2]}}, pi) : pi);
  }
  return total;
}

TEST(Simulation, LinearMomentumChangesByTheExternalImpulse) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e5});
  State start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) start.q[i] *= 1.2;
  SimulationOptions options{.h = 0.01, .integrator = "backward_euler", .solver = {}};
  options.solver.minimize.tolerance = 1e-13;
  Simulation simulation(std::move(model), start, options);
  const double mass = simulation.model().mass->total();
  EXPECT_NEAR(mass, 1000, 1e-9);
  for (int i = 1; i <= 10; ++i) {
    simulation.step();
    const Vec3d p = momentum(simulation, false);
    EXPECT_NEAR(p[0], 0, 1e-9 * mass);
    EXPECT_NEAR(p[1], -9.81 * 0.01 * i * mass, 1e-9 * mass);
    EXPECT_NEAR(p[2], 0, 1e-9 * mass);
  }
}

// L = sum q_i x (M v)_i changes by h sum v_new_i x (M v_old)_i: backward Euler does not conserve it.
TEST(Simulation, AngularMomentumChangesAsBackwardEulerMust) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e4, .gravity = {}});
  State start = at_rest(model.mesh);
  for (size_t i = 0; i < start.q.size(); i += 3) {
    start.qdot[i] = -6 * start.q[i + 1];
    start.qdot[i + 1] = 6 * start.q[i];
    start.q[i + 2] *= 1.2;
  }
  SimulationOptions options{.h = 0.01, .integrator = "backward_euler", .solver = {}};
  options.solver.minimize.tolerance = 1e-13;
  Simulation simulation(std::move(model), start, options);
  for (int i = 0; i < 10; ++i) {
    const Vec3d before = momentum(simulation, true);
    const std::vector<double> v = simulation.state().qdot;
    simulation.step();
    std::vector<double> Mv(v.size());
    simulation.model().mass->multiply(v, Mv);
    Vec3d change{};
    for (size_t k = 0; k < v.size(); k += 3) {
      const double* w = &simulation.state().qdot[k];
      change = change + 0.01 * cross(Vec3d{{w[0], w[1], w[2]}}, Vec3d{{Mv[k], Mv[k + 1], Mv[k + 2]}});
    }
    const Vec3d after = momentum(simulation, true);
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(after[r] - before[r], change[r], 1e-8 * before[2]);
    EXPECT_LT(after[2], before[2]);
  }
}

// The same beam in units of length a, of modulus and density b: lengths scale with a, times with a.
TEST(Simulation, AChangeOfUnitsChangesNeitherIterationsNorTheDimensionlessResult) {
  const auto run = [](double a, double b) {
    TetMesh mesh = make_box({{0, 0, 0}}, {{4 * a, a, a}}, {8, 2, 2});
    Model model = make_model(mesh, {.young = 1e5 * b, .density = 1000 * b, .gravity = {{0, -9.81 / a, 0}}});
    model.pins.push_back({"wall", vertices_where(mesh, [a](const Vec3d& X) { return X[0] < 1e-9 * a; }), {}});
    Simulation simulation = simulate(std::move(model), {.h = 0.02 * a, .integrator = "backward_euler", .solver = {}});
    std::vector<double> result;
    for (int i = 0; i < 10; ++i) result.push_back(simulation.step().iterations);
    for (const double q : simulation.state().q) result.push_back(q / a);
    return result;
  };
  const std::vector<double> metres = run(1, 1);
  for (const auto& [a, b] : {std::pair{1e-3, 1.0}, {1e3, 1.0}, {1.0, 1e-3}, {1.0, 1e6}}) {
    const std::vector<double> scaled = run(a, b);
    for (size_t i = 0; i < metres.size(); ++i) EXPECT_NEAR(scaled[i], metres[i], 1e-9) << a << " " << b;
  }
}

// x = A(t) X with A = I + s(t) B solves the equations under the body force rho A'' X when the boundary follows it.
class AffineLoad : public Energy {
 public:
  AffineLoad(const MassMatrix& mass, const TetMesh& mesh, std::function<Vec3d(const Vec3d&, double)> acceleration)
      : mass_(mass), mesh_(mesh), acceleration_(std::move(acceleration)) {}
  std::string_view name() const override { return "affine_load"; }
  void begin_step(const StepContext& step) override {
    std::vector<double> a;
    for (const Vec3d& X : mesh_.rest) {
      const Vec3d ai = acceleration_(X, step.time);
      a.insert(a.end(), {ai[0], ai[1], ai[2]});
    }
    force_.resize(a.size());
    mass_.multiply(a, force_);
  }
  double value(Positions x) const override {
    double V = 0;
    for (size_t i = 0; i < x.size(); ++i) V -= force_[i] * x[i];
    return V;
  }
  void add_gradient(Positions, double scale, std::span<double> g) const override {
    for (size_t i = 0; i < g.size(); ++i) g[i] -= scale * force_[i];
  }
  void add_hessian(Positions, double, Definiteness, BlockSparse&) const override {}

 private:
  const MassMatrix& mass_;
  TetMesh mesh_;
  std::function<Vec3d(const Vec3d&, double)> acceleration_;
  std::vector<double> force_ = std::vector<double>(3 * mesh_.rest.size(), 0.0);
};

double affine_motion_error(const std::string& integrator, double h) {
  const Mat3d B = {{0.3, 0.1, 0, -0.2, 0.1, 0.2, 0.1, 0, -0.2}};
  const auto moved = [B](const Vec3d& X, double t) { return X + (std::sin(3 * t + 0.5) - std::sin(0.5)) * (B * X); };
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {3, 3, 3}), {.young = 1e3, .gravity = {}});
  const auto on_boundary = [](const Vec3d& X) {
    return std::any_of(X.a, X.a + 3, [](double c) { return c < 1e-9 || c > 1 - 1e-9; });
  };
  model.pins.push_back({"boundary", vertices_where(model.mesh, on_boundary), moved});
  // An explicit scheme sees the forces at the start of the step.
  const double shift = integrator == "symplectic_euler" || integrator == "forward_euler" ? h : 0;
  model.loads.push_back(std::make_unique<AffineLoad>(*model.mass, model.mesh, [B, shift](const Vec3d& X, double t) {
    return (-9 * std::sin(3 * (t - shift) + 0.5)) * (B * X);
  }));
  State start = at_rest(model.mesh);
  for (int v = 0; v < model.mesh.vertex_count(); ++v) {
    const Vec3d velocity = (3 * std::cos(0.5)) * (B * model.mesh.rest[v]);
    for (int r = 0; r < 3; ++r) start.qdot[3 * v + r] = velocity[r];
  }
  Simulation simulation(std::move(model), start, {.h = h, .integrator = integrator, .solver = {}});
  for (int i = 0; i < std::lround(0.4 / h); ++i) EXPECT_TRUE(is_success(simulation.step().status)) << integrator;
  double error = 0;
  for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v) {
    const Vec3d exact = moved(simulation.model().mesh.rest[v], simulation.state().time);
    for (int r = 0; r < 3; ++r) error = std::max(error, std::abs(simulation.state().q[3 * v + r] - exact[r]));
  }
  return error;
}

TEST(Simulation, IntegratorsAreOfFirstOrderInTime) {
  for (const std::string integrator :
       {"backward_euler", "linearly_implicit_euler", "symplectic_euler", "forward_euler"}) {
    const double coarse = affine_motion_error(integrator, 0.005), fine = affine_motion_error(integrator, 0.0025);
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.15) << integrator;
    EXPECT_GT(fine, 1e-8) << integrator << ": no error to measure an order by";
  }
}

struct UniaxialRow {
  std::string material;
  double poisson, stretch, lateral, nominal_stress;
};

// Prescribes an affine stretch on the boundary of an unstructured-looking box and lets the inside find it.
TEST(Simulation, StatesOfUniaxialStretchPassThePatchTest) {
  const std::vector<UniaxialRow> rows = {{"neo_hookean_log", .3, .5, 1.21076739, -0.93535206},
                                         {"neo_hookean_log", .3, 1.5, 0.88017459, 0.37828018},
                                         {"neo_hookean", .3, 2, 0.77459667, 0.65384615},
                                         {"neo_hookean", .45, 1.5, 0.82999331, 0.35887612}};
  for (const UniaxialRow& row : rows) {
    TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {3, 3, 3});
    const auto on_boundary = [](const Vec3d& X) {
      return std::any_of(X.a, X.a + 3, [](double c) { return c < 1e-9 || c > 1 - 1e-9; });
    };
    for (Vec3d& X : mesh.rest)
      if (!on_boundary(X)) X = X + Vec3d{{0.05 * std::sin(9 * X[1]), 0.04 * std::cos(7 * X[2]), -0.03}};
    Model model = make_model(mesh, {.material = row.material, .young = 1, .poisson = row.poisson, .gravity = {}});
    const auto stretched = [row](const Vec3d& X) {
      return Vec3d{{row.stretch * X[0], row.lateral * X[1], row.lateral * X[2]}};
    };
    model.pins.push_back({"boundary", vertices_where(model.mesh, on_boundary),
                          [stretched](const Vec3d& X, double t) { return (1 - t) * X + t * stretched(X); }});
    SimulationOptions options{.h = 0.25, .integrator = "quasi_static", .solver = {}};
    options.solver.minimize.tolerance = 1e-14;
    Simulation simulation = simulate(std::move(model), options);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(is_success(simulation.step().status)) << row.material;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3d exact = stretched(mesh.rest[v]);
      for (int r = 0; r < 3; ++r) EXPECT_NEAR(simulation.state().q[3 * v + r], exact[r], 1e-10);
    }
    const TetFields fields = simulation.tet_fields();
    for (int t = 0; t < mesh.tet_count(); ++t) {
      // Cauchy sigma = P lambda / J = P / t^2 along the bar, and nothing across. The table gives t to 5e-9, which
      // the stiffness (up to about 10 E across the bar at nu = .45) turns into stress.
      EXPECT_NEAR(fields.cauchy[6 * t] * row.lateral * row.lateral, row.nominal_stress, 5e-8) << row.material;
      EXPECT_NEAR(fields.cauchy[6 * t + 1], 0, 5e-8) << row.material;
    }
  }
}

std::vector<double> state_after(int steps, int threads) {
  set_thread_count(threads);
  Simulation simulation = simulate(beam(3, {.young = 1e5}));
  for (int i = 0; i < steps; ++i) simulation.step();
  std::vector<double> result = simulation.state().q;
  result.insert(result.end(), simulation.state().qdot.begin(), simulation.state().qdot.end());
  return result;
}

TEST(Simulation, TheBitsDoNotDependOnTheNumberOfThreads) {
  const int before = thread_count();
  const std::vector<double> one = state_after(5, 1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(state_after(5, threads), one) << threads << " threads";
  set_thread_count(before);
}

TEST(Simulation, ARestoredSimulationContinuesToTheSameBits) {
  for (const std::string& integrator : integrator_names()) {
    const double h = integrator == "symplectic_euler" || integrator == "forward_euler" ? 1e-4 : 0.01;
    const SimulationOptions options{.h = h, .integrator = integrator, .solver = {}};
    Simulation whole = simulate(damped_beam_with_moving_pins_and_targets(), options);
    for (int i = 0; i < 4; ++i) whole.step();
    const Simulation::Snapshot snapshot = whole.snapshot();
    std::vector<StepReport> reports;
    for (int i = 0; i < 4; ++i) reports.push_back(whole.step());

    Simulation resumed = simulate(damped_beam_with_moving_pins_and_targets(), options);
    resumed.restore(snapshot);
    for (int i = 0; i < 4; ++i) {
      const StepReport report = resumed.step();
      EXPECT_EQ(report.step, reports[i].step);
      EXPECT_EQ(report.potential, reports[i].potential) << integrator;
      EXPECT_EQ(report.pin_work, reports[i].pin_work) << integrator;
    }
    EXPECT_EQ(resumed.state().q, whole.state().q) << integrator;
    EXPECT_EQ(resumed.state().qdot, whole.state().qdot) << integrator;
  }
}

TEST(Simulation, AnInterruptedStepLeavesTheStateAlone) {
  Simulation simulation = simulate(beam(2));
  const State before = simulation.state();
  const StepReport report = simulation.step([](const Iteration&) { return false; });
  EXPECT_EQ(report.status, Status::interrupted);
  EXPECT_EQ(simulation.state().q, before.q);
  EXPECT_EQ(simulation.state().time, before.time);
  EXPECT_EQ(simulation.steps_taken(), 0);
}

TEST(Simulation, AStepThatDoesNotConvergeSaysSo) {
  SimulationOptions options;
  options.solver.minimize.max_iterations = 1;
  options.solver.minimize.tolerance = 1e-12;
  const StepReport report = simulate(beam(2, {.young = 1e4}), options).step();
  EXPECT_EQ(report.status, Status::iteration_limit);
  EXPECT_GT(report.residual, report.residual_threshold);
}

TEST(Simulation, AnExplodingExplicitSchemeEndsUndefined) {
  Simulation simulation = simulate(beam(2), {.h = 0.1, .integrator = "forward_euler", .solver = {}});
  Status last = Status::converged;
  for (int i = 0; i < 400 && is_success(last); ++i) last = simulation.step().status;
  EXPECT_EQ(last, Status::undefined);
}

TEST(Simulation, BadModelsAreRefusedInWords) {
  const auto message = [](auto&& make) -> std::string {
    try {
      make();
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message([] { simulate(beam(1), {.h = 0.01, .integrator = "backward_eular", .solver = {}}); }),
              testing::HasSubstr("did you mean 'backward_euler'"));
  EXPECT_THAT(message([] { simulate(beam(1, {.density = 0})); }), testing::HasSubstr("no mass"));
  EXPECT_THAT(message([] { simulate(beam(1), {.h = -1, .integrator = "backward_euler", .solver = {}}); }),
              testing::HasSubstr("time.step"));
  EXPECT_THAT(message([] {
                Model model = beam(1);
                State start = at_rest(model.mesh);
                for (double& x : start.q) x = -x;
                Simulation(std::move(model), start, {});
              }),
              testing::HasSubstr("inverted"));
}

TEST(Simulation, AStretchedBodyComesToRestUnderDamping) {
  Model model = beam(1, {.material = "neo_hookean", .young = 1e6});
  model.damping.push_back(make_rayleigh_damping(*model.mass, 4, nullptr, 0));  // about critical
  Simulation simulation = simulate(std::move(model), {.h = 0.02, .integrator = "backward_euler", .solver = {}});
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(is_success(simulation.step().status));
  EXPECT_LT(simulation.kinetic_energy(), 1e-8);
}

}  // namespace
}  // namespace aspic
