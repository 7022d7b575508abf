#include "energy/quadratic_batch.h"
#include "energy/tet_elasticity.h"
#include "energy/tet_term.h"

namespace aspic {
namespace {

// psi(F) = eta / (2 h) |E - E_start|^2, E = (F'F - I) / 2: a St. Venant-Kirchhoff solid at rest at the start of the
// step.
struct GreenStrainRate {
  template <class T>
  struct Params {
    T viscosity;               // eta [Pa s]
    T per_step;                // 1/h [1/s]; 0 in statics
    T xx, yy, zz, xy, yz, zx;  // E_start
  };

  template <class T>
  static Mat3<T> green_strain(const Mat3<T>& F) {
    return T(0.5) * (transpose(F) * F - identity3<T>());
  }

  template <class T>
  static Mat3<T> increment(const Mat3<T>& F, const Params<T>& p) {
    const Mat3<T> start = {{p.xx, p.xy, p.zx, p.xy, p.yy, p.yz, p.zx, p.yz, p.zz}};
    return green_strain(F) - start;
  }

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    return T(0.5) * p.viscosity * p.per_step * squared_norm(increment(F, p));
  }

  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    return (p.viscosity * p.per_step) * (F * increment(F, p));
  }

  // dP = k (dF S + F dE), S = E - E_start, dE = (dF'F + F'dF) / 2
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    const T k = p.viscosity * p.per_step;
    const Mat3<T> S = increment(F, p), FFt = F * transpose(F);
    Mat9<T> H;
    for (int d = 0; d < 3; ++d)
      for (int s = 0; s < 3; ++s)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) {
            T h = T(0.5) * F(r, d) * F(s, c);
            if (r == s) h = h + S(d, c);
            if (c == d) h = h + T(0.5) * FFt(r, s);
            H(r + 3 * c, s + 3 * d) = k * h;
          }
    return H;
  }
};

template <class Batch>
class StrainRateDamping : public TetTerm<GreenStrainRate, Damping, Batch> {
  using Term = TetTerm<GreenStrainRate, Damping, Batch>;
  using Points = typename Batch::Points;
  using Context = Energy::Context;
  using Term::at, Term::at_points, Term::batch_count, Term::batches_, Term::F, Term::for_each_batch, Term::kPoints;
  using Term::params_, Term::place;

 public:
  StrainRateDamping(const TetMesh& mesh, int first, std::span<const GreenStrainRate::Params<double>> parameters)
      : Term("strain_rate_damping", mesh, first, parameters),
        first_(first),
        count_(static_cast<int>(parameters.size())) {}

  std::unique_ptr<Context> make_context() const override {
    auto start = std::make_unique<Start>();
    start->params = params_;
    return start;
  }

  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    Start& start = static_cast<Start&>(context);
    start.x.assign(step.start.begin(), step.start.end());
    parallel_for(batch_count(), [&](int i) {
      const Points F_i = F(i, step.start);
      for (int q = 0; q < kPoints; ++q) {
        const Mat3<Pack> E = GreenStrainRate::green_strain(at(F_i, q));
        auto& p = start.params[place(i, q)];
        p.per_step = Pack(step.h > 0 ? 1 / step.h : 0.0);
        p.xx = E(0, 0), p.yy = E(1, 1), p.zz = E(2, 2);
        p.xy = E(0, 1), p.yz = E(1, 2), p.zx = E(2, 0);
      }
    });
  }

  int coefficient_count() const override { return count_; }

  // w . dD/dx = k W : F (E - E_start), k = eta / h, and dE_start = sym(F_start' dF_start).
  void add_derivatives(Positions x, const Context& context, std::span<const double> w, double scale,
                       const DampingGradients& gradients) const override {
    const Start& start = static_cast<const Start&>(context);
    for_each_batch([&](int i) {
      const Batch& tets = batches_[i];
      const auto* p = &start.params[place(i, 0)];
      const Points F_i = F(i, x), W = F(i, w), F_start = F(i, start.x);
      const Pack weight = Pack(scale) * tets.volume * p[0].per_step;
      const auto FtW = [&](int q) { return transpose(at(F_i, q)) * at(W, q); };
      if (!gradients.start.empty()) {
        const auto rate = [&](int q) {
          const Mat3<Pack> product = FtW(q);
          return at(F_start, q) * (Pack(0.5) * (product + transpose(product)));
        };
        tets.scatter_gradient(at_points(rate), -weight * p[0].viscosity, gradients.start);
      }
      if (gradients.coefficients.empty()) return;
      Pack work = inner(FtW(0), GreenStrainRate::increment(at(F_i, 0), p[0]));
      for (int q = 1; q < kPoints; ++q) work += inner(FtW(q), GreenStrainRate::increment(at(F_i, q), p[q]));
      const Pack rate = weight * work;
      for (int l = 0; l < tets.count; ++l) gradients.coefficients[tets.tet[l] - first_] += rate[l];
    });
  }

 private:
  struct Start : Context {  // data of the start of the step
    std::vector<double> x;
    std::vector<GreenStrainRate::Params<Pack>> params;  // E_start and 1/h
  };
  const std::vector<GreenStrainRate::Params<Pack>>& params(const Context& context) const override {
    return static_cast<const Start&>(context).params;
  }

  int first_, count_;
};

}  // namespace

std::unique_ptr<Damping> make_strain_rate_damping(const TetMesh& mesh, int first, std::span<const double> viscosity) {
  std::vector<GreenStrainRate::Params<double>> parameters;
  for (const double eta : viscosity) parameters.push_back({eta, 0, 0, 0, 0, 0, 0, 0});
  if (!parameters.empty() && is_quadratic(mesh, first))
    return std::make_unique<StrainRateDamping<QuadraticTetBatch>>(mesh, first, parameters);
  return std::make_unique<StrainRateDamping<TetBatch>>(mesh, first, parameters);
}

}  // namespace aspic
