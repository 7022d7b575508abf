// The order in time by the affine motion x = A(t) X, A = I + s(t) B: linear tets represent it exactly, so under the
// nodal forces M x'' + dV/dx(x) that keep it going (consistent mass, exact load) all error is that of time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

const Mat3d kB = {{0.3, 0.1, 0, -0.2, 0.1, 0.2, 0.1, 0, -0.2}};
double s(double t) { return std::sin(3 * t + 0.5) - std::sin(0.5); }
Vec3d moved(const Vec3d& X, double t) { return X + s(t) * (kB * X); }
Vec3d velocity(const Vec3d& X, double t) { return 3 * std::cos(3 * t + 0.5) * (kB * X); }
Vec3d acceleration(const Vec3d& X, double t) { return -9 * std::sin(3 * t + 0.5) * (kB * X); }

std::vector<double> at_vertices(const TetMesh& mesh, const std::function<Vec3d(const Vec3d&)>& f) {
  std::vector<double> values;
  for (const Vec3d& X : mesh.rest) {
    const Vec3d v = f(X);
    values.insert(values.end(), {v[0], v[1], v[2]});
  }
  return values;
}

class AffineLoad : public Energy {
 public:
  AffineLoad(const MassMatrix& mass, const TetMesh& mesh, const Energy& elasticity)
      : mass_(mass), mesh_(mesh), elasticity_(elasticity), force_(3 * mesh.rest.size()) {}
  std::string_view name() const override { return "affine_load"; }
  void begin_step(const StepContext& step) override {
    mass_.multiply(at_vertices(mesh_, [&](const Vec3d& X) { return acceleration(X, step.time); }), force_);
    elasticity_.add_gradient(at_vertices(mesh_, [&](const Vec3d& X) { return moved(X, step.time); }), 1, force_);
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
  const Energy& elasticity_;
  std::vector<double> force_;
};

enum class Held { nowhere, on_one_face, on_the_boundary };

// Largest error in position after 0.4 s.
double affine_motion_error(const std::string& integrator, double h, Held held) {
  Model model = make_model(make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2}), {.young = 1e3, .gravity = {}});
  const auto is_held = [held](const Vec3d& X) {
    const auto outer = [](double c) { return c < 1e-9 || c > 1 - 1e-9; };
    return held == Held::on_one_face ? X[0] < 1e-9 : std::any_of(X.a, X.a + 3, outer);
  };
  if (held != Held::nowhere) model.pins.push_back({"held", vertices_where(model.mesh, is_held), moved});
  model.loads.push_back(std::make_unique<AffineLoad>(*model.mass, model.mesh, *model.elasticity[0]));
  State start = at_rest(model.mesh);
  start.qdot = at_vertices(model.mesh, [](const Vec3d& X) { return velocity(X, 0); });
  SimulationOptions options{.h = h, .integrator = integrator, .solver = {}};
  options.solver.minimize.tolerance = 1e-13;
  Simulation simulation(std::move(model), start, options);
  for (int i = 0; i < std::lround(0.4 / h); ++i)
    EXPECT_TRUE(is_success(simulation.step().status)) << integrator << " step " << i;
  const std::vector<double> exact = at_vertices(simulation.model().mesh, [](const Vec3d& X) { return moved(X, 0.4); });
  double error = 0;
  for (size_t i = 0; i < exact.size(); ++i) error = std::max(error, std::abs(simulation.state().q[i] - exact[i]));
  return error;
}

TEST(TemporalOrder, IsThatOfTheSchemeWhereverPinsCarryTheBodyAlong) {
  for (const std::string& integrator : integrator_names()) {
    const auto scheme = make_integrator(integrator);
    if (scheme->is_static()) continue;
    for (const Held held : {Held::nowhere, Held::on_one_face, Held::on_the_boundary}) {
      const double h = scheme->order() == 4 ? 0.04 : 0.01;
      const double coarse = affine_motion_error(integrator, h, held);
      const double fine = affine_motion_error(integrator, h / 2, held);
      EXPECT_NEAR(std::log2(coarse / fine), scheme->order(), 0.2)
          << integrator << " " << static_cast<int>(held) << ": " << coarse << " " << fine;
      EXPECT_GT(fine, 1e-10) << integrator << ": no error to measure an order by";
    }
  }
}

TEST(TemporalOrder, HoldsDownToAFloorOf1em10) {
  EXPECT_LT(affine_motion_error("rk4", 0.0025, Held::on_one_face), 1e-10);
  const double error = affine_motion_error("tr_bdf2", 0.0005, Held::on_one_face);
  EXPECT_NEAR(error * 400, affine_motion_error("tr_bdf2", 0.01, Held::on_one_face), 0.1 * error * 400);
}

}  // namespace
}  // namespace aspic
