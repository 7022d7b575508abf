// Convergence criteria of a step bound the quantities that they name.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "base/error.h"
#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

struct Solved {
  StepReport report;
  std::vector<double> q;
};

// The third step of a falling, bending beam.
Solved third_step(Criterion criterion, double tolerance, double length_unit = 1) {
  SimulationOptions options;
  options.solver.linear = "cholesky";
  Model model = make_model(make_box({{0, 0, 0}}, {{4 * length_unit, length_unit, length_unit}}, {8, 2, 2}),
                           {.young = 1e5 * length_unit * length_unit, .gravity = {{0, -9.81 * length_unit, 0}}});
  model.pins.push_back({"wall", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] < 1e-9; }), {}});
  Simulation simulation = simulate(std::move(model), options);
  simulation.step();
  simulation.step();
  options.solver.minimize.criterion = criterion;
  options.solver.minimize.tolerance = tolerance;
  simulation.set_solver(options.solver);
  const StepReport report = simulation.step();
  return {report, simulation.state().q};
}

double largest_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); i += 3)
    largest = std::max(largest, std::hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]));
  return largest;
}

const std::vector<double>& minimizer() {
  static const std::vector<double> q = third_step(Criterion::scale, 1e-12).q;
  return q;
}

// The step along the last direction is performed, so the remaining error is smaller.
TEST(Criteria, VelocityBoundsVelocityError) {
  const double h = 0.01;
  for (const double tolerance : {1e-2, 1e-4}) {  // [m/s]
    const Solved solved = third_step(Criterion::velocity, tolerance);
    EXPECT_EQ(solved.report.status, Status::converged);
    EXPECT_LE(largest_distance(solved.q, minimizer()), tolerance * h);
  }
}

TEST(Criteria, AccelerationBoundsAccelerationError) {
  const double h = 0.01;
  for (const double tolerance : {1.0, 1e-2}) {  // [m/s^2]
    const Solved solved = third_step(Criterion::acceleration, tolerance);
    EXPECT_EQ(solved.report.status, Status::converged);
    EXPECT_LE(largest_distance(solved.q, minimizer()), tolerance * h * h);
  }
}

TEST(Criteria, TighterToleranceTakesMoreIterations) {
  for (const Criterion criterion : {Criterion::velocity, Criterion::acceleration, Criterion::decrement})
    EXPECT_LT(third_step(criterion, 1e3).report.iterations, third_step(criterion, 1e-9).report.iterations)
        << to_string(criterion);
}

// Another unit of length, with consistent stresses and forces: the same motion in this unit.
TEST(Criteria, RelativeCriteriaIgnoreUnits) {
  for (const Criterion criterion : {Criterion::scale, Criterion::first_gradient, Criterion::decrement}) {
    const int iterations = third_step(criterion, 1e-7).report.iterations;
    for (const double unit : {1e-3, 1e2}) {
      EXPECT_EQ(third_step(criterion, 1e-7, unit).report.iterations, iterations) << to_string(criterion) << unit;
    }
  }
}

TEST(Criteria, AbsoluteCriterionIsInNewtons) {
  const Solved solved = third_step(Criterion::absolute, 1e-3);
  EXPECT_EQ(solved.report.status, Status::converged);
  EXPECT_DOUBLE_EQ(solved.report.residual_threshold, 1e-3);
  EXPECT_LE(solved.report.residual, 1.01e-3);
  EXPECT_GT(solved.report.residual, 1e-11);  // the residual is not much smaller than required
}

TEST(Criteria, DirectionCriteriaNeedMinimizerEstimates) {
  for (const Criterion criterion : {Criterion::velocity, Criterion::acceleration, Criterion::decrement}) {
    SimulationOptions options;
    options.solver.method = "gradient_descent";
    options.solver.minimize.criterion = criterion;
    EXPECT_THAT(([&] { simulate(beam(1), options).step(); }),
                testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("scale")));
  }
}

// A hanging box of side `size`, whose stiffness gives it the relative sag of a box of 1 m and 100 kPa.
struct Box {
  double size;
  Vec3d at;
};

Model hanging_boxes(const std::vector<Box>& boxes) {
  TetMesh mesh;
  std::vector<MaterialParameters> parameters;
  std::vector<int> held;
  for (const Box& b : boxes) {
    const TetMesh box = make_box(b.at, b.at + Vec3d{{2 * b.size, b.size, b.size}}, {4, 2, 2});
    const int first = mesh.vertex_count();
    for (int v = 0; v < box.vertex_count(); ++v)
      if (box.rest[v][0] < b.at[0] + 1e-3 * b.size) held.push_back(first + v);
    mesh.rest.insert(mesh.rest.end(), box.rest.begin(), box.rest.end());
    for (const Tet& t : box.tets) mesh.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
    parameters.resize(mesh.tets.size(),
                      material_parameters("neo_hookean_log", {.young = 1e5 * b.size, .poisson = 0.3}));
  }
  return model_of(mesh).material("neo_hookean_log", parameters).pin("wall", held).build();
}

