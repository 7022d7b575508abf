#include "energy/sheet_elasticity.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "energy/bending_density.h"
#include "energy/membrane_law.h"
#include "mesh/elements.h"

namespace aspic {
namespace {

class SheetElasticity : public TetElasticity, public BendingElements {
 public:
  SheetElasticity(const TetMesh& mesh, int first, const SheetMaterial& material)
      : first_element_(mesh.tet_count() + first) {
    const auto begin = mesh.sheet.begin() + first;
    const std::vector<Triangle> corners(begin, begin + static_cast<std::ptrdiff_t>(material.laws.size()));
    const auto& X = mesh.rest;
    thickness_.assign(mesh.thickness.begin() + first, mesh.thickness.begin() + first + std::ssize(corners));
    for (size_t t = 0; t < corners.size(); ++t)
      triangles_.push_back(make_sheet_triangle(corners[t], rest_corners(mesh, first + static_cast<int>(t))));
    for (const MembraneLaw& law : material.laws) moduli_.emplace_back(law);
    membrane_ = make_membrane(triangles_, material.laws);
    if (!material.bends) return;
    if (material.plates.empty())
      keep(make_hinge_bending(X, corners, material.moment, material.rest));
    else
      keep(
          make_mid_edge_bending({X, corners, material.plates, material.rest, material.first_angle_row, material.held}));
  }

  std::string_view name() const override { return "elastic"; }
  void add_couplings(Couplings& couplings) const override {
    membrane_->add_couplings(couplings);
    if (bending_) bending_->add_couplings(couplings);
  }
  void bind(const BlockPattern& pattern) override {
    membrane_->bind(pattern);
    if (bending_) bending_->bind(pattern);
  }
  double value(Positions x, const Context& context) const override {
    return membrane_->value(x, context) + (bending_ ? bending_->value(x, context) : 0);
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    membrane_->add_gradient(x, context, scale, g);
    if (bending_) bending_->add_gradient(x, context, scale, g);
  }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return membrane_->add_hessian(x, context, scale, projection, H) +
           (bending_ ? bending_->add_hessian(x, context, scale, projection, H) : 0);
  }

  double min_det_F(Positions x) const override {
    double least = std::numeric_limits<double>::infinity();
    for (size_t t = 0; t < triangles_.size(); ++t) least = std::min(least, deformation(t, x).J);
    return least;
  }
  bool excludes_inversion() const override { return true; }
  void evaluate(Positions x, TetFields& fields) const override {
    parallel_for(static_cast<int>(triangles_.size()), [&](int t) { evaluate_triangle(t, x, fields); });
  }

  void add_bending_density(Positions x, std::span<const double>, std::span<double> density) const override {
    std::vector<double> per_area;
    if (bending_per_area_) bending_per_area_(x, per_area);
    for (size_t t = 0; t < per_area.size(); ++t) density[first_element_ + t] += per_area[t] / thickness_[t];
  }

  int parameter_count() const override { return 0; }
  std::vector<MaterialParameters> parameters() const override { return {}; }
  void set_parameters(std::span<const MaterialParameters>) override {}

 private:
  template <class Bending>
  void keep(std::unique_ptr<Bending> bending) {
    bending_per_area_ = [b = bending.get()](Positions x, std::vector<double>& energy) { b->evaluate(x, energy); };
    bending_ = std::move(bending);
  }

  SheetDeformation deformation(size_t t, Positions x) const {
    const auto& [a, b, c] = triangles_[t].corners;
    const auto& B = triangles_[t].rest_inverse;
    const Vec3d p = point(x, b) - point(x, a), q = point(x, c) - point(x, a);
    return {B[0] * p + B[1] * q, B[2] * p + B[3] * q};
  }

  void evaluate_triangle(int t, Positions x, TetFields& fields) const {
    const size_t e = static_cast<size_t>(first_element_) + t;
    const SheetDeformation d = deformation(t, x);
    fields.energy_density[e] = moduli_[t].density(d);
    fields.det_F[e] = d.J;
    const Sym2 S = moduli_[t].stress(d);
    Mat3d cauchy =
        S.xx * outer(d.f1, d.f1) + S.yy * outer(d.f2, d.f2) + S.xy * (outer(d.f1, d.f2) + outer(d.f2, d.f1));  // F S F'
    cauchy = (1 / d.J) * cauchy;
    double* stress = &fields.cauchy[6 * e];
    constexpr int kRow[6] = {0, 1, 2, 0, 1, 2}, kColumn[6] = {0, 1, 2, 1, 2, 0};
    for (int k = 0; k < 6; ++k) stress[k] = cauchy(kRow[k], kColumn[k]);
    const double mean = trace(cauchy) / 3;
    for (int i = 0; i < 3; ++i) cauchy(i, i) -= mean;
    fields.von_mises[e] = std::sqrt(1.5 * squared_norm(cauchy));
  }

  int first_element_;
  std::vector<SheetTriangle> triangles_;
  std::vector<SheetModuli> moduli_;
  std::unique_ptr<Membrane> membrane_;
  std::unique_ptr<SteadyEnergy> bending_;                                  // null: none
  std::function<void(Positions, std::vector<double>&)> bending_per_area_;  // of bending_ [J/m^2]
  std::vector<double> thickness_;                                          // [m]
};

}  // namespace

std::unique_ptr<TetElasticity> make_sheet_elasticity(const TetMesh& mesh, int first, const SheetMaterial& material) {
  return std::make_unique<SheetElasticity>(mesh, first, material);
}

}  // namespace aspic
