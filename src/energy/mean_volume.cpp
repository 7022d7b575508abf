#include "energy/mean_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "energy/node_barrier.h"
#include "energy/projection_derivative.h"
#include "energy/quadratic_batch.h"
#include "energy/stiff_energy.h"
#include "energy/tet_term.h"
#include "material/from_invariants.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

constexpr double kPointwise = 1.5;   // largest la_pt / mu
constexpr double kCompliance = 0.6;  // g' A^-1 g times modulus / volume, measured on Delaunay meshes
constexpr double kStiff = 1.8;       // smallest K times compliance of stiff rows, at Poisson's ratio 0.45

// False for a Poisson's ratio of 0.3 with round-off.
bool is_split(const Lame& lame) { return lame.lambda > (1 + 1e-9) * kPointwise * lame.mu; }
double pointwise_lambda(const Lame& lame) { return is_split(lame) ? kPointwise * lame.mu : lame.lambda; }

std::vector<MaterialParameters> pointwise(std::span<const MaterialParameters> parameters) {
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
constexpr int kPoints = QuadraticTetBatch::kPoints;

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

template <class OfPoint>
Pack mean(const OfPoint& of_point) {
  Pack sum = of_point(0);
  for (int q = 1; q < kPoints; ++q) sum += of_point(q);
  return Pack(1.0 / kPoints) * sum;
}
template <class OfPoint>
Points at_all_points(const OfPoint& of_point) {
  Points values;
  for (int q = 0; q < kPoints; ++q) values[q] = of_point(q);
  return values;
}

Pack mean_J(const Points& F) {
  return mean([&](int q) { return determinant(F[q]); });
}
Pack mean_J_rate(const Points& F, const Points& U) {
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
    mutable std::vector<Pack> pressure;  // of each batch; empty: none. Changed by note_newton_step() only.
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

  void note_newton_step(Positions x, std::span<const double> d, const Lag& lag) const {
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

  // g += scale sum over tets of rate (mean J - 1) d(volume mean J)/dx
  template <class RateOf>
  void add_bulk_force(Positions x, const RateOf& rate_of, double scale, std::span<double> g) const {
    const auto of_batch = [&](int i) {
      Pack rate;
      for (int l = 0; l < kPackWidth; ++l) rate.set(l, rate_of(batches_[i].tet[l] - first_));
      return rate * (mean_J(F(i, x)) - 1.0);
    };
    Term::add_gradient(x, pressures(of_batch), scale, g);
  }

  // Calls visit(tet, d(w . dV/dx)/dK).
  template <class Visit>
  void visit_bulk_gradient(Positions x, std::span<const double> w, const Visit& visit) const {
    parallel_for(batch_count(), [&](int i) {
      const Points F_i = F(i, x);
      const Pack rate = tet_volume(i) * (mean_J(F_i) - 1.0) * mean_J_rate(F_i, F(i, w));
      for (int l = 0; l < batches_[i].count; ++l) visit(batches_[i].tet[l] - first_, rate[l]);
    });
  }

  // Adds the derivatives of scale u . H w with respect to x, and calls visit(tet, derivative with respect to K).
  template <class Visit>
  void add_hessian_derivatives(Positions x, std::span<const double> u, std::span<const double> w,
                               Definiteness definiteness, double scale, std::span<double> g, const Visit& visit) const {
    for_each_batch([&](int i) {
      const Points F_i = F(i, x), U = F(i, u), W = F(i, w);
      const Pack K = bulk_[i], change = mean_J(F_i) - 1.0;
      const Pack u_rate = mean_J_rate(F_i, U), w_rate = mean_J_rate(F_i, W);
      // Geometric part: the sum of factor p left : d2J right over pairs of directions.
      const auto pairs = directions(F_i, K * change, U, W, definiteness);
      Pack curvature = Pack(0.0);  // mean of factor left : d2J right
      Points rate = at_all_points(
          [&](int q) { return K * (w_rate * cofactor_rate(F_i[q], U[q]) + u_rate * cofactor_rate(F_i[q], W[q])); });
      for (const Directions& pair : pairs) {
        curvature += Pack(1.0 / kPoints) * pair.factor * inner(cofactor_rate(F_i[pair.q], pair.left), pair.right);
        rate[pair.q] = rate[pair.q] + (pair.factor * K * change) * cofactor_rate(pair.left, pair.right);
      }
      for (int q = 0; q < kPoints; ++q) rate[q] = rate[q] + (K * curvature) * cofactor(F_i[q]);
      if (!g.empty()) batches_[i].scatter_gradient(rate, Pack(scale) * batches_[i].volume, g);
      const Pack by_bulk = Pack(scale) * tet_volume(i) * (u_rate * w_rate + change * curvature);
      for (int l = 0; l < batches_[i].count; ++l) visit(batches_[i].tet[l] - first_, by_bulk[l]);
    });
  }

  // Calls visit(tet, volume [m^3] unused lanes excluded, mean J - 1, p).
  template <class Visit>
  void visit_pressures(Positions x, const Visit& visit) const {
    parallel_for(batch_count(), [&](int i) {
      const Pack change = mean_J(F(i, x)) - 1.0;
      for (int l = 0; l < batches_[i].count; ++l) visit(batches_[i].tet[l], change[l], bulk_[i][l]);
    });
  }

 private:
  using NodeRates = std::array<std::array<Pack, 3>, 10>;  // d(volume mean J)/dx of each node

  struct Directions {
    int q;
    Pack factor;
    Mat3<Pack> left, right;
  };

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

  // U and W where the Hessian of p J is not modified, and the directions of the derivative of the modified product.
  static std::vector<Directions> directions(const Points& F, Pack p, const Points& U, const Points& W,
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

  int first_;
  bool is_active_ = false;
  std::vector<Pack> bulk_, compliance_;  // of each batch
};

class MeanVolume : public TetElasticity, public StiffEnergy {
 public:
  MeanVolume(const ElasticityMaker& make_shape, const TetMesh& mesh, int first,
             std::span<const MaterialParameters> parameters, bool has_barrier)
      : shape_(make_shape(mesh, first, pointwise(parameters))),
        volume_(mesh, first, parameters),
        parameters_(parameters.begin(), parameters.end()) {
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
    note_newton_step({}, {}, context);
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
  void note_newton_step(Positions x, std::span<const double> d, const Context& context) const override {
    const auto* lag = dynamic_cast<const VolumeTerm::Lag*>(&context);
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
  std::span<const MaterialParameters> parameters() const override { return parameters_; }
  void set_parameters(std::span<const MaterialParameters> parameters) override {
    ASPIC_CHECK(parameters.size() == parameters_.size());
    std::copy(parameters.begin(), parameters.end(), parameters_.begin());
    shape_->set_parameters(pointwise(parameters));
    volume_.set_parameters(parameters);
    if (nodes_) nodes_->set_parameters(parameters);
  }

  void add_parameter_force(Positions x, std::span<const double> change, double scale,
                           std::span<double> g) const override {
    std::vector<double> pointwise_change(change.begin(), change.end());
    std::vector<double> bulk_change(parameters_.size(), 0.0);
    for (size_t t = 0; t < parameters_.size(); ++t) {
      double& lambda = pointwise_change[entry(t) + 1];
      if (!is_split(parameters_[t].lame)) continue;
      lambda = kPointwise * change[entry(t)];
      bulk_change[t] = change[entry(t) + 1] - lambda;
    }
    shape_->add_parameter_force(x, pointwise_change, scale, g);
    if (nodes_) nodes_->add_parameter_force(x, pointwise_change, scale, g);
    if (!volume_.is_active()) return;
    volume_.add_bulk_force(
        x, [&](int t) { return bulk_change[t]; }, scale, g);
  }

  void add_parameter_gradient(Positions x, std::span<const double> w, double scale,
                              std::span<double> gradient) const override {
    std::vector<double> own(gradient.size(), 0.0), by_bulk(parameters_.size(), 0.0);
    shape_->add_parameter_gradient(x, w, scale, own);
    if (nodes_) nodes_->add_parameter_gradient(x, w, scale, own);
    if (volume_.is_active()) volume_.visit_bulk_gradient(x, w, [&](int t, double rate) { by_bulk[t] = scale * rate; });
    add_chained(own, by_bulk, gradient);
  }

  void add_hessian_derivatives(Positions x, std::span<const double> u, std::span<const double> w,
                               Definiteness definiteness, const HessianDerivatives& out) const override {
    std::vector<double> own(out.parameters.size(), 0.0), by_bulk(parameters_.size(), 0.0);
    shape_->add_hessian_derivatives(x, u, w, definiteness, {out.scale, out.x, own});
    if (nodes_) nodes_->add_hessian_derivatives(x, u, w, definiteness, {out.scale, out.x, own});
    if (volume_.is_active())
      volume_.add_hessian_derivatives(x, u, w, definiteness, out.scale, out.x,
                                      [&](int t, double rate) { by_bulk[t] = rate; });
    if (!out.parameters.empty()) add_chained(own, by_bulk, out.parameters);
  }

 private:
  size_t entry(size_t tet) const { return parameter_count() * tet; }

  // Adds the derivatives with respect to mu and lambda, from those with respect to mu, la_pt and K.
  void add_chained(std::span<const double> own, std::span<const double> by_bulk, std::span<double> gradient) const {
    for (size_t t = 0; t < parameters_.size(); ++t) {
      for (size_t k = entry(t); k < entry(t + 1); ++k)
        if (k != entry(t) + 1) gradient[k] += own[k];
      const double by_lambda = own[entry(t) + 1];
      if (is_split(parameters_[t].lame)) {
        gradient[entry(t)] += kPointwise * (by_lambda - by_bulk[t]);
        gradient[entry(t) + 1] += by_bulk[t];
      } else {
        gradient[entry(t) + 1] += by_lambda;
      }
    }
  }

  std::unique_ptr<TetElasticity> shape_, nodes_;  // nodes_: null without a barrier
  VolumeTerm volume_;
  std::vector<MaterialParameters> parameters_;  // in the order of the mesh
};

}  // namespace

std::unique_ptr<TetElasticity> make_mean_volume(const ElasticityMaker& make_shape, const TetMesh& mesh, int first,
                                                std::span<const MaterialParameters> parameters, bool has_barrier) {
  return std::make_unique<MeanVolume>(make_shape, mesh, first, parameters, has_barrier);
}

}  // namespace aspic
