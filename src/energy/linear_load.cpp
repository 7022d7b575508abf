#include "energy/linear_load.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace aspic {
namespace {

class LinearLoad : public Energy {
 public:
  LinearLoad(std::string name, std::vector<double> force, AddForces varying)
      : name_(std::move(name)), force_(std::move(force)), varying_(std::move(varying)) {
    if (!varying_) return;
    constant_ = force_;
    varying_(time_, force_);
  }

  std::string_view name() const override { return name_; }
  bool has_constant_gradient() const override { return true; }

  void begin_step(const StepContext& step) override {
    if (!varying_ || step.time == time_) return;
    time_ = step.time;
    std::copy(constant_.begin(), constant_.end(), force_.begin());
    varying_(time_, force_);
  }

  double value(Positions x) const override {
    return -parallel_sum(static_cast<int>(x.size()), [&](int first, int last) {
      double sum = 0;
      for (int i = first; i < last; ++i) sum += force_[i] * x[i];
      return sum;
    });
  }

  void add_gradient(Positions x, double scale, std::span<double> g) const override {
    parallel_chunks(static_cast<int>(x.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) g[i] -= scale * force_[i];
    });
  }

  int add_hessian(Positions, double, const Projection&, BlockSparse&) const override { return 0; }

  bool prepare_vertex_systems(int) override { return true; }
  void add_vertex_systems(Positions, double scale, std::span<const int> vertices, std::span<Vec3d> g,
                          std::span<Mat3d>) const override {
    for (size_t k = 0; k < vertices.size(); ++k)
      for (int r = 0; r < 3; ++r) g[k][r] -= scale * force_[3 * vertices[k] + r];
  }

 private:
  std::string name_;
  std::vector<double> force_;  // at the time [N]
  std::vector<double> constant_;
  AddForces varying_;
  double time_ = 0;
};

}  // namespace

std::unique_ptr<Energy> make_linear_load(std::string name, std::vector<double> force) {
  return std::make_unique<LinearLoad>(std::move(name), std::move(force), nullptr);
}

std::unique_ptr<Energy> make_linear_load(std::string name, std::vector<double> constant, AddForces varying) {
  return std::make_unique<LinearLoad>(std::move(name), std::move(constant), std::move(varying));
}

void add_body_force(const TetMesh& mesh, int tet, const Vec3d& force_density, std::span<double> force) {
  for (const int v : mesh.tets[tet])
    for (int r = 0; r < 3; ++r) force[3 * v + r] += volume(mesh, tet) / 4 * force_density[r];
}

void add_traction(const std::vector<Vec3d>& X, const Triangle& triangle, const Vec3d& traction,
                  std::span<double> force) {
  const auto [a, b, c] = triangle;
  const Vec3d n = cross(X[b] - X[a], X[c] - X[a]);
  const double area = std::sqrt(dot(n, n)) / 2;
  for (const int v : triangle)
    for (int r = 0; r < 3; ++r) force[3 * v + r] += area / 3 * traction[r];
}

}  // namespace aspic
