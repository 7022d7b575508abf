#include "energy/rayleigh_damping.h"

#include <optional>

namespace aspic {
namespace {

class RayleighDamping : public Energy {
 public:
  RayleighDamping(MassMatrix mass, double mass_factor, const Energy* elasticity, double stiffness_factor)
      : mass_(std::move(mass)),
        elasticity_(elasticity),
        mass_factor_(mass_factor),
        stiffness_factor_(stiffness_factor) {}

  std::string_view name() const override { return "rayleigh_damping"; }

  void bind(const BlockPattern& pattern) override {
    mass_.bind(pattern);
    C_.emplace(pattern);
    for (auto* v : {&u_, &Cu_}) v->resize(3 * pattern.rows());
    start_.resize(3 * pattern.rows());
  }

  void begin_step(const StepContext& step) override {
    h_ = step.h;
    start_.assign(step.start.begin(), step.start.end());
    C_->set_zero();
    mass_.add_to(mass_factor_, *C_);
    if (stiffness_factor_ > 0) elasticity_->add_hessian(step.start, stiffness_factor_, {Definiteness::clamped}, *C_);
  }

  double value(Positions x) const override {
    if (h_ == 0) return 0;
    multiply(x);
    double D = 0;
    for (size_t i = 0; i < u_.size(); ++i) D += u_[i] * Cu_[i];
    return D / (2 * h_);
  }

  void add_gradient(Positions x, double scale, std::span<double> g) const override {
    if (h_ == 0) return;
    multiply(x);
    for (size_t i = 0; i < Cu_.size(); ++i) g[i] += scale / h_ * Cu_[i];
  }

  void add_couplings(Couplings& couplings) const override { mass_.add_couplings(couplings); }

  int add_hessian(Positions, double scale, const Projection&, BlockSparse& H) const override {
    if (h_ == 0) return 0;
    for (size_t k = 0; k < H.block.size(); ++k)
      for (int i = 0; i < 9; ++i) H.block[k].a[i] += scale / h_ * C_->block[k].a[i];
    return 0;
  }

 private:
  void multiply(Positions x) const {
    for (size_t i = 0; i < x.size(); ++i) u_[i] = x[i] - start_[i];
    C_->multiply(u_, Cu_);
  }

  MassMatrix mass_;
  const Energy* elasticity_;
  double mass_factor_, stiffness_factor_;
  double h_ = 0;  // [s]
  std::vector<double> start_;
  std::optional<BlockSparse> C_;        // a M + b K(x_start) [kg/s]
  mutable std::vector<double> u_, Cu_;  // scratch
};

}  // namespace

std::unique_ptr<Energy> make_rayleigh_damping(const MassMatrix& mass, double mass_factor, const Energy* elasticity,
                                              double stiffness_factor) {
  return std::make_unique<RayleighDamping>(mass, mass_factor, elasticity, stiffness_factor);
}

}  // namespace aspic
