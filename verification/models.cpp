#include "verification/models.h"

#include <stdexcept>

#include "base/check.h"
#include "math/vectors.h"
#include "mesh/generators.h"

namespace aspic::verify {
namespace {

class PlaneHold : public Energy {
 public:
  PlaneHold(const TetMesh& mesh, double stiffness, int axis, std::vector<int> vertices)
      : stiffness_(stiffness), axis_(axis), vertices_(std::move(vertices)) {
    for (const int v : vertices_) z_.push_back(mesh.rest[v][axis]);
  }
  std::string_view name() const override { return "plane_hold"; }
  double value(Positions x, const Context&) const override {
    double V = 0;
    for (size_t k = 0; k < z_.size(); ++k) V += stiffness_ / 2 * distance(x, k) * distance(x, k);
    return V;
  }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    for (size_t k = 0; k < z_.size(); ++k) g[3 * vertices_[k] + axis_] += scale * stiffness_ * distance(x, k);
  }
  int add_hessian(Positions, const Context&, double scale, const Projection&, BlockSparse& H) const override {
    for (const int v : vertices_) H.block[H.pattern->diagonal(v)](axis_, axis_) += scale * stiffness_;
    return 0;
  }

 private:
  double distance(Positions x, size_t k) const { return x[3 * vertices_[k] + axis_] - z_[k]; }

  double stiffness_;  // [N/m]
  int axis_;
  std::vector<int> vertices_;
  std::vector<double> z_;
};

}  // namespace

std::unique_ptr<Energy> make_plane_hold(const TetMesh& mesh, double stiffness, int axis, std::vector<int> vertices) {
  if (vertices.empty()) vertices = vertices_where(mesh, [](const Vec3d&) { return true; });
  return std::make_unique<PlaneHold>(mesh, stiffness, axis, std::move(vertices));
}

TetMesh make_layer(int length, int height, double thickness,
                   const std::function<std::array<double, 2>(double, double)>& place) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, thickness}}, {length, height, 1});
  for (Vec3d& X : mesh.rest) {
    const auto [x, y] = place(X[0], X[1]);
    X = {{x, y, X[2]}};
  }
  return mesh;
}

PlaneModuli plane_stress(double young, double poisson) {
  return {young * (1 + 2 * poisson) / ((1 + poisson) * (1 + poisson)), poisson / (1 + poisson)};
}

ModelBuilder model_of(TetMesh mesh, const ModelOptions& options) {
  ModelBuilder builder(std::move(mesh));
  builder.material(options.material, {.young = options.young, .poisson = options.poisson})
      .density(options.density)
      .mass(options.mass)
      .gravity(options.gravity);
  return builder;
}

void take_steps(Simulation& simulation, int count, const std::string& what) {
  for (int i = 0; i < count; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status))
      throw std::runtime_error(what + ": step " + std::to_string(report.step) + " did not converge: it is " +
                               std::string(to_string(report.status)));
  }
}

std::vector<Mode> lowest_modes(const Model& model, int count) {
  Modes found = vibration_modes(model, at_rest(model.mesh).q, count);
  if (found.status != ModesStatus::converged) throw std::runtime_error(message(found.status));
  return std::move(found.modes);
}

std::vector<double> frequencies(const Model& model, int count) {
  std::vector<double> found;
  for (const Mode& mode : lowest_modes(model, count)) found.push_back(mode.frequency);
  return found;
}

double largest_difference(std::span<const double> a, std::span<const double> b) {
  ASPIC_CHECK(a.size() == b.size());
  std::vector<double> d(a.size());
  for (size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return max_abs(d);
}

}  // namespace aspic::verify
