#include "verify/layers.h"

#include "mesh/generators.h"

namespace aspic::verify {
namespace {

class PlaneHold : public Energy {
 public:
  PlaneHold(const TetMesh& mesh, double stiffness, int axis) : stiffness_(stiffness), axis_(axis) {
    for (const Vec3d& X : mesh.rest) z_.push_back(X[axis]);
  }
  std::string_view name() const override { return "plane_hold"; }
  double value(Positions x) const override {
    double V = 0;
    for (size_t v = 0; v < z_.size(); ++v)
      V += stiffness_ / 2 * (x[3 * v + axis_] - z_[v]) * (x[3 * v + axis_] - z_[v]);
    return V;
  }
  void add_gradient(Positions x, double scale, std::span<double> g) const override {
    for (size_t v = 0; v < z_.size(); ++v) g[3 * v + axis_] += scale * stiffness_ * (x[3 * v + axis_] - z_[v]);
  }
  int add_hessian(Positions, double scale, const Projection&, BlockSparse& H) const override {
    for (size_t v = 0; v < z_.size(); ++v)
      H.block[H.pattern->diagonal(static_cast<int>(v))](axis_, axis_) += scale * stiffness_;
    return 0;
  }

 private:
  double stiffness_;  // [N/m]
  int axis_;
  std::vector<double> z_;
};

}  // namespace

std::unique_ptr<Energy> make_plane_hold(const TetMesh& mesh, double stiffness, int axis) {
  return std::make_unique<PlaneHold>(mesh, stiffness, axis);
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

}  // namespace aspic::verify
