// The terms of mean_volume.h. Included only where they are instantiated and differentiated.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/check.h"
#include "base/parallel.h"
#include "energy/mean_volume.h"
#include "energy/node_barrier.h"
#include "energy/parameter_list.h"
#include "energy/quadratic_batch.h"
#include "energy/stiff_energy.h"
#include "energy/tet_term.h"
#include "material/from_invariants.h"
#include "mesh/tet_nodes.h"

namespace aspic::mean_volume {

inline constexpr double kPointwise = 1.5;   // largest la_pt / mu
inline constexpr double kCompliance = 0.6;  // g' A^-1 g times modulus / volume, measured on Delaunay meshes
inline constexpr double kStiff = 1.8;       // smallest K times compliance of stiff rows, at Poisson's ratio 0.45

// False for a Poisson's ratio of 0.3 with round-off.
inline bool is_split(const Lame& lame) { return lame.lambda > (1 + 1e-9) * kPointwise * lame.mu; }
inline double pointwise_lambda(const Lame& lame) { return is_split(lame) ? kPointwise * lame.mu : lame.lambda; }

inline std::vector<MaterialParameters> pointwise(std::span<const MaterialParameters> parameters) {
  std::vector<MaterialParameters> result(parameters.begin(), parameters.end());
  for (MaterialParameters& p : result) p.lame.lambda = pointwise_lambda(p.lame);
  return result;
}

// psi = p J: the work of a given pressure.
struct GivenPressureLaw {
  template <class T>
  struct Params {
    T p;  // [Pa]
  };
  template <class T>
  static T energy(const T&, const T& J, const Params<T>& given) {
    return given.p * J;
  }
  template <class T>
  static LawDerivativesLinearInI1<T> derivatives(const T&, const T&, const Params<T>& given) {
    return {T(0.0), given.p, T(0.0)};
  }
};
using GivenPressure = FromInvariants<GivenPressureLaw>;

using Points = QuadraticTetBatch::Points;
inline constexpr int kPoints = QuadraticTetBatch::kPoints;

template <class OfPoint>
Pack mean(const OfPoint& of_point) {
  Pack sum = of_point(0);
  for (int q = 1; q < kPoints; ++q) sum += of_point(q);
  return Pack(1.0 / kPoints) * sum;
}
inline Pack mean_J(const Points& F) {
  return mean([&](int q) { return determinant(F[q]); });
}
inline Pack mean_J_rate(const Points& F, const Points& U) {
  return mean([&](int q) { return inner(cofactor(F[q]), U[q]); });
}

// Volume term of the tets. The pressure of a tet is p = K (mean J - 1), K = la - la_pt.
class VolumeTerm : public TetTerm<GivenPressure, Energy, QuadraticTetBatch> {
  using Term = TetTerm<GivenPressure, Energy, QuadraticTetBatch>;

 public:
  struct Pressures : Context {
    std::vector<GivenPressure::Params<Pack>> at_points;
  };
  struct Lag : Context {
    std::vector<Pack> pressure;  // of each batch, linearized at the last iterate; empty: none
  };

  VolumeTerm(const TetMesh& mesh, int first, std::span<const MaterialParameters> parameters)
      : Term("volume", mesh, first, std::vector<GivenPressure::Params<double>>(parameters.size())), first_(first) {
    set_parameters(parameters);
  }

  void set_parameters(std::span<const MaterialParameters> parameters) {
    is_active_ = false;
    for (const MaterialParameters& p : parameters) is_active_ |= is_split(p.lame);
    bulk_.assign(batches_.size(), Pack(0.0));
    compliance_.assign(batches_.size(), Pack(0.0));
    for (size_t i = 0; i < batches_.size(); ++i)
      for (int l = 0; l < kPackWidth; ++l) {
        const Lame& lame = parameters[batches_[i].tet[l] - first_].lame;
        bulk_[i].set(l, lame.lambda - pointwise_lambda(lame));
        compliance_[i].set(l, kCompliance / (lame.mu + pointwise_lambda(lame)));
      }
  }

  bool is_active() const { return is_active_; }  // false: the energy is 0

