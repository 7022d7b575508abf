#include "energy/linear_load.h"

#include <algorithm>

#include "base/parallel.h"
#include "energy/load_points.h"

namespace aspic {
namespace {

class LinearLoad : public Energy {
 public:
  LinearLoad(std::string name, std::vector<double> force, AddForces varying)
      : name_(std::move(name)), constant_(std::move(force)), varying_(std::move(varying)) {}

  std::string_view name() const override { return name_; }
  bool has_constant_gradient() const override { return true; }

  std::unique_ptr<Context> make_context() const override {
    if (!varying_) return Energy::make_context();
    auto forces = std::make_unique<Forces>();
    evaluate(*forces);
    return forces;
  }
  void begin_step(const StepContext& step, Context& context) const override {
    const bool is_other_time = step.time != context.time;
    Energy::begin_step(step, context);
    if (varying_ && is_other_time) evaluate(static_cast<Forces&>(context));
  }

  double value(Positions x, const Context& context) const override {
    const std::span<const double> f = force(context);
    return -parallel_sum(static_cast<int>(f.size()), [&](int first, int last) {
      double sum = 0;
      for (int i = first; i < last; ++i) sum += f[i] * x[i];
      return sum;
    });
  }

  void add_gradient(Positions, const Context& context, double scale, std::span<double> g) const override {
    const std::span<const double> f = force(context);
    parallel_chunks(static_cast<int>(f.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) g[i] -= scale * f[i];
    });
  }

  int add_hessian(Positions, const Context&, double, const Projection&, BlockSparse&) const override { return 0; }

 private:
  struct Forces : Context {
    std::vector<double> force;  // at the time [N]
  };
  void evaluate(Forces& forces) const {
    forces.force.assign(constant_.begin(), constant_.end());
    varying_(forces.time, forces.force);
  }
  std::span<const double> force(const Context& context) const {
    return varying_ ? static_cast<const Forces&>(context).force : constant_;
  }

  std::string name_;
  std::vector<double> constant_;  // [N]
  AddForces varying_;
};

}  // namespace

std::unique_ptr<Energy> make_linear_load(std::string name, std::vector<double> force) {
  return std::make_unique<LinearLoad>(std::move(name), std::move(force), nullptr);
}

std::unique_ptr<Energy> make_linear_load(std::string name, std::vector<double> constant, AddForces varying) {
  return std::make_unique<LinearLoad>(std::move(name), std::move(constant), std::move(varying));
}

void add_body_force(const TetMesh& mesh, int tet, const Vec3d& force_density, std::span<double> force) {
  add_load(
      load_element(mesh, tet), [&](const Vec3d&) { return force_density; }, force);
}

void add_traction(const std::vector<Vec3d>& X, const Face& face, const Vec3d& traction, std::span<double> force) {
  add_load(
      load_element(X, face), [&](const Vec3d&) { return traction; }, force);
}

std::unique_ptr<Energy> make_dead_pressure(const TetMesh& mesh, std::span<const Face> patch, double pressure) {
  std::vector<double> force(3 * mesh.rest.size());
  for (const Face& face : patch) {
    const auto& [a, b, c] = face.corners;
    const Vec3d n = cross(mesh.rest[b] - mesh.rest[a], mesh.rest[c] - mesh.rest[a]);
    add_traction(mesh.rest, face, (-pressure / norm(n)) * n, force);
  }
  return make_linear_load("dead_pressure", std::move(force));
}

}  // namespace aspic
