// The tets of one material: the energy density as a term of V, output fields, and derivatives with respect to the
// parameters. Included only where it is instantiated.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "energy/make_tet_term.h"
#include "energy/projection_derivative.h"
#include "energy/tet_elasticity.h"
#include "energy/tet_term.h"
#include "math/dual.h"

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
        parameters_(parameters.begin(), parameters.end()) {}

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

  int parameter_count() const override { return parameter_count_; }

  std::span<const MaterialParameters> parameters() const override { return parameters_; }

  void set_parameters(std::span<const MaterialParameters> parameters) override {
    ASPIC_CHECK(parameters.size() == parameters_.size());
    std::copy(parameters.begin(), parameters.end(), parameters_.begin());
    parallel_for(batch_count(), [&](int i) {
      std::array<typename Term::template Params<double>, kPackWidth> lanes;
      for (int l = 0; l < kPackWidth; ++l) lanes[l] = M::params(parameters_[tet(i, l)]);
      for (int q = 0; q < kPoints; ++q) params_[place(i, q)] = pack_params<M>(lanes);
    });
  }

  void add_parameter_force(Positions x, std::span<const double> change, double scale,
                           std::span<double> g) const override {
    for_each_batch([&](int i) {
      const auto rate = [&](int k) { return lanes_of([&](int l) { return change[entry(i, l, k)]; }); };
      const Points F_i = F(i, x);
      batches_[i].scatter_gradient(at_points([&](int q) { return stress_rate(i, at(F_i, q), rate); }),
                                   Pack(scale) * batches_[i].volume, g);
    });
  }

  void add_parameter_gradient(Positions x, std::span<const double> w, double scale,
                              std::span<double> gradient) const override {
    parallel_for(batch_count(), [&](int i) {
      const Points W = F(i, w), F_i = F(i, x);
      const Pack weight = Pack(scale) * batches_[i].volume;
      for (int k = 0; k < parameter_count_; ++k) {
        const auto rate = [&](int j) { return Pack(j == k ? 1.0 : 0.0); };
        Pack work = inner(stress_rate(i, at(F_i, 0), rate), at(W, 0));
        for (int q = 1; q < kPoints; ++q) work += inner(stress_rate(i, at(F_i, q), rate), at(W, q));
        const Pack sum = weight * work;
        for (int l = 0; l < batches_[i].count; ++l) gradient[entry(i, l, k)] += sum[l];
      }
    });
  }

  void add_hessian_derivatives(Positions x, std::span<const double> u, std::span<const double> w,
                               Definiteness definiteness, const HessianDerivatives& out) const override {
    for_each_batch([&](int i) {
      const Points F_i = F(i, x), U = F(i, u), W = F(i, w);
      for (int q = 0; q < kPoints; ++q)
        add_hessian_derivatives({i, q, at(F_i, q)}, at(U, q), at(W, q), definiteness, out);
    });
  }

 private:
  struct QuadraturePoint {
    int batch, q;
    const Mat3<Pack>& F;
  };

  void add_hessian_derivatives(const QuadraturePoint& point, const Mat3<Pack>& U, const Mat3<Pack>& W,
                               Definiteness definiteness, const HessianDerivatives& out) const {
    const Batch& tets = batches_[point.batch];
    const Pack weight = Pack(out.scale) * tets.volume;
    // Adds factor times the derivatives of U : A W, where A = dP/dF.
    const auto add = [&](const Pack& factor, const Mat3<Pack>& left, const Mat3<Pack>& right) {
      if (!out.x.empty()) {
        const Mat3<Pack> rate = second_stress_rate(point.batch, point.F, left, right);
        tets.scatter_gradient(at_points([&](int q) { return q == point.q ? rate : Mat3<Pack>{}; }), factor * weight,
                              out.x);
      }
      for (int k = 0; k < (out.parameters.empty() ? 0 : parameter_count_); ++k) {
        const Pack sum = factor * weight * inner(left, second_parameter_rate(point.batch, point.F, right, k));
        for (int l = 0; l < tets.count; ++l) out.parameters[entry(point.batch, l, k)] += sum[l];
      }
    };
    const unsigned all = (1U << kPackWidth) - 1;
    const Mat9<Pack> A =
        definiteness == Definiteness::exact ? Mat9<Pack>{} : material_.hessian(point.F, params_[place(point.batch, 0)]);
    const unsigned modified = definiteness == Definiteness::exact ? 0 : indefinite_lanes(A) & all;
    if (modified != all) add(lanes_from_bits<Pack>(all & ~modified), U, W);
    if (modified == 0) return;
    const SymmetricEigen<9, Pack> S = modified_product_derivative(A, U, W, definiteness);
    for (int k = 0; k < 9; ++k) {
      Mat3<Pack> direction;
      std::copy(&S.vectors[9 * k], &S.vectors[9 * k] + 9, direction.a);
      add(lanes_from_bits<Pack>(modified) * S.values[k], direction, direction);
    }
  }

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
  int entry(int batch, int lane, int k) const { return parameter_count_ * tet(batch, lane) + k; }

  template <class OfLane>
  static Pack lanes_of(const OfLane& of_lane) {
    Pack a;
    for (int l = 0; l < kPackWidth; ++l) a.set(l, of_lane(l));
    return a;
  }

  // Returns dP for parameter rates rate(k) at constant F.
  template <class Rate>
  Mat3<Pack> stress_rate(int i, const Mat3<Pack>& F_q, const Rate& rate) const {
    return rates(material_.pk1(constant_matrix(F_q), M::params(moving_parameters<Pack>(i, rate))));
  }

  // Returns the derivative of U : A W with respect to F, A = dP/dF: by symmetry the mixed second derivative of P along
  // U and W.
  Mat3<Pack> second_stress_rate(int i, const Mat3<Pack>& F_i, const Mat3<Pack>& U, const Mat3<Pack>& W) const {
    const auto p =
        broadcast_params<M, Dual<Dual<Pack>>, Dual<Pack>>(broadcast_params<M, Dual<Pack>, Pack>(params_[place(i, 0)]));
    return rates(rates(material_.pk1(dual_matrix(dual_matrix(F_i, U), constant_matrix(W)), p)));
  }

  // Returns d(A W)/dtheta_k.
  Mat3<Pack> second_parameter_rate(int i, const Mat3<Pack>& F_i, const Mat3<Pack>& W, int k) const {
    const auto p = moving_parameters<Dual<Pack>>(i, [k](int j) { return Dual<Pack>(j == k ? 1.0 : 0.0); });
    return rates(rates(material_.pk1(constant_matrix(dual_matrix(F_i, W)), M::params(p))));
  }

  // Returns the parameters with rates rate(k).
  template <class T, class Rate>
  MaterialParametersOver<Dual<T>> moving_parameters(int i, const Rate& rate) const {
    MaterialParametersOver<Dual<T>> p;
    const auto moving = [&](int k, auto member) {
      return Dual<T>(T(lanes_of([&](int l) { return member(parameters_[tet(i, l)]); })), rate(k));
    };
    p.lame.mu = moving(0, [](const MaterialParameters& m) { return m.lame.mu; });
    p.lame.lambda = moving(1, [](const MaterialParameters& m) { return m.lame.lambda; });
    for (int k = 2; k < parameter_count_; ++k)
      p.extra[k - 2] = moving(k, [k](const MaterialParameters& m) { return m.extra[k - 2]; });
    return p;
  }

  int first_, parameter_count_;
  std::vector<MaterialParameters> parameters_;  // in the order of the mesh
};

template <class M, class Batch>
std::unique_ptr<TetElasticity> make_tet_term(const TetMesh& mesh, int first,
                                             std::span<const MaterialParameters> parameters) {
  return std::make_unique<MaterialTerm<M, Batch>>("elasticity", mesh, first, parameters);
}

}  // namespace aspic