  double value(Positions x, const Context&) const override {
    return reduce(
        [&](int i) {
          const Pack change = mean_J(F(i, x)) - 1.0;
          return sum(tet_volume(i) * Pack(0.5) * bulk_[i] * change * change);
        },
        [](double a, double b) { return a + b; }, 0.0);
  }

  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    Term::add_gradient(x, pressures([&](int i) { return bulk_[i] * (mean_J(F(i, x)) - 1.0); }), scale, g);
  }

  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    const auto* lag = dynamic_cast<const Lag*>(&context);
    const bool is_lagged = lag && !lag->pressure.empty();
    const auto of_batch = [&](int i) { return is_lagged ? lag->pressure[i] : bulk_[i] * (mean_J(F(i, x)) - 1.0); };
    const int projected = Term::add_hessian(x, pressures(of_batch), scale, projection, H);
    for_each_batch([&](int i) { add_outer_products(i, node_rates(i, x), scale, H); });
    return projected;
  }

  void note_newton_step(Positions x, std::span<const double> d, Lag& lag) const {
    lag.pressure.resize(x.empty() ? 0 : batches_.size());
    parallel_for(static_cast<int>(lag.pressure.size()), [&](int i) {
      const Points F_i = F(i, x);
      lag.pressure[i] = bulk_[i] * (mean_J(F_i) - 1.0 + mean_J_rate(F_i, F(i, d)));
    });
  }

  void add_stiff_rows(Positions x, double scale, StiffRows& rows) const {
    for (int i = 0; i < batch_count(); ++i) {
      const QuadraticTetBatch& tets = batches_[i];
      const Pack stiffness = bulk_[i] * compliance_[i];
      const auto is_stiff = [&](int l) { return stiffness[l] > (1 + 1e-9) * kStiff; };
      int l = 0;
      while (l < tets.count && !is_stiff(l)) ++l;
      if (l == tets.count) continue;
      const NodeRates g = node_rates(i, x);
      for (; l < tets.count; ++l) {
        if (!is_stiff(l)) continue;
        const double V = tet_volume(i)[l];
        StiffRow& row = rows.emplace_back();
        for (int n = 0; n < 10; ++n) {
          row.vertex[n] = tets.vertex[n][l];
          row.g[n] = {{g[n][0][l], g[n][1][l], g[n][2][l]}};
        }
        row.weight = scale * bulk_[i][l] / V;
        row.compliance = V * compliance_[i][l] / scale;
      }
    }
  }

  // Calls visit(tet, mean J - 1, K [Pa]) for all tets.
  template <class Visit>
  void visit_pressures(Positions x, const Visit& visit) const {
    parallel_for(batch_count(), [&](int i) {
      const Pack change = mean_J(F(i, x)) - 1.0;
      for (int l = 0; l < batches_[i].count; ++l) visit(batches_[i].tet[l], change[l], bulk_[i][l]);
    });
  }

 private:
  friend class MeanVolumeDerivatives;
  using NodeRates = std::array<std::array<Pack, 3>, 10>;  // d(volume mean J)/dx of each node

  const std::vector<GivenPressure::Params<Pack>>& params(const Context& context) const override {
    return static_cast<const Pressures&>(context).at_points;
  }
  Pack tet_volume(int i) const { return Pack(double{kPoints}) * batches_[i].volume; }

  template <class OfBatch>
  const Pressures& pressures(const OfBatch& of_batch) const {
    thread_local Pressures scratch;
    Pressures& result = scratch;  // shared by all terms of this thread
    result.at_points.resize(kPoints * batches_.size());
    parallel_for(batch_count(), [&](int i) {
      const Pack p = of_batch(i);
      for (int q = 0; q < kPoints; ++q) result.at_points[place(i, q)] = {p};
    });
    return result;
  }

  NodeRates node_rates(int i, Positions x) const {
    const QuadraticTetBatch& tets = batches_[i];
    const Points F_i = F(i, x);
    NodeRates rates = {};
    for (int q = 0; q < kPoints; ++q) {
      const Mat3<Pack> f = tets.volume * (cofactor(F_i[q]) * transpose(tets.rest_inverse));
      std::array<std::array<Pack, 3>, 4> corner;
      for (int r = 0; r < 3; ++r) {
        for (int v = 1; v < 4; ++v) corner[v][r] = f(r, v - 1);
        corner[0][r] = -(f(r, 0) + f(r, 1) + f(r, 2));
      }
      for (int n = 0; n < 10; ++n)
        for (int k = 0; k < kQuadratic[n].count; ++k)
          for (int r = 0; r < 3; ++r) rates[n][r] += kQuadratic[n].value[q][k] * corner[kQuadratic[n].corner[k]][r];
    }
    return rates;
  }

  // H += scale K / volume g g'
  void add_outer_products(int i, const NodeRates& g, double scale, BlockSparse& H) const {
    const QuadraticTetBatch& tets = batches_[i];
    for (int l = 0; l < tets.count; ++l) {
      const double weight = scale * bulk_[i][l] / tet_volume(i)[l];
      for (int u = 0, k = 0; u < 10; ++u)
        for (int v = 0; v <= u; ++v, ++k) {
          const bool is_stored = tets.vertex[u][l] >= tets.vertex[v][l];  // else the transposed block is
          const auto& row = g[is_stored ? u : v];
          const auto& col = g[is_stored ? v : u];
          Mat3d& block = H.block[tets.slot[k][l]];
          for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) block(r, c) += weight * (row[r][l] * col[c][l]);
        }
    }
  }

  int first_;
  bool is_active_ = false;
  std::vector<Pack> bulk_, compliance_;  // of each batch
};

