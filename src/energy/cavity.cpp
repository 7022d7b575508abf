#include "energy/cavity.h"

#include <cmath>
#include <utility>

#include "base/error.h"
#include "energy/swept_volume.h"

namespace aspic {
namespace {

class FilledCavity : public Cavity {
 public:
  FilledCavity(std::string name, const TetMesh& mesh, std::span<const Face> patch, CavityContent content)
      : name_(std::move(name)), swept_(mesh, patch), rest_(cavity_volume(mesh, patch)), content_(std::move(content)) {}

  void set_start(Positions x) {
    const double start = volume(x);
    if (!(start > 0))
      throw InvalidInput(name_ + ": its faces enclose no cavity at the start, but " + std::to_string(start) +
                         " m^3; select the faces of one inner surface");
    unit_ = content_.volume > 0 ? content_.volume : start;
  }

  std::string_view name() const override { return name_; }
  CavityState state(Positions x, double time) const override {
    const double v = volume(x);
    return {v, pressure(v, content_.amount(time))};
  }

  double value(Positions x, const Context& context) const override {
    const double v = volume(x), r = v / unit_, a = content_.amount(context.time);
    if (!(r > 0)) return INFINITY;
    if (is_liquid()) return content_.modulus * unit_ / 2 * (r - a) * (r - a);
    return content_.modulus * unit_ * (r - 1 - a * std::log(r));
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    swept_.add_gradient(x, scale * pressure(volume(x), content_.amount(context.time)), g);
  }
  void add_couplings(Couplings& couplings) const override { swept_.add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { swept_.bind(pattern); }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return swept_.add_hessian(x, pressure(volume(x), content_.amount(context.time)), scale, projection, H);
  }
  void add_dense_rows(Positions x, const Context& context, double scale, DenseRows& rows) const override {
    const double v = volume(x), a = content_.amount(context.time);
    const double stiffness = content_.modulus * (is_liquid() ? 1 / unit_ : a * unit_ / (v * v));  // -dp/dv
    if (stiffness <= 0) return;
    DenseRow& row = rows.emplace_back(DenseRow{std::vector<double>(x.size()), scale * stiffness});
    swept_.add_gradient(x, 1, row.g);
  }

 private:
  bool is_liquid() const { return content_.kind == CavityContent::liquid; }
  double volume(Positions x) const { return rest_ - swept_.value(x); }
  double pressure(double v, double a) const {
    return content_.modulus * (is_liquid() ? a - v / unit_ : a * unit_ / v - 1);
  }

  std::string name_;
  SweptVolume swept_;
  double rest_, unit_ = 0;  // volume at rest, and v_0 [m^3]
  CavityContent content_;
};

}  // namespace

double cavity_volume(const TetMesh& mesh, std::span<const Face> patch) {
  double volume = 0;
  for (const Face& face : patch) {
    const auto [a, b, c] = face.corners;
    const Vec3d &X = mesh.rest[patch[0].corners[0]], A = mesh.rest[a] - X, B = mesh.rest[b] - X, C = mesh.rest[c] - X;
    volume -= dot(A, cross(B, C)) / 6;
  }
  return volume;
}

std::unique_ptr<Cavity> make_cavity(std::string name, const TetMesh& mesh, std::span<const Face> patch,
                                    CavityContent content, Positions start) {
  auto cavity = std::make_unique<FilledCavity>(std::move(name), mesh, patch, std::move(content));
  cavity->set_start(start);
  return cavity;
}

}  // namespace aspic
