#include "dynamics/stable_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

TEST(StableStep, SeparatesStableFromUnstableSteps) {
  for (const MassKind mass : {MassKind::consistent, MassKind::lumped}) {
    const double limit = simulate(beam(2, {.mass = mass})).stable_step().h;
    const auto survives = [&](double h) {
      Simulation simulation = simulate(beam(2, {.mass = mass}), {.h = h, .integrator = "symplectic_euler"});
      for (int i = 0; i < 400; ++i)
        if (!is_success(simulation.step().status)) return false;
      return std::isfinite(simulation.kinetic_energy()) && simulation.kinetic_energy() < 1e6;
    };
    EXPECT_TRUE(survives(0.9 * limit)) << limit;
    EXPECT_FALSE(survives(1.15 * limit)) << limit;
  }
}

TEST(StableStep, MatchesSpring) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}), {.young = 1e-6, .mass = MassKind::lumped});
  double lightest = INFINITY;
  int vertex = -1;
  for (int v = 0; v < model.mesh.vertex_count(); ++v)
    if (model.mass->vertex_mass()[v] < lightest) lightest = model.mass->vertex_mass()[v], vertex = v;
  model.loads.push_back(make_point_springs("spring", {{vertex, 1e7, [](double) { return Vec3d{}; }}}));
  const StableStep stable = simulate(std::move(model)).stable_step();
  EXPECT_NEAR(stable.h, 2 / std::sqrt(1e7 / lightest), 1e-3 * stable.h);
  EXPECT_EQ(stable.vertex, vertex);
}

// A single box at 1 cm from the targets of its springs.
Model damped_springs(double c, double k) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}), {.young = 1e-6, .mass = MassKind::lumped});
  for (int v = 0; v < model.mesh.vertex_count(); ++v) {
    const Vec3d target = model.mesh.rest[v] + Vec3d{{0.01, 0, 0}};
    model.loads.push_back(
        make_point_springs("spring", {{v, k * model.mass->vertex_mass()[v], [target](double) { return target; }}}));
  }
  if (c > 0) model.damping.push_back(make_rayleigh_damping(*model.mass, c, nullptr, 0));
  return model;
}

// x'' + c x' + k x = 0: symplectic Euler is stable up to h^2 k + 2 h c = 4.
TEST(StableStep, MatchesDampedSpring) {
  for (const double c : {0.0, 20.0, 1e4}) {
    const double k = 1e4;
    const StableStep stable = simulate(damped_springs(c, k)).stable_step();
    EXPECT_NEAR(stable.h, (std::sqrt(c * c + 4 * k) - c) / k, 1e-3 * stable.h) << c;
    EXPECT_EQ(stable.is_damping, c == 1e4) << c;
  }
}

TEST(StableStep, SeparatesStepsOfDampedBody) {
  const auto damped = [](double h) {
    Model model = beam(2, {.young = 1e5});
    model.damping.push_back(make_rayleigh_damping(*model.mass, 0, model.elasticity[0].get(), 0.02));
    return simulate(std::move(model), {.h = h, .integrator = "symplectic_euler"});
  };
  const StableStep stable = damped(1e-3).stable_step();
  EXPECT_TRUE(stable.is_damping);
  const auto survives = [&](double h) {
    Simulation simulation = damped(h);
    for (int i = 0; i < 400; ++i)
      if (!is_success(simulation.step().status)) return false;
    return std::isfinite(simulation.kinetic_energy()) && simulation.kinetic_energy() < 1e6;
  };
  EXPECT_TRUE(survives(0.9 * stable.h)) << stable.h;
  EXPECT_FALSE(survives(1.15 * stable.h)) << stable.h;
}

double rk4_growth(double c, double k, double h) {  // growth of x'' + c x' + k x = 0 per step
  const std::complex<double> root = std::sqrt(std::complex<double>(c * c - 4 * k));
  double most = 0;
  for (const double sign : {-1.0, 1.0}) {
    const std::complex<double> z = h * (-c + sign * root) / 2.0;
    most = std::max(most, std::abs(1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0));
  }
  return most;
}

TEST(StableStep, Rk4LimitIsWhereGrowthStarts) {
  const double k = 1e4;
  EXPECT_NEAR(rk4_limit(0, k), std::sqrt(8 / k), 1e-12);
  EXPECT_NEAR(rk4_limit(100, 0), 2.785293563405282 / 100, 1e-12);
  EXPECT_EQ(rk4_limit(0, 0), INFINITY);
  for (const double c : {1.0, 20.0, 100.0, 199.0, 200.0, 201.0, 300.0, 1e4}) {  // critical: 200
    const double limit = rk4_limit(c, k);
    for (int i = 1; i < 1000; ++i) EXPECT_LE(rk4_growth(c, k, limit * i / 1000), 1 + 1e-12) << c << ", " << i;
    EXPECT_GT(rk4_growth(c, k, 1.001 * limit), 1) << c;
  }
}

