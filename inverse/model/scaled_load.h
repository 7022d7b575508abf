// Load stepping: s V(x) for a term V and a factor s from 0 to 1.
#pragma once
#include <memory>
#include <utility>

#include "energy/energy.h"

namespace aspic {

class ScaledLoad : public Energy {
 public:
  explicit ScaledLoad(std::unique_ptr<Energy> load) : load_(std::move(load)) {}
  void set_factor(double factor) { factor_ = factor; }

  std::string_view name() const override { return load_->name(); }
  std::unique_ptr<Context> make_context() const override { return load_->make_context(); }
  void begin_step(const StepContext& step, Context& context) const override { load_->begin_step(step, context); }
  double value(Positions x, const Context& context) const override { return factor_ * load_->value(x, context); }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    load_->add_gradient(x, context, factor_ * scale, g);
  }
  void add_couplings(Couplings& couplings) const override { load_->add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { load_->bind(pattern); }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return load_->add_hessian(x, context, factor_ * scale, projection, H);
  }

 private:
  std::unique_ptr<Energy> load_;
  double factor_ = 1;
};

}  // namespace aspic
