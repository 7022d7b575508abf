// Derivatives with respect to the parameters of one material, by automatic differentiation of its stress. Included only
// where it is instantiated.
#pragma once
#include <algorithm>
#include <memory>
#include <utility>

#include "derivatives/of_material.h"
#include "derivatives/projection_derivative.h"
#include "energy/material_term.h"
#include "math/dual.h"

namespace aspic {

template <class M, class Batch>
class MaterialDerivatives : public ParameterDerivatives {
 public:
  explicit MaterialDerivatives(const MaterialTerm<M, Batch>& term) : term_(term) {}

  void add_force(Positions x, std::span<const double> change, double scale, std::span<double> g) const override {
    term_.for_each_batch([&](int i) {
      const auto rate = [&](int k) { return lanes_of([&](int l) { return change[entry(i, l, k)]; }); };
      const Points F_i = term_.F(i, x);
      term_.batches_[i].scatter_gradient(Term::at_points([&](int q) { return stress_rate(i, Term::at(F_i, q), rate); }),
                                         Pack(scale) * term_.batches_[i].volume, g);
    });
  }

  void add_gradient(Positions x, std::span<const double> w, double scale, std::span<double> gradient) const override {
    parallel_for(term_.batch_count(), [&](int i) {
      const Points W = term_.F(i, w), F_i = term_.F(i, x);
      const Pack weight = Pack(scale) * term_.batches_[i].volume;
      for (int k = 0; k < term_.parameter_count_; ++k) {
        const auto rate = [&](int j) { return Pack(j == k ? 1.0 : 0.0); };
        Pack work = inner(stress_rate(i, Term::at(F_i, 0), rate), Term::at(W, 0));
        for (int q = 1; q < kPoints; ++q) work += inner(stress_rate(i, Term::at(F_i, q), rate), Term::at(W, q));
        const Pack sum = weight * work;
        for (int l = 0; l < term_.batches_[i].count; ++l) gradient[entry(i, l, k)] += sum[l];
      }
    });
  }

  void add_hessian_derivatives(Positions x, std::span<const double> u, std::span<const double> w,
                               Definiteness definiteness, const HessianDerivatives& out) const override {
    term_.for_each_batch([&](int i) {
      const Points F_i = term_.F(i, x), U = term_.F(i, u), W = term_.F(i, w);
      for (int q = 0; q < kPoints; ++q)
        add_hessian_derivatives({i, q, Term::at(F_i, q)}, Term::at(U, q), Term::at(W, q), definiteness, out);
    });
  }

 private:
  using Term = MaterialTerm<M, Batch>;
  using Points = typename Batch::Points;
  static constexpr int kPoints = Term::kPoints;

  struct QuadraturePoint {
    int batch, q;
    const Mat3<Pack>& F;
  };

  void add_hessian_derivatives(const QuadraturePoint& point, const Mat3<Pack>& U, const Mat3<Pack>& W,
                               Definiteness definiteness, const HessianDerivatives& out) const {
    const Batch& tets = term_.batches_[point.batch];
    const Pack weight = Pack(out.scale) * tets.volume;
    // Adds factor times the derivatives of U : A W, where A = dP/dF.
    const auto add = [&](const Pack& factor, const Mat3<Pack>& left, const Mat3<Pack>& right) {
      if (!out.x.empty()) {
        const Mat3<Pack> rate = second_stress_rate(point.batch, point.F, left, right);
        tets.scatter_gradient(Term::at_points([&](int q) { return q == point.q ? rate : Mat3<Pack>{}; }),
                              factor * weight, out.x);
      }
      for (int k = 0; k < (out.parameters.empty() ? 0 : term_.parameter_count_); ++k) {
        const Pack sum = factor * weight * inner(left, second_parameter_rate(point.batch, point.F, right, k));
        for (int l = 0; l < tets.count; ++l) out.parameters[entry(point.batch, l, k)] += sum[l];
      }
    };
    const unsigned all = (1U << kPackWidth) - 1;
    const Mat9<Pack> A = definiteness == Definiteness::exact
                             ? Mat9<Pack>{}
                             : term_.material_.hessian(point.F, term_.params_[term_.place(point.batch, 0)]);
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

  int entry(int batch, int lane, int k) const { return term_.parameter_count_ * term_.tet(batch, lane) + k; }

  template <class OfLane>
  static Pack lanes_of(const OfLane& of_lane) {
    Pack a;
    for (int l = 0; l < kPackWidth; ++l) a.set(l, of_lane(l));
    return a;
  }

  // Returns dP for parameter rates rate(k) at constant F.
  template <class Rate>
  Mat3<Pack> stress_rate(int i, const Mat3<Pack>& F_q, const Rate& rate) const {
    return rates(term_.material_.pk1(constant_matrix(F_q), M::params(moving_parameters<Pack>(i, rate))));
  }

  // Returns the derivative of U : A W with respect to F, A = dP/dF: by symmetry the mixed second derivative of P along
  // U and W.
  Mat3<Pack> second_stress_rate(int i, const Mat3<Pack>& F_i, const Mat3<Pack>& U, const Mat3<Pack>& W) const {
    const auto p = broadcast_params<M, Dual<Dual<Pack>>, Dual<Pack>>(
        broadcast_params<M, Dual<Pack>, Pack>(term_.params_[term_.place(i, 0)]));
    return rates(rates(term_.material_.pk1(dual_matrix(dual_matrix(F_i, U), constant_matrix(W)), p)));
  }

  // Returns d(A W)/dtheta_k.
  Mat3<Pack> second_parameter_rate(int i, const Mat3<Pack>& F_i, const Mat3<Pack>& W, int k) const {
    const auto p = moving_parameters<Dual<Pack>>(i, [k](int j) { return Dual<Pack>(j == k ? 1.0 : 0.0); });
    return rates(rates(term_.material_.pk1(constant_matrix(dual_matrix(F_i, W)), M::params(p))));
  }

  // Returns the parameters with rates rate(k).
  template <class T, class Rate>
  MaterialParametersOver<Dual<T>> moving_parameters(int i, const Rate& rate) const {
    MaterialParametersOver<Dual<T>> p;
    const auto moving = [&](int k, auto member) {
      return Dual<T>(T(lanes_of([&](int l) { return member(term_.parameters_[term_.tet(i, l)]); })), rate(k));
    };
    p.lame.mu = moving(0, [](const MaterialParameters& m) { return m.lame.mu; });
    p.lame.lambda = moving(1, [](const MaterialParameters& m) { return m.lame.lambda; });
    for (int k = 2; k < term_.parameter_count_; ++k)
      p.extra[k - 2] = moving(k, [k](const MaterialParameters& m) { return m.extra[k - 2]; });
    return p;
  }

  const Term& term_;
};

template <class M, class Batch>
std::unique_ptr<ParameterDerivatives> derivatives_of_material(const TetElasticity& term) {
  const auto* own = dynamic_cast<const MaterialTerm<M, Batch>*>(&term);
  return own ? std::make_unique<MaterialDerivatives<M, Batch>>(*own) : nullptr;
}

}  // namespace aspic
