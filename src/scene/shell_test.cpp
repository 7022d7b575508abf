// Shells of mid-edge bending in scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "contact/barrier.h"
#include "dynamics/step_derivatives.h"
#include "mesh/topology.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;

const std::string kShellFlag = R"(
gravity = [0.0, 0.0, -9.81]
[time]
duration = 0.2
step = 0.02
[[body]]
name = "flag"
shape = { rectangle = { width = 1.0, height = 0.5, size = 0.12 } }
shell = { thickness = 0.002, bending = "mid_edge" }
material = { young = 1e6, poisson = 0.3, density = 300 }
damping = { mass = 0.1, stiffness = 0.001 }
[[body.pin]]
name = "wall"
where = "X < -0.4"
)";

const std::string kShellBlock = R"(
[[body]]
name = "block"
shape = { box = { upper = [0.2, 0.2, 0.2], cells = [2, 2, 2] } }
translate = [0.0, 2.0, 0.0]
)";

int edge_count(const TetMesh& mesh) {
  int count = 0;
  for_each_edge(edge_uses(mesh.sheet), [&](const EdgeUse*, const EdgeUse*) { ++count; });
  return count;
}

void run_shell(Simulation& simulation, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(is_success(simulation.step().status)) << i;
}

TEST(Shell, AnglesFollowTheVerticesOfAllBodies) {
  Scene scene = load(kShellFlag + kShellBlock);
  const Model& model = scene.simulation.model();
  ASSERT_EQ(static_cast<int>(model.angle_rows.size()), (edge_count(model.mesh) + 2) / 3);
  EXPECT_EQ(scene.simulation.state().q.size(), 3 * static_cast<size_t>(model.rows()));
  double mass = 0;
  for (const double m : model.mass->vertex_mass()) mass += m;
  EXPECT_NEAR(mass, 300 * 0.002 * 0.5 + 1000 * 0.008, 1e-9);  // without rotary inertia
  run_shell(scene.simulation, 3);
  const std::vector<double>& q = scene.simulation.state().q;
  double largest = 0;
  for (size_t i = 3 * model.mesh.rest.size(); i < q.size(); ++i) largest = std::max(largest, std::abs(q[i]));
  EXPECT_GT(largest, 1e-6);
  EXPECT_LT(largest, 0.12);
}

TEST(Shell, DerivativesOfAStepMatchDifferences) {
  Scene scene = load(kShellFlag + kShellBlock);
  run_shell(scene.simulation, 2);
  for (const TermDerivatives& of : check_step_derivatives(scene.simulation, 1e-6))
    EXPECT_TRUE(of.report.passed()) << of.term << " " << of.state;
}

TEST(Shell, LedgerCloses) {
  Scene scene = load(kShellFlag);
  for (int i = 0; i < 5; ++i) {
    const StepReport report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status));
    EXPECT_LT(std::abs(report.ledger_error), 1e-13 * std::abs(report.potential_total));
    EXPECT_GT(report.damping_loss, 0);
  }
}

TEST(Shell, EqualBitsForAnyThreadCount) {
  const int before = thread_count();
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    Scene scene = load(kShellFlag, {"solver.linear=\"multigrid\""});
    run_shell(scene.simulation, 3);
    hashes.push_back(scene.simulation.state_hash());
  }
  set_thread_count(before);
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Shell, MultigridNeedsFewCycles) {
  std::vector<double> last;
  for (const char* linear : {"cholesky", "multigrid"}) {
    Scene scene = load(kShellFlag, {"body.shape.rectangle.size=0.03", "solver.linear=\"" + std::string(linear) + "\"",
                                    "solver.tolerance=1e-9"});
    for (int i = 0; i < 2; ++i) {
      const StepReport report = scene.simulation.step();
      ASSERT_TRUE(is_success(report.status));
      EXPECT_LE(report.cycles, 12 * report.factorizations) << linear;  // block_jacobi: over 60
    }
    const std::vector<double> q = positions(scene);
    for (size_t i = 0; i < last.size(); ++i) EXPECT_NEAR(q[i], last[i], 1e-6) << i;
    last = q;
  }
}

TEST(Shell, HashContainsTheAngles) {
  Scene scene = load(kShellFlag);
  const std::uint64_t hash = scene.simulation.state_hash();
  Simulation::Snapshot snapshot = scene.simulation.snapshot();
  snapshot.state.q.back() += 1e-3;
  scene.simulation.restore(snapshot);
  EXPECT_NE(scene.simulation.state_hash(), hash);
}

