// The tets of one material: the energy density as a term of V, and output fields. Included only where it is
// instantiated.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "energy/custom_elasticity.h"
#include "energy/make_tet_term.h"
#include "energy/parameter_list.h"
#include "energy/tet_elasticity.h"
#include "energy/tet_term.h"

namespace aspic {

template <class M, class Batch>
class MaterialTerm : public TetTerm<M, TetElasticity, Batch> {
  using Term = TetTerm<M, TetElasticity, Batch>;
  using Points = typename Batch::Points;
  using Term::at, Term::at_points, Term::batch_count, Term::batches_, Term::F, Term::for_each_batch, Term::kPoints;
  using Term::material_, Term::params_, Term::place, Term::reduce;

 public:
  // Uses tets [first, first + parameters.size()) of the mesh.
  MaterialTerm(std::string name, const TetMesh& mesh, int first, std::span<const MaterialParameters> parameters,
               M material = {})
      : Term(std::move(name), mesh, first, own_params(parameters), std::move(material)),
        first_(first),
        parameter_count_(2 + extra_count(Term::material_)),
        parameters_(parameters, parameter_count_) {}

  double min_det_F(Positions x) const override {
    return reduce([&](int i) { return min(Batch::least_determinant(F(i, x))); },
                  [](double a, double b) { return std::min(a, b); }, INFINITY);
  }

  void evaluate(Positions x, TetFields& fields) const override {
    parallel_for(batch_count(), [&](int i) {
      const Points F_i = F(i, x);
      Mat3<Pack> cauchy = stress(i, at(F_i, 0));
      for (int q = 1; q < kPoints; ++q) cauchy = cauchy + stress(i, at(F_i, q));
      constexpr double kShare = 1.0 / kPoints;  // fields are means over the points
      const Pack psi = kShare * this->density_sum(i, F_i, params_);
      const Pack J = Batch::least_determinant(F_i);
      for (int l = 0; l < batches_[i].count; ++l) write(batches_[i].tet[l], l, psi, J, Pack(kShare) * cauchy, fields);
    });
  }

  std::unique_ptr<TetElasticity> on(const TetMesh& mesh) const override {
    if constexpr (requires { M::info(); })
      return make_tet_elasticity(M::info().name, mesh, first_, parameters());
    else if constexpr (requires(M m) { m.density; })
      return custom_material(std::string(this->name()), material_.extra, material_.density)(mesh, first_, parameters());
    else
      return nullptr;
  }

  int parameter_count() const override { return parameter_count_; }

  std::vector<MaterialParameters> parameters() const override { return parameters_.all(); }

  void set_parameters(std::span<const MaterialParameters> parameters) override {
    parameters_.set(parameters);
    parallel_for(batch_count(), [&](int i) {
      std::array<typename Term::template Params<double>, kPackWidth> lanes;
      for (int l = 0; l < kPackWidth; ++l) lanes[l] = M::params(parameters_[tet(i, l)]);
      for (int q = 0; q < kPoints; ++q) params_[place(i, q)] = pack_params<M>(lanes);
    });
  }

 private:
  template <class, class>
  friend class MaterialDerivatives;  // with respect to the parameters, in the package of inverse problems

  Mat3<Pack> stress(int i, const Mat3<Pack>& F_q) const {  // Cauchy stress
    return (Pack(1.0) / determinant(F_q)) * (material_.pk1(F_q, params_[place(i, 0)]) * transpose(F_q));
  }

  // Returns the number of entries of MaterialParameters::extra that the material uses.
  static int extra_count(const M& material) {
    if constexpr (requires { M::info(); })
      return static_cast<int>(M::info().extra.size());
    else
      return material.extra;
  }

  static std::vector<typename Term::template Params<double>> own_params(
      std::span<const MaterialParameters> parameters) {
    std::vector<typename Term::template Params<double>> own;
    own.reserve(parameters.size());
    for (const MaterialParameters& p : parameters) own.push_back(M::params(p));
    return own;
  }

  static void write(int tet, int lane, Pack psi, Pack J, const Mat3<Pack>& s, TetFields& fields) {
    fields.energy_density[tet] = psi[lane];
    fields.det_F[tet] = J[lane];
    const double xx = s(0, 0)[lane], yy = s(1, 1)[lane], zz = s(2, 2)[lane];
    const double xy = s(0, 1)[lane], yz = s(1, 2)[lane], zx = s(2, 0)[lane];
    const double components[6] = {xx, yy, zz, xy, yz, zx};
    std::copy(components, components + 6, &fields.cauchy[6 * tet]);
    fields.von_mises[tet] = std::sqrt(0.5 * ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) +
                                      3 * (xy * xy + yz * yz + zx * zx));
  }

  int tet(int batch, int lane) const { return batches_[batch].tet[lane] - first_; }

  int first_, parameter_count_;
  ParameterList parameters_;  // in the order of the mesh
};

template <class M, class Batch>
std::unique_ptr<TetElasticity> make_tet_term(const TetMesh& mesh, int first,
                                             std::span<const MaterialParameters> parameters) {
  return std::make_unique<MaterialTerm<M, Batch>>("elasticity", mesh, first, parameters);
}

}  // namespace aspic
