#include <algorithm>
#include <cmath>

#include "mesh/generators.h"
#include "verify/integrators.h"

namespace aspic::verify {
namespace {

const Mat3d kB = {{0.3, 0.1, 0, -0.2, 0.1, 0.2, 0.1, 0, -0.2}};
double s(double t) { return std::sin(3 * t + 0.5) - std::sin(0.5); }
Vec3d moved(const Vec3d& X, double t) { return X + s(t) * (kB * X); }
Vec3d velocity(const Vec3d& X, double t) { return 3 * std::cos(3 * t + 0.5) * (kB * X); }
Vec3d acceleration(const Vec3d& X, double t) { return -9 * std::sin(3 * t + 0.5) * (kB * X); }

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

}  // namespace

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
  take_steps(simulation, static_cast<int>(std::lround(0.4 / h)), integrator);
  return largest_difference(simulation.state().q,
                            at_vertices(simulation.model().mesh, [](const Vec3d& X) { return moved(X, 0.4); }));
}

}  // namespace aspic::verify
