// Solutions known exactly: the order in time, and uniform stretch.
#include "dynamics/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

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
  int add_hessian(Positions, double, const Projection&, BlockSparse&) const override { return 0; }

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

}  // namespace
}  // namespace aspic
