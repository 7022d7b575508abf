// All minimization methods on elastic bodies.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "dynamics/models_test.h"
#include "mesh/surface.h"
#include "optimize/landscape.h"

namespace aspic {
namespace {

using namespace testing_models;

// Returns every valid combination of methods, preconditioners and modified Hessians.
std::vector<SolverOptions> all_methods() {
  std::vector<SolverOptions> all;
  for (const std::string& method : minimizer_names())
    for (const std::string& preconditioner : preconditioner_names())
      for (const std::string& definiteness : definiteness_names()) {
        const SolverOptions options{.method = method, .preconditioner = preconditioner, .definiteness = definiteness};
        if (!find_conflict(options)) all.push_back(options);
      }
  return all;
}

std::string name_of(const SolverOptions& o) { return o.method + " " + o.preconditioner + " " + o.definiteness; }

SimulationOptions tight(const SolverOptions& solver) {
  SimulationOptions options{.solver = solver};
  options.solver.minimize.tolerance = 1e-9;
  options.solver.minimize.max_iterations = 20'000;
  return options;
}

TEST(Methods, ReachSameMinimumOfTimeStep) {
  // Near rest, the Hessian is at least the mass M. M of one tet has the eigenvalues m/20 and m/4, so M is at least a
  // fifth of the lumped mass, and a gradient of norm e implies an error of at most 5 e / (smallest vertex mass). Two
  // methods differ by at most twice that.
  const Model model = damped_beam_with_moving_pins_and_targets();
  const auto masses = model.mass->vertex_mass();
  const double least = *std::min_element(masses.begin(), masses.end()) / 5;
  std::vector<double> expected;
  for (const SolverOptions& solver : all_methods()) {
    Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(), tight(solver));
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << name_of(solver) << ": " << to_string(report.status);
    const auto& q = simulation.state().q;
    if (expected.empty()) expected = q;
    const double h = simulation.options().h, allowed = 2 * h * h * report.residual_threshold / least;
    EXPECT_LT(allowed, 1e-6);
    for (size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(q[i], expected[i], allowed) << name_of(solver);
  }
}

// A direction of a user of the library.
class Borrowed : public SearchDirection {
 public:
  explicit Borrowed(const std::string& method) : method_(make_search_direction({.method = method, .minimize = {}})) {}
  std::string_view name() const override { return "borrowed"; }
  void begin() override { method_->begin(); }
  bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) override {
    return ++calls, method_->compute(at, d, report);
  }
  bool fall_back() override { return method_->fall_back(); }
  int calls = 0;

 private:
  std::unique_ptr<SearchDirection> method_;
};

TEST(Methods, CustomDirectionReplacesTheMethod) {
  Simulation custom = simulate(beam(2), {.solver = {.minimize = {}}});
  Simulation lbfgs = simulate(beam(2), {.solver = {.method = "lbfgs", .minimize = {}}});
  auto direction = std::make_unique<Borrowed>("lbfgs");
  const Borrowed& borrowed = *direction;
  custom.set_direction(std::move(direction));
  EXPECT_THAT(custom.solver_description(), testing::HasSubstr("borrowed"));
  for (int step = 0; step < 3; ++step) {
    const StepReport report = custom.step();
    EXPECT_TRUE(is_success(report.status));
    EXPECT_EQ(report.state_hash, lbfgs.step().state_hash);
  }
  EXPECT_GT(borrowed.calls, 3);
  custom.set_solver({.minimize = {}});
  EXPECT_THAT(custom.solver_description(), testing::Not(testing::HasSubstr("borrowed")));
}

TEST(Methods, CustomDirectionNeedsAMinimization) {
  for (const char* integrator : {"symplectic_euler", "linearly_implicit_euler"}) {
    Simulation simulation = simulate(beam(1), {.integrator = integrator, .solver = {}});
    EXPECT_THROW(simulation.set_direction(std::make_unique<Borrowed>("newton")), InvalidInput) << integrator;
  }
}

TEST(Methods, AreBitReproducibleOverThreads) {
  const int before = thread_count();
  for (const SolverOptions& solver : all_methods()) {
    std::vector<double> expected;
    for (const int threads : {1, 2, 5}) {
      set_thread_count(threads);
      SimulationOptions options{.solver = solver};
      options.solver.minimize.max_iterations = 5;
      Simulation simulation = simulate(damped_beam_with_moving_pins_and_targets(), options);
      for (int i = 0; i < 2; ++i) simulation.step();
      if (expected.empty()) expected = simulation.state().q;
      EXPECT_EQ(simulation.state().q, expected) << name_of(solver);
    }
  }
  set_thread_count(before);
}

TEST(Methods, AreBitReproducibleWithObserver) {
  for (const SolverOptions& solver : all_methods()) {
    SimulationOptions options{.solver = solver};
    options.solver.minimize.max_iterations = 5;
    Simulation plain = simulate(damped_beam_with_moving_pins_and_targets(), options);
    Simulation watched = simulate(damped_beam_with_moving_pins_and_targets(), options);
    for (int i = 0; i < 2; ++i) {
      plain.step();
      watched.step([](const LiveIteration& iteration) {
        slice_through(iteration, 3);
        curve_along(iteration, 1e-4, 3);
      });
    }
    EXPECT_EQ(watched.state().q, plain.state().q) << name_of(solver);
  }
}

TEST(Methods, MoreCurvatureTakesFewerIterations) {
  std::map<std::string, int> iterations;
  for (const std::string& method : minimizer_names()) {
    SimulationOptions options{.h = 0.03, .solver = {.method = method}};
    options.solver.minimize.max_iterations = 20'000;
    Simulation simulation = simulate(beam(2, {.young = 1e5}), options);
    for (int i = 0; i < 3; ++i) iterations[method] += simulation.step().iterations;
  }
  EXPECT_LE(iterations["newton"], iterations["newton_cg"]);
  EXPECT_LE(iterations["newton"], iterations["lbfgs"]);
  for (const std::string method : {"lbfgs", "nonlinear_cg"})
    EXPECT_LT(5 * iterations[method], iterations["gradient_descent"]) << method;
}

TEST(Methods, GradientDescentBacktracksOnStiffBody) {
  SimulationOptions options{.solver = {.method = "gradient_descent"}};
  options.solver.minimize.max_iterations = 20;
  Simulation simulation = simulate(beam(1, {.young = 1e9}), options);
  double last = INFINITY;
  const StepReport report = simulation.step([&](const Iteration& iteration) {
    EXPECT_LT(iteration.value, last);
    last = iteration.value;
  });
  EXPECT_EQ(report.status, Status::iteration_limit);
  EXPECT_GT(report.trials, 5 * report.iterations);
}

struct Work {
  long projected_elements = 0;
  int iterations = 0;
  double residual = 0;
};

// Compresses a beam to half its length within half a second.
Work work_of_compression(const std::string& method, const std::string& definiteness) {
  Model model = beam(3, {.material = "neo_hookean", .gravity = {{0, 0, 0}}});
  model.pins.push_back({"press", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] > 4 - 1e-9; }),
                        [](const Vec3d& X, double t) {
                          return X + Vec3d{{-4 * t, 0, 0}};
                        }});
  SimulationOptions options{.h = 0.05, .solver = {.method = method, .definiteness = definiteness}};
  options.solver.minimize.max_iterations = 500;
  Simulation simulation = simulate(std::move(model), options);
  Work work;
  for (int i = 0; i < 10; ++i) {
    const StepReport report = simulation.step(
        [&](const Iteration& iteration) { work.projected_elements += iteration.direction.projected_elements; });
    EXPECT_TRUE(is_success(report.status)) << method << ", " << definiteness;
    work.iterations += report.iterations;
  }
  return work;
}

