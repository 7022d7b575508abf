#include "energy/rayleigh_damping.h"

#include <optional>

#include "base/parallel.h"

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
    C_.emplace(pattern);
    for (auto* v : {&u_, &Cu_, &Mu_}) v->resize(3 * pattern.rows());
    start_.resize(3 * pattern.rows());
  }

  void begin_step(const StepContext& step) override {
    h_ = step.h;
    start_.assign(step.start.begin(), step.start.end());
    mass_.assign_to(mass_factor_, *C_);
    const Positions x = step.shape.empty() ? step.start : step.shape;
    shape_.assign(x.begin(), x.end());
    if (stiffness_factor_ > 0) elasticity_->add_hessian(x, stiffness_factor_, {kDefiniteness}, *C_);
  }

  double value(Positions x) const override {
    if (h_ == 0) return 0;
    multiply(x);
    const double D = parallel_sum(static_cast<int>(u_.size()), [&](int first, int last) {
      double sum = 0;
      for (int i = first; i < last; ++i) sum += u_[i] * Cu_[i];
      return sum;
    });
    return D / (2 * h_);
  }

  void add_gradient(Positions x, double scale, std::span<double> g) const override {
    if (h_ == 0) return;
    multiply(x);
    parallel_chunks(static_cast<int>(g.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) g[i] += scale / h_ * Cu_[i];
    });
  }

  void add_couplings(Couplings& couplings) const override { mass_.add_couplings(couplings); }

  int add_hessian(Positions, double scale, const Projection&, BlockSparse& H) const override {
    if (h_ == 0) return 0;
    const BlockPattern& p = *H.pattern;
    parallel_chunks(p.rows(), [&](int first, int last) {
      for (int64_t k = p.row_start[first]; k < p.row_start[last]; ++k)
        for (int i = 0; i < 9; ++i) H.block[k].a[i] += scale / h_ * C_->block[k].a[i];
    });
    return 0;
  }

  int coefficient_count() const override { return stiffness_factor_ > 0 ? 2 : 1; }
  const TetElasticity* elasticity() const override { return stiffness_factor_ > 0 ? elasticity_ : nullptr; }
  double mass_factor(int vertex) const override { return mass_.vertex_mass()[vertex] > 0 ? mass_factor_ : 0; }

  // h w . dD/dx = w' (a M + b K(x_start)) u
  void add_derivatives(Positions x, std::span<const double> w, double scale,
                       const DampingGradients& gradients) const override {
    if (h_ == 0) return;
    const double s = scale / h_;
    if (!gradients.coefficients.empty()) {
      multiply(x);
      mass_.multiply(u_, Mu_);
      const double wMu = dot(w, Mu_);
      gradients.coefficients[0] += s * wMu;
      if (stiffness_factor_ > 0)
        gradients.coefficients[1] += s * (dot(w, Cu_) - mass_factor_ * wMu) / stiffness_factor_;
    }
    if (!gradients.start.empty()) {
      C_->multiply(w, Cu_);
      for (size_t i = 0; i < x.size(); ++i) gradients.start[i] -= s * Cu_[i];
    }
    if (stiffness_factor_ == 0) return;
    for (size_t i = 0; i < x.size(); ++i) u_[i] = x[i] - start_[i];
    elasticity_->add_hessian_derivatives(shape_, w, u_, kDefiniteness, s * stiffness_factor_, gradients.start,
                                         gradients.elastic);
  }

  bool prepare_vertex_systems(int) override { return true; }
  void add_vertex_systems(Positions x, double scale, std::span<const int> vertices, std::span<Vec3d> g,
                          std::span<Mat3d> H) const override {
    if (h_ == 0) return;
    const BlockPattern& p = *C_->pattern;
    const auto moved = [&](int j) {
      return Vec3d{{x[3 * j] - start_[3 * j], x[3 * j + 1] - start_[3 * j + 1], x[3 * j + 2] - start_[3 * j + 2]}};
    };
    for (size_t k = 0; k < vertices.size(); ++k) {
      const int v = vertices[k];
      Vec3d Cu{};
      for (int64_t s = p.row_start[v]; s < p.row_start[v + 1]; ++s) Cu = Cu + C_->block[s] * moved(p.column[s]);
      for (int64_t u = p.upper_start[v]; u < p.upper_start[v + 1]; ++u)
        Cu = Cu + transpose(C_->block[p.upper_slot[u]]) * moved(p.upper_row[u]);
      g[k] = g[k] + (scale / h_) * Cu;
      H[k] = H[k] + (scale / h_) * C_->block[p.diagonal(v)];
    }
  }

 private:
  static constexpr Definiteness kDefiniteness = Definiteness::clamped;  // of K

  static double dot(std::span<const double> a, std::span<const double> b) {
    return parallel_sum(static_cast<int>(a.size()), [&](int first, int last) {
      double sum = 0;
      for (int i = first; i < last; ++i) sum += a[i] * b[i];
      return sum;
    });
  }

  void multiply(Positions x) const {
    parallel_chunks(static_cast<int>(x.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) u_[i] = x[i] - start_[i];
    });
    C_->multiply(u_, Cu_);
  }

  MassMatrix mass_;
  const TetElasticity* elasticity_;
  double mass_factor_, stiffness_factor_;
  double h_ = 0;                             // [s]
  std::vector<double> start_, shape_;        // x at the start of the step, and where K is taken
  std::optional<BlockSparse> C_;             // a M + b K(x_start) [kg/s]
  mutable std::vector<double> u_, Cu_, Mu_;  // scratch; u = x - x_start
};

}  // namespace

std::unique_ptr<Damping> make_rayleigh_damping(const MassMatrix& mass, double mass_factor,
                                               const TetElasticity* elasticity, double stiffness_factor) {
  return std::make_unique<RayleighDamping>(mass, mass_factor, elasticity, stiffness_factor);
}

}  // namespace aspic
