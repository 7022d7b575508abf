#include "derivatives/mean_volume_derivatives.h"

#include <algorithm>
#include <vector>

#include "derivatives/projection_derivative.h"
#include "energy/mean_volume_term.h"

namespace aspic {
namespace mean_volume {
namespace {

Vec3<Pack> column(const Mat3<Pack>& A, int c) { return {{A(0, c), A(1, c), A(2, c)}}; }

// Derivative of the cofactor of F along U; symmetric in F and U.
Mat3<Pack> cofactor_rate(const Mat3<Pack>& F, const Mat3<Pack>& U) {
  Mat3<Pack> rate;
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3, e = (c + 2) % 3;
    const Vec3<Pack> sum = cross(column(F, d), column(U, e)) + cross(column(U, d), column(F, e));
    for (int r = 0; r < 3; ++r) rate(r, c) = sum[r];
  }
  return rate;
}

struct Directions {
  int q;
  Pack factor;
  Mat3<Pack> left, right;
};

// U and W where the Hessian of p J is not modified, and the directions of the derivative of the modified product.
std::vector<Directions> directions(const Points& F, Pack p, const Points& U, const Points& W,
                                   Definiteness definiteness) {
  std::vector<Directions> pairs;
  for (int q = 0; q < kPoints; ++q) {
    if (definiteness == Definiteness::exact) {
      pairs.push_back({q, Pack(1.0), U[q], W[q]});
      continue;
    }
    const SymmetricEigen<9, Pack> S =
        modified_product_derivative(GivenPressure::hessian(F[q], {p}), U[q], W[q], definiteness);
    for (int k = 0; k < 9; ++k) {
      Mat3<Pack> direction;
      std::copy(&S.vectors[9 * k], &S.vectors[9 * k] + 9, direction.a);
      pairs.push_back({q, S.values[k], direction, direction});
    }
  }
  return pairs;
}

}  // namespace

class MeanVolumeDerivatives : public ParameterDerivatives {
 public:
  explicit MeanVolumeDerivatives(const MeanVolume& term)
      : term_(term),
        volume_(term.volume_),
        shape_(derivatives_of(*term.shape_)),
        nodes_(term.nodes_ ? derivatives_of(*term.nodes_) : nullptr) {}

  void add_force(Positions x, std::span<const double> change, double scale, std::span<double> g) const override {
    std::vector<double> pointwise_change(change.begin(), change.end());
    std::vector<double> bulk_change(parameters().size(), 0.0);
    for (size_t t = 0; t < parameters().size(); ++t) {
      double& lambda = pointwise_change[entry(t) + 1];
      if (!is_split(parameters()[t].lame)) continue;
      lambda = kPointwise * change[entry(t)];
      bulk_change[t] = change[entry(t) + 1] - lambda;
    }
    shape_->add_force(x, pointwise_change, scale, g);
    if (nodes_) nodes_->add_force(x, pointwise_change, scale, g);
    if (volume_.is_active()) add_bulk_force(x, bulk_change, scale, g);
  }

  void add_gradient(Positions x, std::span<const double> w, double scale, std::span<double> gradient) const override {
    std::vector<double> own(gradient.size(), 0.0), by_bulk(parameters().size(), 0.0);
    shape_->add_gradient(x, w, scale, own);
    if (nodes_) nodes_->add_gradient(x, w, scale, own);
    if (volume_.is_active()) add_bulk_gradient(x, w, scale, by_bulk);
    add_chained(own, by_bulk, gradient);
  }

  void add_hessian_derivatives(Positions x, std::span<const double> u, std::span<const double> w,
                               Definiteness definiteness, const HessianDerivatives& out) const override {
    std::vector<double> own(out.parameters.size(), 0.0), by_bulk(parameters().size(), 0.0);
    shape_->add_hessian_derivatives(x, u, w, definiteness, {out.scale, out.x, own});
    if (nodes_) nodes_->add_hessian_derivatives(x, u, w, definiteness, {out.scale, out.x, own});
    if (volume_.is_active()) add_volume_derivatives(x, u, w, definiteness, {out.scale, out.x, by_bulk});
    if (!out.parameters.empty()) add_chained(own, by_bulk, out.parameters);
  }

 private:
  const ParameterList& parameters() const { return term_.parameters_; }
  size_t entry(size_t tet) const { return term_.parameter_count() * tet; }
  int tet(int batch, int lane) const { return volume_.batches_[batch].tet[lane] - volume_.first_; }

