#include "energy/rayleigh_damping.h"

#include "base/check.h"
#include "base/parallel.h"
#include "math/vectors.h"

namespace aspic {
namespace {

class RayleighDamping : public Damping {
 public:
  RayleighDamping(MassMatrix mass, double mass_factor, const TetElasticity* elasticity, double stiffness_factor)
      : mass_(std::move(mass)),
        elasticity_(elasticity),
        mass_factor_(mass_factor),
        stiffness_factor_(stiffness_factor) {}

  std::string_view name() const override { return "rayleigh_damping"; }

  void bind(const BlockPattern& pattern) override {
    mass_.bind(pattern);
    pattern_ = &pattern;
  }

  std::unique_ptr<Context> make_context() const override {
    ASPIC_CHECK(pattern_);  // bound
    return std::make_unique<Start>(*pattern_);
  }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    Start& start = static_cast<Start&>(context);
    start.x.assign(step.start.begin(), step.start.end());
    mass_.assign_to(mass_factor_, start.C);
    const Positions x = step.shape.empty() ? step.start : step.shape;
    start.shape.assign(x.begin(), x.end());
    if (stiffness_factor_ > 0) elasticity_->add_hessian(x, stiffness_factor_, {kDefiniteness}, start.C);
  }

  double value(Positions x, const Context& context) const override {
    if (context.h == 0) return 0;
    const auto& [u, Cu] = product(x, static_cast<const Start&>(context));
    return dot(u, Cu) / (2 * context.h);
  }

  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    if (context.h == 0) return;
    const std::vector<double>& Cu = product(x, static_cast<const Start&>(context)).Cu;
    parallel_chunks(static_cast<int>(g.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) g[i] += scale / context.h * Cu[i];
    });
  }

  void add_couplings(Couplings& couplings) const override { mass_.add_couplings(couplings); }

  int add_hessian(Positions, const Context& context, double scale, const Projection&, BlockSparse& H) const override {
    if (context.h == 0) return 0;
    const BlockSparse& C = static_cast<const Start&>(context).C;
    const BlockPattern& p = *H.pattern;
    parallel_chunks(p.rows(), [&](int first, int last) {
      for (int64_t k = p.row_start[first]; k < p.row_start[last]; ++k)
        for (int i = 0; i < 9; ++i) H.block[k].a[i] += scale / context.h * C.block[k].a[i];
    });
    return 0;
  }

  int coefficient_count() const override { return stiffness_factor_ > 0 ? 2 : 1; }
  LaggedStiffness lagged_stiffness(const Context& context) const override {
    if (stiffness_factor_ == 0) return {};
    return {elasticity_, stiffness_factor_, static_cast<const Start&>(context).shape, kDefiniteness};
  }
  double mass_factor(int vertex) const override { return mass_.vertex_mass()[vertex] > 0 ? mass_factor_ : 0; }

  // h w . dD/dx = w' (a M + b K(x_start)) u
  void add_derivatives(Positions x, const Context& context, std::span<const double> w, double scale,
                       const DampingGradients& gradients) const override {
    if (context.h == 0) return;
    const Start& start = static_cast<const Start&>(context);
    const double s = scale / context.h;
    std::vector<double> u(x.size()), product_of(x.size());
    for (size_t i = 0; i < x.size(); ++i) u[i] = x[i] - start.x[i];
    if (!gradients.coefficients.empty()) {
      mass_.multiply(u, product_of);
      const double wMu = dot(w, product_of);
      start.C.multiply(u, product_of);
      gradients.coefficients[0] += s * wMu;
      if (stiffness_factor_ > 0)
        gradients.coefficients[1] += s * (dot(w, product_of) - mass_factor_ * wMu) / stiffness_factor_;
    }
    if (!gradients.start.empty()) {
      start.C.multiply(w, product_of);
      for (size_t i = 0; i < x.size(); ++i) gradients.start[i] -= s * product_of[i];
    }
  }

 private:
  static constexpr Definiteness kDefiniteness = Definiteness::clamped;  // modification of K

  struct Start : Context {  // data of the start of the step
    explicit Start(const BlockPattern& pattern) : C(pattern) {}
    std::vector<double> x, shape;  // positions at the start of the step, and those at which K is evaluated
    BlockSparse C;                 // a M + b K(shape) [kg/s]
  };

  struct Product {
    std::vector<double> u, Cu;  // u = x - start.x
  };
  static const Product& product(Positions x, const Start& start) {
    thread_local Product scratch;
    Product& p = scratch;  // shared by all damping terms of this thread
    p.u.resize(x.size()), p.Cu.resize(x.size());
    parallel_chunks(static_cast<int>(x.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) p.u[i] = x[i] - start.x[i];
    });
    start.C.multiply(p.u, p.Cu);
    return p;
  }

  MassMatrix mass_;
  const TetElasticity* elasticity_;
  double mass_factor_, stiffness_factor_;
  const BlockPattern* pattern_ = nullptr;
};

}  // namespace

std::unique_ptr<Damping> make_rayleigh_damping(const MassMatrix& mass, double mass_factor,
                                               const TetElasticity* elasticity, double stiffness_factor) {
  return std::make_unique<RayleighDamping>(mass, mass_factor, elasticity, stiffness_factor);
}

}  // namespace aspic
