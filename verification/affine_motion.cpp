#include <algorithm>
#include <cmath>

#include "mesh/generators.h"
#include "verification/integrators.h"

namespace aspic::verify {
namespace {

const Mat3d kB = {{0.3, 0.1, 0, -0.2, 0.1, 0.2, 0.1, 0, -0.2}};
double s(double t) { return std::sin(3 * t + 0.5) - std::sin(0.5); }
Vec3d moved(const Vec3d& X, double t) { return X + s(t) * (kB * X); }
Vec3d velocity(const Vec3d& X, double t) { return 3 * std::cos(3 * t + 0.5) * (kB * X); }
Vec3d acceleration(const Vec3d& X, double t) { return -9 * std::sin(3 * t + 0.5) * (kB * X); }

class AffineLoad : public Energy {
 public:
  AffineLoad(const MassMatrix& mass, const TetMesh& mesh, const TetElasticity& elasticity)
      : mass_(mass), mesh_(mesh), elasticity_(elasticity) {}
  std::string_view name() const override { return "affine_load"; }
  std::unique_ptr<Context> make_context() const override { return std::make_unique<Force>(); }
  void begin_step(const StepContext& step, Context& context) const override {
    std::vector<double>& f = static_cast<Force&>(context).f;
    f.resize(3 * mesh_.rest.size());
    mass_.multiply(at_vertices(mesh_, [&](const Vec3d& X) { return acceleration(X, step.time); }), f);
    elasticity_.add_gradient(at_vertices(mesh_, [&](const Vec3d& X) { return moved(X, step.time); }), 1, f);
  }
  double value(Positions x, const Context& context) const override {
    const std::vector<double>& f = static_cast<const Force&>(context).f;
    double V = 0;
    for (size_t i = 0; i < f.size(); ++i) V -= f[i] * x[i];
    return V;
  }
  void add_gradient(Positions, const Context& context, double scale, std::span<double> g) const override {
    const std::vector<double>& f = static_cast<const Force&>(context).f;
    for (size_t i = 0; i < f.size(); ++i) g[i] -= scale * f[i];
  }
  int add_hessian(Positions, const Context&, double, const Projection&, BlockSparse&) const override { return 0; }

 private:
  struct Force : Context {
    std::vector<double> f;  // forces at the current time [N]; empty before the first step
  };

  const MassMatrix& mass_;
  TetMesh mesh_;
  const TetElasticity& elasticity_;
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