TEST(Newton, ProgressiveProjectionModifiesFewElements) {
  const Work clamped = work_of_compression("newton", "clamped"), on_demand = work_of_compression("newton", "on_demand"),
             progressive = work_of_compression("newton", "progressive");
  EXPECT_GT(progressive.projected_elements, 0);
  EXPECT_LT(5 * progressive.projected_elements, clamped.projected_elements);
  EXPECT_LT(5 * on_demand.projected_elements, clamped.projected_elements);
  EXPECT_LT(2 * progressive.iterations, clamped.iterations);
}

TEST(Newton, TruncatedNewtonNeedsNoModifiedHessian) {
  EXPECT_EQ(work_of_compression("newton_cg", "auto").projected_elements, 0);
}

// A slender column under more than its critical load, with a lateral force of a millionth of it.
TEST(Newton, BucklingColumnLeavesSaddleInFewIterations) {
  Model model = make_model(make_box({{0, 0, 0}}, {{0.1, 1, 0.1}}, {2, 16, 2}),
                           {.young = 1e5, .poisson = 0.3, .gravity = {{1e-6, -1.5, 0}}});
  model.pins.push_back({"base", vertices_where(model.mesh, [](const Vec3d& X) { return X[1] < 1e-9; }), {}});
  Simulation simulation = simulate(std::move(model), {.h = 1, .integrator = "quasi_static"});
  const StepReport report = simulation.step();
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_LT(report.iterations, 60);  // 81 with clamped Hessians only
}

// A bar in tension that is pinned at one vertex: it may rotate about it, so no Hessian is positive definite.
TEST(Newton, SinglePinHasEquilibriumWithEverySolver) {
  for (const std::string& linear : linear_solver_names()) {
    Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}),
                             {.young = 1e4, .poisson = 0.3, .gravity = {{0, 0, 0}}});
    std::vector<double> force(3 * model.mesh.rest.size(), 0.0);
    for (const Triangle& t : boundary_triangles(model.mesh, 0, model.mesh.tet_count()))
      for (const double end : {0.0, 1.0})
        if (std::all_of(t.begin(), t.end(), [&](int v) { return model.mesh.rest[v][0] == end; }))
          add_traction(model.mesh.rest, {t}, {{2000 * (2 * end - 1), 0, 0}}, force);
    model.loads.push_back(make_linear_load("tension", force));
    model.pins.push_back({"corner", {0}, {}});
    SimulationOptions options{.h = 1, .integrator = "quasi_static"};
    options.solver.linear = linear;
    const StepReport report = simulate(std::move(model), options).step();
    EXPECT_EQ(report.status, Status::converged) << linear;
    EXPECT_LT(report.iterations, 10) << linear;
  }
}

TEST(IncrementalPotential, MetricIsMassWithIdentityForPins) {
  const Model model = beam(1);
  const State start = at_rest(model.mesh);
  const Pins pins(model.pins, start.q);
  IncrementalPotential E(model, pins);
  std::vector<double> v(start.q.size()), product(v.size()), expected(v.size());
  for (size_t i = 0; i < v.size(); ++i)
    v[i] = pins.holds(static_cast<int>(i / 3)) ? 0 : std::cos(static_cast<double>(i));
  E.metric().multiply(v, product);
  model.mass->multiply(v, expected);
  pins.set_zero(expected);
  for (size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(product[i], expected[i], 1e-12);
  for (size_t i = 0; i < v.size(); ++i) v[i] = pins.holds(static_cast<int>(i / 3)) ? 2 : 0;
  E.metric().multiply(v, product);
  EXPECT_EQ(product, v);
}

}  // namespace
}  // namespace aspic