// Returns the state of the last box after five steps.
std::vector<double> last_box(const std::vector<Box>& boxes, const SimulationOptions& options) {
  Simulation simulation = simulate(hanging_boxes(boxes), options);
  for (int i = 0; i < 5; ++i) {
    const StepReport report = simulation.step();
    EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
  }
  const std::vector<double>& q = simulation.state().q;
  return {q.end() - static_cast<std::ptrdiff_t>(q.size() / boxes.size()), q.end()};
}

TEST(Criteria, SmallBodyIsUnaffectedByLargeBody) {
  std::mt19937 random(7);
  for (int scene = 0; scene < 12; ++scene) {
    const double size = std::pow(10, -1 - 3 * std::uniform_real_distribution(0.0, 1.0)(random));
    SimulationOptions options;
    options.h = 0.005 * std::sqrt(size);
    if (scene % 3 == 2) options.integrator = "quasi_static";
    options.solver.linear = scene % 2 ? "multigrid" : "cholesky";
    options.solver.minimize.criterion =
        std::array{Criterion::scale, Criterion::first_gradient, Criterion::decrement}[scene / 2 % 3];
    const Box small{size, {{0.5, 1.5, 0.5}}};
    const std::vector<double> alone = last_box({small}, options), beside = last_box({{1, {}}, small}, options);
    EXPECT_LT(largest_distance(alone, beside), 1e-4 * size)
        << "size " << size << ", " << to_string(options.solver.minimize.criterion) << ", " << options.solver.linear
        << ", " << options.integrator;
  }
}

TEST(Criteria, WorstVertexIsInWorstBody) {
  SimulationOptions options;
  options.solver.minimize.max_iterations = 1;
  Model model = hanging_boxes({{1, {}}, {1e-3, {{0.5, 1.5, 0.5}}}});
  const int half = model.mesh.vertex_count() / 2;
  std::vector<int> all(half);
  std::iota(all.begin(), all.end(), 0);
  model.pins.insert(model.pins.begin(), {"large", all, {}});
  model.pins[1].vertices.erase(model.pins[1].vertices.begin(), model.pins[1].vertices.begin() + 9);
  options.integrator = "quasi_static";
  Simulation simulation = simulate(std::move(model), options);
  EXPECT_GE(simulation.step().worst_vertex, half);
}

TEST(Criteria, SoftRegionOfStiffBodyConverges) {
  const auto hung = [](double stiff) {  // the left half is stiff, the right half soft
    const TetMesh mesh = make_box({}, {{0.4, 0.1, 0.1}}, {8, 2, 2});
    std::vector<MaterialParameters> parameters;
    for (const Tet& tet : mesh.tets) {
      double x = 0;
      for (const int v : tet) x += mesh.rest[v][0] / 4;
      parameters.push_back(material_parameters("neo_hookean_log", {.young = x < 0.2 ? stiff : 1e4, .poisson = 0.3}));
    }
    Model model = model_of(mesh)
                      .material("neo_hookean_log", parameters)
                      .pin("wall", [](const Vec3d& X) { return X[0] < 1e-6; })
                      .build();
    SimulationOptions options;
    options.integrator = "quasi_static";
    Simulation simulation = simulate(std::move(model), options);
    const StepReport report = simulation.step();
    EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
    return simulation.state().q;
  };
  EXPECT_LT(largest_distance(hung(1e12), hung(1e10)), 1e-5);  // both are almost rigid
}

// A block of 2 m and a finger of 2 mm of the same material that hangs from one of its corners.
TetMesh block_with_finger() {
  const Vec3d corner{{2, 2, 2}};
  TetMesh mesh = make_box({}, corner, {3, 3, 3});
  const TetMesh finger = make_box(corner, corner + Vec3d{{2e-3, 2e-3, 2e-3}}, {1, 1, 1});
  std::vector<int> number;
  for (const Vec3d& X : finger.rest) {
    const auto same = [&](const Vec3d& Y) { return dot(X - Y, X - Y) < 1e-20; };
    const auto found = std::find_if(mesh.rest.begin(), mesh.rest.end(), same);
    number.push_back(static_cast<int>(found - mesh.rest.begin()));
    if (found == mesh.rest.end()) mesh.rest.push_back(X);
  }
  for (const Tet& tet : finger.tets)
    mesh.tets.push_back({number[tet[0]], number[tet[1]], number[tet[2]], number[tet[3]]});
  return mesh;
}