class MeanVolume : public TetElasticity, public StiffEnergy, public PredictingEnergy {
 public:
  MeanVolume(const ElasticityMaker& make_shape, const TetMesh& mesh, int first,
             std::span<const MaterialParameters> parameters, bool has_barrier)
      : shape_(make_shape(mesh, first, pointwise(parameters))),
        volume_(mesh, first, parameters),
        parameters_(parameters, shape_->parameter_count()) {
    if (has_barrier) nodes_ = make_node_barrier(mesh, first, parameters, shape_->parameter_count());
  }

  using TetElasticity::add_gradient, TetElasticity::add_hessian, TetElasticity::value;
  std::string_view name() const override { return shape_->name(); }
  void add_couplings(Couplings& couplings) const override { shape_->add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override {
    shape_->bind(pattern);
    volume_.bind(pattern);
    if (nodes_) nodes_->bind(pattern);
  }
  std::unique_ptr<Context> make_context() const override { return std::make_unique<VolumeTerm::Lag>(); }
  void begin_step(const StepContext& step, Context& context) const override {
    TetElasticity::begin_step(step, context);
    note_newton_step({}, {}, 0, context);
  }

  double value(Positions x, const Context& context) const override {
    double V = shape_->value(x, context);
    if (volume_.is_active()) V += volume_.value(x, context);
    return nodes_ ? V + nodes_->value(x, context) : V;
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    shape_->add_gradient(x, context, scale, g);
    if (volume_.is_active()) volume_.add_gradient(x, context, scale, g);
    if (nodes_) nodes_->add_gradient(x, context, scale, g);
  }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    int projected = shape_->add_hessian(x, context, scale, projection, H);
    if (volume_.is_active()) projected += volume_.add_hessian(x, context, scale, projection, H);
    return nodes_ ? projected + nodes_->add_hessian(x, context, scale, projection, H) : projected;
  }
  void add_stiff_rows(Positions x, double scale, StiffRows& rows) const override {
    if (volume_.is_active()) volume_.add_stiff_rows(x, scale, rows);
  }
  // Linearizes pressures for x + d.
  void note_newton_step(Positions x, std::span<const double> d, double, Context& context) const override {
    auto* lag = dynamic_cast<VolumeTerm::Lag*>(&context);
    if (lag && volume_.is_active()) volume_.note_newton_step(x, d, *lag);
  }

  double min_det_F(Positions x) const override { return shape_->min_det_F(x); }
  bool excludes_inversion() const override { return nodes_ != nullptr; }
  void evaluate(Positions x, TetFields& fields) const override {
    shape_->evaluate(x, fields);
    if (!volume_.is_active()) return;
    volume_.visit_pressures(x, [&](int tet, double change, double bulk) {
      fields.energy_density[tet] += 0.5 * bulk * change * change;
      for (int k = 0; k < 3; ++k) fields.cauchy[6 * tet + k] += bulk * change;
    });
  }

  int parameter_count() const override { return shape_->parameter_count(); }
  std::vector<MaterialParameters> parameters() const override { return parameters_.all(); }
  void set_parameters(std::span<const MaterialParameters> parameters) override {
    parameters_.set(parameters);
    shape_->set_parameters(pointwise(parameters));
    volume_.set_parameters(parameters);
    if (nodes_) nodes_->set_parameters(parameters);
  }

 private:
  friend class MeanVolumeDerivatives;  // with respect to the parameters, in the package of inverse problems

  std::unique_ptr<TetElasticity> shape_, nodes_;  // nodes_: null without a barrier
  VolumeTerm volume_;
  ParameterList parameters_;  // in the order of the mesh
};

}  // namespace aspic::mean_volume
