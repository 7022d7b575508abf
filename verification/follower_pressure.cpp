#include "verification/follower_pressure.h"

#include <algorithm>
#include <stdexcept>

#include "energy/quadratic_face.h"
#include "math/vectors.h"

namespace aspic::verify {
namespace {

class FollowerPressure : public Energy {
 public:
  FollowerPressure(std::vector<Face> patch, std::function<double(double)> pressure)
      : patch_(std::move(patch)), pressure_(std::move(pressure)) {}

  std::string_view name() const override { return "follower_pressure"; }
  bool has_constant_gradient() const override { return true; }
  std::unique_ptr<Context> make_context() const override { return std::make_unique<Frozen>(); }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    auto& force = static_cast<Frozen&>(context).force;
    force = pressure_forces(patch_, step.start);
    for (double& f : force) f *= pressure_(step.time);
  }
  double value(Positions x, const Context& context) const override {
    double work = 0;
    const auto& force = static_cast<const Frozen&>(context).force;
    for (size_t i = 0; i < force.size(); ++i) work += force[i] * x[i];
    return -work;
  }
  void add_gradient(Positions, const Context& context, double scale, std::span<double> g) const override {
    const auto& force = static_cast<const Frozen&>(context).force;
    for (size_t i = 0; i < force.size(); ++i) g[i] -= scale * force[i];
  }
  int add_hessian(Positions, const Context&, double, const Projection&, BlockSparse&) const override { return 0; }

 private:
  struct Frozen : Context {
    std::vector<double> force;
  };

  std::vector<Face> patch_;
  std::function<double(double)> pressure_;
};

}  // namespace

std::vector<double> pressure_forces(std::span<const Face> patch, Positions x) {
  std::vector<double> force(x.size());
  const auto add = [&](const FacePoint& at, std::span<const int> nodes) {
    std::array<Vec3d, 3> corner{};
    for (int k = 0; k < 3; ++k)
      for (size_t n = 0; n < nodes.size(); ++n) corner[k] = corner[k] + at.shares[k][n] * point(x, nodes[n]);
    const Vec3d inward = (-0.5 * at.weight) * cross(corner[1] - corner[0], corner[2] - corner[0]);
    for (size_t n = 0; n < nodes.size(); ++n) {
      const double share = (at.shares[0][n] + at.shares[1][n] + at.shares[2][n]) / 3;
      for (int r = 0; r < 3; ++r) force[3 * nodes[n] + r] += share * inward[r];
    }
  };
  for (const Face& face : patch) {
    if (face.is_quadratic()) {
      for (const FacePoint& at : kFacePoints) add(at, nodes_of(face));
    } else {
      add(kLinearPoint, face.corners);
    }
  }
  return force;
}

std::unique_ptr<Energy> make_follower_pressure(std::vector<Face> patch, std::function<double(double time)> pressure) {
  return std::make_unique<FollowerPressure>(std::move(patch), std::move(pressure));
}

Simulation follower_equilibrium(Model model, int steps, const std::string& what, double steady) {
  constexpr int kMostRepeats = 60;
  SimulationOptions options{.h = 1.0 / steps, .integrator = "quasi_static", .solver = {}};
  options.solver.minimize.tolerance = 1e-8;
  Simulation simulation = simulate(std::move(model), options);
  const std::vector<double> rest = simulation.state().q;
  take_steps(simulation, steps, what);
  for (int repeat = 0; repeat < kMostRepeats; ++repeat) {
    const std::vector<double> before = simulation.state().q;
    take_steps(simulation, 1, what);
    if (largest_difference(before, simulation.state().q) < steady * largest_difference(rest, before)) return simulation;
  }
  throw std::runtime_error(what + ": the follower pressure did not become steady");
}

std::vector<Face> faces_where(const TetMesh& mesh, const Predicate& is_part) {
  std::vector<Face> patch = boundary_faces(mesh, 0, mesh.tet_count());
  std::erase_if(patch, [&](const Face& face) {
    return !std::all_of(face.corners.begin(), face.corners.end(), [&](int v) { return is_part(mesh.rest[v]); });
  });
  return patch;
}

}  // namespace aspic::verify