TEST(Shell, RestoredSimulationContinuesWithTheSameBits) {
  Scene scene = load(kShellFlag);
  run_shell(scene.simulation, 2);
  const Simulation::Snapshot snapshot = scene.simulation.snapshot();
  run_shell(scene.simulation, 2);
  const std::uint64_t hash = scene.simulation.state_hash();
  scene.simulation.restore(snapshot);
  run_shell(scene.simulation, 2);
  EXPECT_EQ(scene.simulation.state_hash(), hash);
}

TEST(Shell, IntegratorsAndGuessesAdvanceAngles) {
  const auto hash_after = [](const std::vector<std::string>& overrides) {
    Scene scene = load(kShellFlag, overrides);
    run_shell(scene.simulation, 3);
    const std::vector<double>& q = scene.simulation.state().q;
    EXPECT_TRUE(std::all_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); }));
    return scene.simulation.state_hash();
  };
  for (const char* integrator : {"bdf2", "tr_bdf2", "midpoint", "trapezoid", "quasi_static"})
    EXPECT_NE(hash_after({"time.integrator=\"" + std::string(integrator) + "\""}), 0U) << integrator;
  for (const char* integrator : {"symplectic_euler", "rk4"})
    hash_after({"time.integrator=\"" + std::string(integrator) + "\"", "time.step=2e-4", "body.damping={}"});
  for (const char* guess : {"zero", "current", "last_increment"})
    hash_after({"solver.initial_guess=\"" + std::string(guess) + "\""});
  hash_after({"time.adaptive.tolerance=1e-3"});
}

TEST(Shell, MomentScalesTheBendingStiffness) {
  const auto sag = [](const std::string& moment) {
    Scene scene = load(kShellFlag, {"time.integrator=\"quasi_static\"", "gravity=[0, 0, -1e-5]",
                                    "body.shell={thickness=0.002, bending=\"mid_edge\"" + moment + "}"});
    EXPECT_TRUE(is_success(scene.simulation.step().status));
    const std::vector<double>& q = scene.simulation.state().q;
    double low = 0;
    for (int v = 0; v < scene.simulation.model().mesh.vertex_count(); ++v) low = std::min(low, q[3 * v + 2]);
    return low;
  };
  const double D = 1e6 * 8e-9 / (12 * (1 - 0.09)), reference = sag("");
  EXPECT_NEAR(sag(", moment=" + std::to_string(1e6 * D) + "e-6"), reference, 1e-4 * std::abs(reference));
  EXPECT_NEAR(sag(", moment=" + std::to_string(2e6 * D) + "e-6"), reference / 2, 1e-4 * std::abs(reference));
}

TEST(Shell, FallsOntoAnObstacle) {
  Scene scene = load(R"(
gravity = [0.0, 0.0, -9.81]
[time]
duration = 0.3
step = 0.01
[[body]]
name = "cloth"
shape = { rectangle = { width = 0.3, height = 0.3, size = 0.04 } }
shell = { thickness = 0.001, bending = "mid_edge" }
material = { young = 1e6, poisson = 0.3, density = 300 }
translate = [0.0, 0.0, 0.02]
[[obstacle]]
name = "floor"
plane = { normal = [0.0, 0.0, 1.0] }
)");
  for (int i = 0; i < 12; ++i) {
    const StepReport report = scene.simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i;
    EXPECT_LT(std::abs(report.ledger_error), 1e-12);
  }
  EXPECT_GT(scene.simulation.model().contact->summary(scene.simulation.state().q, 0).contacts, 0);
}

TEST(Shell, RejectsZeroMoment) {
  EXPECT_THAT(refusal(kShellFlag, {"body.shell.moment=0"}), HasSubstr("needs a positive one"));
}

TEST(Shell, RejectsEdgesOfThreeTriangles) {
  const TestFolder folder;
  folder.write("junction.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 2 1 5\n");
  const auto scene = folder.write("junction.toml", R"(
[time]
duration = 1.0
step = 0.01
[[body]]
mesh = "junction.obj"
shell = { thickness = 0.01, bending = "mid_edge" }
material = { young = 1e6, poisson = 0.3, density = 300 }
)");
  EXPECT_THAT(refusal_of(scene), HasSubstr("an edge of 3 triangles"));
}

}  // namespace
}  // namespace aspic