  // g += scale sum over tets of change (mean J - 1) d(volume mean J)/dx
  void add_bulk_force(Positions x, std::span<const double> change, double scale, std::span<double> g) const {
    const auto of_batch = [&](int i) {
      Pack rate;
      for (int l = 0; l < kPackWidth; ++l) rate.set(l, change[tet(i, l)]);
      return rate * (mean_J(volume_.F(i, x)) - 1.0);
    };
    volume_.VolumeTerm::Term::add_gradient(x, volume_.pressures(of_batch), scale, g);
  }

  // Sets `gradient` to scale d(w . dV/dx)/dK.
  void add_bulk_gradient(Positions x, std::span<const double> w, double scale, std::span<double> gradient) const {
    parallel_for(volume_.batch_count(), [&](int i) {
      const Points F = volume_.F(i, x);
      const Pack rate = volume_.tet_volume(i) * (mean_J(F) - 1.0) * mean_J_rate(F, volume_.F(i, w));
      for (int l = 0; l < volume_.batches_[i].count; ++l) gradient[tet(i, l)] = scale * rate[l];
    });
  }

  // Adds the derivatives of scale u . H w with respect to x and K.
  void add_volume_derivatives(Positions x, std::span<const double> u, std::span<const double> w,
                              Definiteness definiteness, const HessianDerivatives& out) const {
    volume_.for_each_batch([&](int i) {
      const auto& tets = volume_.batches_[i];
      const Points F = volume_.F(i, x), U = volume_.F(i, u), W = volume_.F(i, w);
      const Pack K = volume_.bulk_[i], change = mean_J(F) - 1.0;
      const Pack u_rate = mean_J_rate(F, U), w_rate = mean_J_rate(F, W);
      // Geometric part: the sum of factor p left : d2J right over pairs of directions.
      Pack curvature = Pack(0.0);  // mean of factor left : d2J right
      Points rate;
      for (int q = 0; q < kPoints; ++q)
        rate[q] = K * (w_rate * cofactor_rate(F[q], U[q]) + u_rate * cofactor_rate(F[q], W[q]));
      for (const Directions& pair : directions(F, K * change, U, W, definiteness)) {
        curvature += Pack(1.0 / kPoints) * pair.factor * inner(cofactor_rate(F[pair.q], pair.left), pair.right);
        rate[pair.q] = rate[pair.q] + (pair.factor * K * change) * cofactor_rate(pair.left, pair.right);
      }
      for (int q = 0; q < kPoints; ++q) rate[q] = rate[q] + (K * curvature) * cofactor(F[q]);
      if (!out.x.empty()) tets.scatter_gradient(rate, Pack(out.scale) * tets.volume, out.x);
      const Pack by_bulk = Pack(out.scale) * volume_.tet_volume(i) * (u_rate * w_rate + change * curvature);
      for (int l = 0; l < tets.count; ++l) out.parameters[tet(i, l)] = by_bulk[l];
    });
  }

  // Adds the derivatives with respect to mu and lambda, from those with respect to mu, la_pt and K.
  void add_chained(std::span<const double> own, std::span<const double> by_bulk, std::span<double> gradient) const {
    for (size_t t = 0; t < parameters().size(); ++t) {
      for (size_t k = entry(t); k < entry(t + 1); ++k)
        if (k != entry(t) + 1) gradient[k] += own[k];
      const double by_lambda = own[entry(t) + 1];
      if (is_split(parameters()[t].lame)) {
        gradient[entry(t)] += kPointwise * (by_lambda - by_bulk[t]);
        gradient[entry(t) + 1] += by_bulk[t];
      } else {
        gradient[entry(t) + 1] += by_lambda;
      }
    }
  }

  const MeanVolume& term_;
  const VolumeTerm& volume_;
  std::unique_ptr<ParameterDerivatives> shape_, nodes_;  // nodes_: null without a barrier
};

}  // namespace mean_volume

std::unique_ptr<ParameterDerivatives> mean_volume_derivatives(const TetElasticity& term) {
  const auto* own = dynamic_cast<const mean_volume::MeanVolume*>(&term);
  return own ? std::make_unique<mean_volume::MeanVolumeDerivatives>(*own) : nullptr;
}

}  // namespace aspic
