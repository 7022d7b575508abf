// Certificate of every step in every scene of the project: the ledger is balanced, and backward Euler keeps its bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dynamics/ledger.h"
#include "dynamics/models_test.h"
#include "scene/scene.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using namespace testing_models;

constexpr int kManyTets = 20'000;

std::vector<fs::path> scene_files() {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(ASPIC_SOURCE_DIR) / "scenes"))
    if (entry.path().extension() == ".toml") found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

double largest_term(const StepReport& report) {
  double largest = std::max({std::abs(report.kinetic), std::abs(report.pin_work), std::abs(report.damping_loss),
                             std::abs(report.numerical_loss), std::abs(report.residual_work)});
  for (const double V : report.potential) largest = std::max(largest, std::abs(V));
  return largest;
}

class CertifiedScene : public testing::TestWithParam<fs::path> {};

TEST_P(CertifiedScene, ClosesItsLedgerAndKeepsTheBound) {
  Scene scene = load_scene(GetParam());
  const int tets = scene.simulation.model().mesh.tet_count();
  for (int i = 0; i < (tets > kManyTets ? 1 : 5); ++i) {
    const StepReport report = scene.simulation.step();
    EXPECT_LE(std::abs(report.ledger_error), 1e-9 * largest_term(report)) << "step " << report.step;
    for (const double x : {report.residual, report.residual_threshold, report.decrement, report.min_det_F,
                           report.objective, report.energy_slack, report.ledger_error})
      EXPECT_TRUE(std::isfinite(x)) << "step " << report.step;
    EXPECT_NE(report.energy_bound, EnergyBound::broken)
        << "step " << report.step << " by " << -report.energy_slack << " J";
    EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, CertifiedScene, testing::ValuesIn(scene_files()),
                         [](const auto& file) { return file.param.stem().string(); });

// For time steps of any length.
TEST(EnergyBound, HoldsForStepsOfAnyLength) {
  for (const double h : {1e-3, 1e-2, 0.1, 1.0, 10.0})
    for (const char* material : {"neo_hookean", "neo_hookean_log", "corotated"}) {
      Simulation simulation = simulate(beam(2, {.material = material, .young = 1e5}), {.h = h, .solver = {}});
      for (int i = 0; i < 5; ++i) {
        const StepReport report = simulation.step();
        EXPECT_EQ(report.energy_bound, EnergyBound::holds) << material << ", h = " << h << ", step " << report.step;
      }
    }
}

// Only elastic energies: the slack of the bound equals the loss in the ledger.
TEST(EnergyBound, EqualsItsDefinition) {
  Simulation simulation = simulate(beam(2));
  double before = simulation.kinetic_energy();
  for (const double V : simulation.potential_energies()) before += V;
  for (int i = 0; i < 5; ++i) {
    const State start = simulation.state();
    const StepReport report = simulation.step();
    std::vector<double> jump = simulation.state().qdot, Mjump(jump.size());
    for (size_t k = 0; k < jump.size(); ++k) jump[k] -= start.qdot[k];
    const double lost = kinetic_energy(simulation.model(), jump, Mjump);
    EXPECT_NEAR(report.energy_slack, before - report.potential_total - lost, 1e-10 * (std::abs(before) + 1));
    before = report.kinetic + report.potential_total;
  }
}

TEST(EnergyBound, IsCheckedOnlyWithAGuarantee) {
  const BoundedEnergies energies{.allowed = 2, .reached = 1, .magnitude = 3};
  EXPECT_EQ(energy_bound(energies, 1.5), EnergyBound::holds);
  EXPECT_EQ(energy_bound(energies, 2.5), EnergyBound::not_guaranteed);
  EXPECT_EQ(energy_bound({.allowed = 2, .reached = 2.1, .magnitude = 3}, 1.5), EnergyBound::broken);
  EXPECT_EQ(energy_bound({.allowed = 2, .reached = 2 + 1e-13, .magnitude = 3}, 2), EnergyBound::holds);
  EXPECT_EQ(energy_bound({.allowed = INFINITY, .reached = 1, .magnitude = 3}, 1.5), EnergyBound::not_guaranteed);
  EXPECT_EQ(energy_bound({.allowed = 2, .reached = 2 + 1e-10, .magnitude = 3}, 2), EnergyBound::broken);
  EXPECT_EQ(energy_bound({.allowed = 2, .reached = 2 + 1e-10, .magnitude = 3, .round_off = 1e-10}, 2),
            EnergyBound::holds);
  Simulation midpoint = simulate(beam(1), {.integrator = "midpoint", .solver = {}});
  EXPECT_EQ(midpoint.step().energy_bound, EnergyBound::none);
}

double energy(const Simulation& simulation) {
  double sum = simulation.kinetic_energy();
  for (const double V : simulation.potential_energies()) sum += V;
  return sum;
}

// With moved pins the initial guess of E differs from the state at the beginning of the step.
TEST(EnergyBound, HoldsWhilePinsMove) {
  for (const double h : {1e-3, 1e-2, 0.1})
    for (const bool is_damped : {false, true}) {
      Model model = damped_beam_with_moving_pins_and_targets();
      if (!is_damped) model.damping.clear();
      Simulation simulation = simulate(std::move(model), {.h = h, .solver = {}});
      for (int i = 0; i < 5; ++i) {
        const StepReport report = simulation.step();
        EXPECT_EQ(report.energy_bound, EnergyBound::holds) << "h = " << h << ", step " << report.step;
        EXPECT_GE(report.energy_slack, 0);
        EXPECT_LE(std::abs(report.ledger_error), 1e-9 * largest_term(report));
      }
    }
}

// All vertices are pinned, so nothing is dissipated: both sides of the bound are equal.
TEST(EnergyBound, IsTightIfAllVerticesArePinned) {
  Model model = beam(1);
  Pin all{.motion = [](const Vec3d& X, double t) { return (1 + t * t) * X; }};
  for (int v = 0; v < model.mesh.vertex_count(); ++v) all.vertices.push_back(v);
  model.pins = {all};
  Simulation simulation = simulate(std::move(model));
  for (int i = 0; i < 5; ++i) {
    const double before = energy(simulation);
    const StepReport report = simulation.step();
    EXPECT_EQ(report.energy_bound, EnergyBound::holds);
    EXPECT_GT(std::abs(energy(simulation) - before), 0);
    EXPECT_NEAR(report.energy_slack, 0, 1e-11 * largest_term(report));
  }
}

// Every substep keeps the bound of its own length.
TEST(EnergyBound, HoldsInEverySubstep) {
  for (const bool moves : {false, true}) {
    Simulation simulation = simulate(moves ? damped_beam_with_moving_pins_and_targets() : beam(2),
                                     {.h = 0.05, .adaptive = {1e-3}, .solver = {}});
    int parts = 0;
    for (int i = 0; i < 3; ++i) {
      const StepReport report = simulation.step();
      EXPECT_EQ(report.energy_bound, EnergyBound::holds) << "step " << report.step;
      EXPECT_GE(report.energy_slack, 0) << "step " << report.step;
      parts += report.substeps;
    }
    EXPECT_GT(parts, 12);
  }
}

// Terrace of the potential: 0 for x < 0, constant height beyond, for each vertex.
class Terrace : public Energy {
 public:
  explicit Terrace(double height /* [J] */) : height_(height) {}
  std::string_view name() const override { return "terrace"; }
  double value(Positions x, const Context&) const override {
    double sum = 0;
    for (size_t i = 0; i < x.size(); i += 3) sum += x[i] < 0 ? 0 : height_;
    return sum;
  }
  void add_gradient(Positions, const Context&, double, std::span<double>) const override {}
  int add_hessian(Positions, const Context&, double, const Projection&, BlockSparse&) const override { return 0; }

 private:
  double height_;
};

// The bound does not limit kinetic + potential energy where E is not convex: a vertex that crosses an edge within a
// step keeps its velocity and gains the height. The ledger reports a negative loss.
TEST(EnergyBound, HoldsOnATerraceWhereEnergyGrows) {
  Model model = make_model(make_box({{-2, 0, 0}}, {{-1, 1, 1}}, {1, 1, 1}), {.gravity = {}});
  const double height = 1;
  model.loads.push_back(std::make_unique<Terrace>(height));
  State state = at_rest(model.mesh);
  for (size_t i = 0; i < state.qdot.size(); i += 3) state.qdot[i] = 5;
  Simulation simulation(std::move(model), std::move(state), {.h = 1, .solver = {}});
  const double before = energy(simulation);
  const StepReport report = simulation.step();
  const double gain = 8 * height;
  EXPECT_EQ(report.energy_bound, EnergyBound::holds);
  EXPECT_NEAR(report.kinetic + report.potential_total - before, gain, 1e-9 * before);
  EXPECT_NEAR(report.numerical_loss, -gain, 1e-9 * before);
  EXPECT_NEAR(report.energy_slack, before - gain, 1e-9 * before);
}

// Strains have the absolute accuracy of eps. The energy of a stiff body that hardly moves is below that.
TEST(EnergyBound, AllowsForRoundOffOfStrains) {
  for (const double offset : {0.0, 1e3, 1e6})
    for (const double h : {1e-6, 1e-4, 1e-2}) {
      TetMesh mesh = make_box({{0, 0, 0}}, {{4, 1, 1}}, {4, 1, 1});
      for (Vec3d& X : mesh.rest) X[0] += offset;
      Model model = make_model(std::move(mesh), {.young = 1e11, .gravity = {}});
      State state = at_rest(model.mesh);
      for (size_t i = 0; i < state.q.size(); ++i) {
        state.q[i] += 1e-8 * std::cos(1.3 * static_cast<double>(i));
        state.qdot[i] = 1e-5 * std::sin(1.7 * static_cast<double>(i));
      }
      Simulation simulation(std::move(model), std::move(state), {.h = h, .solver = {}});
      for (int i = 0; i < 5; ++i) {
        const StepReport report = simulation.step();
        EXPECT_EQ(report.energy_bound, EnergyBound::holds)
            << "offset " << offset << ", h = " << h << ", step " << report.step << " by " << -report.energy_slack
            << " J, " << to_string(report.energy_bound);
      }
    }
}

}  // namespace
}  // namespace aspic