// Near critical damping, rk4 is stable for steps more than twice as long as sqrt(2) times those of symplectic Euler.
TEST(StableStep, Rk4LimitSeparatesStepsOfDampedSprings) {
  for (const double c : {0.0, 20.0, 200.0, 1000.0}) {
    const auto simulation = [&](double h) {
      return simulate(damped_springs(c, 1e4), {.h = h, .integrator = "rk4", .solver = {}});
    };
    const StableStep stable = simulation(1e-3).stable_step();
    EXPECT_NEAR(stable.h, rk4_limit(c, 1e4), 1e-3 * stable.h) << c;
    EXPECT_EQ(stable.is_damping, c > 200) << c;
    const auto survives = [&](double h) {
      Simulation springs = simulation(h);
      for (int i = 0; i < 1000; ++i)
        if (springs.step().status == Status::undefined) return false;
      return springs.kinetic_energy() < 1e6;
    };
    EXPECT_TRUE(survives(0.99 * stable.h)) << c;
    EXPECT_FALSE(survives(1.05 * stable.h)) << c;
  }
}

// V = c / 2h |x - start|^2 for each vertex.
class Dashpots : public Energy {
 public:
  explicit Dashpots(std::vector<double> c /* [kg/s] */) : c_(std::move(c)) {}
  std::string_view name() const override { return "dashpots"; }
  std::unique_ptr<Context> make_context() const override { return std::make_unique<Start>(); }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    static_cast<Start&>(context).x.assign(step.start.begin(), step.start.end());
  }
  double value(Positions x, const Context& context) const override {
    const std::vector<double>& start = static_cast<const Start&>(context).x;
    double sum = 0;
    for (size_t i = 0; i < x.size(); ++i) sum += rate(i, context) / 2 * (x[i] - start[i]) * (x[i] - start[i]);
    return sum;
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    const std::vector<double>& start = static_cast<const Start&>(context).x;
    for (size_t i = 0; i < x.size(); ++i) g[i] += scale * rate(i, context) * (x[i] - start[i]);
  }
  int add_hessian(Positions, const Context& context, double scale, const Projection&, BlockSparse& H) const override {
    for (size_t v = 0; v < c_.size(); ++v)
      for (int r = 0; r < 3; ++r)
        H.block[H.pattern->diagonal(static_cast<int>(v))](r, r) += scale * rate(3 * v, context);
    return 0;
  }

 private:
  struct Start : Context {
    std::vector<double> x;
  };
  double rate(size_t i, const Context& context) const { return context.h > 0 ? c_[i / 3] / context.h : 0; }
  std::vector<double> c_;
};

// One vertex vibrates undamped, the others are critically damped: rk4 and symplectic Euler have different critical
// motions.
TEST(StableStep, Rk4LimitIncludesFastestVibration) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}), {.young = 1e-6, .mass = MassKind::lumped});
  const double k = 1e4, damped_k = 0.25 * k;
  for (int v = 0; v < model.mesh.vertex_count(); ++v)
    model.loads.push_back(make_point_springs(
        "spring", {{v, (v == 0 ? k : damped_k) * model.mass->vertex_mass()[v], [](double) { return Vec3d{}; }}}));
  const auto masses = model.mass->vertex_mass();
  std::vector<double> c(masses.begin(), masses.end());
  for (size_t v = 0; v < c.size(); ++v) c[v] *= v == 0 ? 0 : 2 * std::sqrt(damped_k);
  model.damping.push_back(std::make_unique<Dashpots>(std::move(c)));
  const double limit = simulate(std::move(model), {.integrator = "rk4", .solver = {}}).stable_step().h;
  EXPECT_NEAR(limit, std::sqrt(8 / k), 1e-3 * limit);
}

TEST(StableStep, DependsOnSchemeAndStaysConstant) {
  const auto damped = [](const char* integrator) {
    return simulate(damped_beam_with_moving_pins_and_targets(), {.h = 1e-6, .integrator = integrator});
  };
  Simulation simulation = damped("symplectic_euler");
  const double limit = simulation.stable_step().h;
  simulation.step();
  EXPECT_EQ(simulation.stable_step().h, limit);
  EXPECT_GT(damped("rk4").stable_step().h, 1.2 * limit);
}

}  // namespace
}  // namespace aspic