TEST(Criteria, FingerOnLargeBlockMoves) {
  const auto moved =
      [](double tolerance) {  // displacements of the finger's vertices relative to the corner of the block
        Model model = make_model(block_with_finger(), {.material = "neo_hookean_log", .young = 1e4});
        const int count = model.mesh.vertex_count();
        model.pins.push_back({"floor", vertices_where(model.mesh, [](const Vec3d& X) { return X[1] < 1e-9; }), {}});
        SimulationOptions options{.h = 0.01, .solver = {}};
        options.solver.minimize.tolerance = tolerance;
        Simulation simulation = simulate(std::move(model), options);
        EXPECT_TRUE(is_success(simulation.step().status));
        const std::vector<double>& q = simulation.state().q;
        const int corner = 63;
        std::vector<double> finger;
        for (int v = corner + 1; v < count; ++v)
          for (int r = 0; r < 3; ++r) finger.push_back(q[3 * v + r] - q[3 * corner + r]);
        return finger;
      };
  EXPECT_LT(largest_distance(moved(1e-6), moved(1e-11)), 1e-2 * 2e-3);
}

// The weight of the body is below the round-off of its elastic forces.
TEST(Criteria, ReportsForcesHiddenByRoundOff) {
  const TetMesh mesh = make_box({}, {{0.1, 0.1, 0.1}}, {2, 2, 2});
  Model model = make_model(mesh, {.material = "neo_hookean", .young = 1e19, .poisson = 0.3});
  SimulationOptions options;
  options.initial_guess = "current";
  Simulation simulation = simulate(std::move(model), options);
  const StepReport report = simulation.step();
  EXPECT_NE(report.status, Status::converged);
  EXPECT_GT(report.lost_accuracy, 0);
}

// The residual exceeds a hundredth of inertia, the only exactly known force, because the tolerance is coarse.
TEST(Criteria, CoarseToleranceIsNoRoundOff) {
  const TetMesh mesh = make_box({}, {{0.4, 0.1, 0.1}}, {8, 2, 2});
  Model model = make_model(mesh, {.material = "neo_hookean", .young = 1e5, .poisson = 0.4});
  model.loads.clear();
  State state = at_rest(model.mesh);
  for (size_t i = 0; i < state.q.size(); i += 3) state.q[i] *= 1.5;  // between its pins
  std::vector<int> held;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][0] == 0 || mesh.rest[v][0] == 0.4) held.push_back(v);
  model.pins = {{"ends", held, {}}};
  SimulationOptions options;
  options.h = 0.02;
  options.solver.minimize.tolerance = 1e-4;
  Simulation simulation(std::move(model), state, options);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(simulation.step().status, Status::converged) << i;
}

TEST(Criteria, ReportsVelocitiesLostInTinySteps) {
  const TetMesh mesh = make_box({}, {{1, 0.2, 0.2}}, {4, 1, 1});
  for (const double h : {1e-17, 1e-3}) {
    Model model = make_model(mesh, {});
    model.loads.clear();
    State state{std::vector<double>(3 * mesh.rest.size()), std::vector<double>(3 * mesh.rest.size(), 1.0), 0};
    for (int v = 0; v < mesh.vertex_count(); ++v)
      for (int r = 0; r < 3; ++r) state.q[3 * v + r] = mesh.rest[v][r];
    SimulationOptions options;
    options.h = h;
    Simulation simulation(std::move(model), state, options);
    const StepReport report = simulation.step();
    EXPECT_EQ(report.status == Status::converged, h > 1e-10) << to_string(report.status);
    EXPECT_EQ(report.lost_accuracy == 0, h > 1e-10);
  }
}

// The position of a free body has fewer digits than its acceleration needs: its residual is above the threshold.
TEST(Criteria, ConvergedResidualsAreBelowThreshold) {
  const TetMesh mesh = make_box({{-17.4, 52, -28.3}}, {{32.6, 102, 21.7}}, {2, 2, 2});
  Model model = make_model(mesh, {.material = "linear", .young = 1e6, .poisson = 0.3});
  model.loads.clear();
  State state = at_rest(model.mesh);
  for (size_t i = 0; i < state.qdot.size(); ++i) state.qdot[i] = std::array{-0.732137, -3.162278, 0.9225}[i % 3];
  Simulation simulation(std::move(model), state, {.h = 0.01, .solver = {}});
  int above = 0;
  for (int i = 0; i < 20; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << to_string(report.status);
    const bool is_above = report.residual > report.residual_threshold;
    above += is_above;
    EXPECT_EQ(report.status, is_above ? Status::round_off : Status::converged) << i;
    EXPECT_EQ(report.lost_accuracy > 0, is_above) << i;
  }
  EXPECT_GT(above, 0);
}

}  // namespace
}  // namespace aspic
