#include "ranks/shared_terms.h"

#include <utility>

#include "base/check.h"
#include "math/vectors.h"

namespace aspic::distributed {
namespace {

class SharedElasticity : public TetElasticity {
 public:
  SharedElasticity(ElasticityOfRank parts, const Share& share)
      : counted_(std::move(parts.counted)), halo_(std::move(parts.halo)), share_(share) {
    for (const TetElasticity* part : {counted_.get(), halo_.get()}) {
      const std::vector<MaterialParameters> own = part->parameters();
      parameters_.insert(parameters_.end(), own.begin(), own.end());
    }
  }

  std::string_view name() const override { return counted_->name(); }
  void add_couplings(Couplings& couplings) const override {
    counted_->add_couplings(couplings);
    halo_->add_couplings(couplings);
  }
  void bind(const BlockPattern& pattern) override {
    counted_->bind(pattern);
    halo_->bind(pattern);
  }
  double value(Positions x, const Context&) const override { return share_.sum(counted_->value(x)); }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    counted_->add_gradient(x, scale, g);
    halo_->add_gradient(x, scale, g);
  }
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    halo_->add_hessian(x, scale, projection, H);
    return static_cast<int>(share_.sum(counted_->add_hessian(x, scale, projection, H)));
  }

  double min_det_F(Positions x) const override { return share_.min(counted_->min_det_F(x)); }
  bool excludes_inversion() const override { return counted_->excludes_inversion(); }
  void evaluate(Positions x, TetFields& fields) const override {
    counted_->evaluate(x, fields);
    halo_->evaluate(x, fields);
  }
  int parameter_count() const override { return counted_->parameter_count(); }
  std::vector<MaterialParameters> parameters() const override { return parameters_; }
  void set_parameters(std::span<const MaterialParameters> parameters) override {
    parameters_.assign(parameters.begin(), parameters.end());
    counted_->set_parameters(parameters.first(counted_tets()));
    halo_->set_parameters(parameters.subspan(counted_tets()));
  }

 private:
  size_t counted_tets() const { return counted_->parameters().size(); }

  std::unique_ptr<TetElasticity> counted_, halo_;
  Share share_;
  std::vector<MaterialParameters> parameters_;
};

class SharedLoad : public Energy {
 public:
  SharedLoad(std::unique_ptr<Energy> local, int own_entries, const Share& share)
      : local_(std::move(local)), own_(own_entries), share_(share) {}

  std::string_view name() const override { return local_->name(); }
  bool has_constant_gradient() const override { return true; }
  std::unique_ptr<Context> make_context() const override { return local_->make_context(); }
  void begin_step(const StepContext& step, Context& context) const override { local_->begin_step(step, context); }
  double value(Positions x, const Context& context) const override {
    const std::vector<double> g = gradient(x, context);
    return share_.sum(dot(std::span(g).first(own_), x.first(own_)));
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    const std::vector<double> unscaled = gradient(x, context);
    for (int i = 0; i < own_; ++i) g[i] += scale * unscaled[i];
  }
  int add_hessian(Positions, const Context&, double, const Projection&, BlockSparse&) const override { return 0; }

 private:
  std::vector<double> gradient(Positions x, const Context& context) const {
    std::vector<double> g(x.size(), 0.0);
    local_->add_gradient(x, context, 1, g);
    return g;
  }

  std::unique_ptr<Energy> local_;
  int own_;
  Share share_;
};

class SharedDamping : public Energy {
 public:
  SharedDamping(std::unique_ptr<Energy> local, int own_entries, const Share& share)
      : local_(std::move(local)), own_(own_entries), share_(share) {}

  std::string_view name() const override { return local_->name(); }
  void add_couplings(Couplings& couplings) const override { local_->add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { local_->bind(pattern); }
  std::unique_ptr<Context> make_context() const override { return std::make_unique<Step>(local_->make_context()); }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    Step& own = static_cast<Step&>(context);
    own.start.assign(step.start.begin(), step.start.begin() + own_);
    local_->begin_step(step, *own.local);
  }
  double value(Positions x, const Context& context) const override {
    if (context.h == 0) return 0;
    const Step& step = static_cast<const Step&>(context);
    std::vector<double> g(x.size(), 0.0);
    local_->add_gradient(x, *step.local, 1, g);
    double sum = 0;
    for (int i = 0; i < own_; ++i) sum += g[i] * (x[i] - step.start[i]);
    return share_.sum(sum) / 2;
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    local_->add_gradient(x, local_of(context), scale, g);
  }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return static_cast<int>(share_.sum(local_->add_hessian(x, local_of(context), scale, projection, H)));
  }

 private:
  struct Step : Context {
    explicit Step(std::unique_ptr<Context> of_local) : local(std::move(of_local)) {}
    std::unique_ptr<Context> local;
    std::vector<double> start;  // own positions at the start of the step
  };
  static const Context& local_of(const Context& context) { return *static_cast<const Step&>(context).local; }

  std::unique_ptr<Energy> local_;
  int own_;
  Share share_;
};

}  // namespace

std::unique_ptr<TetElasticity> make_shared_elasticity(ElasticityOfRank parts, const Share& share) {
  return std::make_unique<SharedElasticity>(std::move(parts), share);
}

std::unique_ptr<Energy> make_shared_load(std::unique_ptr<Energy> local, int own_entries, const Share& share) {
  ASPIC_CHECK(local->has_constant_gradient());
  return std::make_unique<SharedLoad>(std::move(local), own_entries, share);
}

std::unique_ptr<Energy> make_shared_damping(std::unique_ptr<Energy> local, int own_entries, const Share& share) {
  return std::make_unique<SharedDamping>(std::move(local), own_entries, share);
}

}  // namespace aspic::distributed
