#include "energy/fibre_term.h"
#include "material/hill_law.h"
#include "material/muscle_law.h"

namespace aspic {
namespace {

HillLaw::Params<double> own_params(const MuscleVelocity& f) {
  return {f.strength, 1 / (f.optimal_stretch * f.max_velocity), f.optimal_stretch, f.curvature, f.lengthening, 0, 0, 0};
}

// In params_, `tension` is the strength, `start` the optimal stretch l0 and `rate` 1 / (l0 v_max).
template <class Batch>
class HillTerm final : public FibreTerm<HillLaw, Damping, Batch> {
  using Term = FibreTerm<HillLaw, Damping, Batch>;
  using Points = typename Batch::Points;
  using Context = Energy::Context;
  using Packs = std::vector<HillLaw::Params<Pack>>;
  using Term::at, Term::at_points, Term::batch_count, Term::batches_, Term::F, Term::for_each_batch, Term::kPoints;
  using Term::params_, Term::place;

 public:
  HillTerm(const FibrePlace& tets, std::span<const MuscleVelocity> fibres, Activation activation)
      : Term(tets, fibres, &own_params), activation_(std::move(activation)) {}

  std::unique_ptr<Context> make_context() const override {
    auto start = std::make_unique<Start>();
    start->params = params_;
    for (auto& p : start->params) p.tension = 0.0;
    return start;
  }

  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    Start& start = static_cast<Start&>(context);
    start.x.assign(step.start.begin(), step.start.end());
    start.activation = activation_(step.time);
    const bool moves = step.h > 0;
    parallel_for(batch_count(), [&](int i) {
      const Points F_i = F(i, step.start);
      for (int q = 0; q < kPoints; ++q) {
        const auto& given = params_[place(i, q)];
        auto& p = start.params[place(i, q)];
        p.start = HillLaw::length(at(F_i, q) * HillLaw::axis(given));
        p.rate = Pack(moves ? 1 / step.h : 1.0) * given.rate;
        p.tension = Pack(moves ? start.activation : 0.0) * (given.tension / given.start) *
                    muscle_force(p.start / given.start).force;
      }
    });
  }

  int coefficient_count() const override { return 0; }

  // w . dD/dx = psi' (f . W a) / l, and psi' depends on the start through l_n only.
  void add_derivatives(Positions x, const Context& context, std::span<const double> w, double scale,
                       const DampingGradients& gradients) const override {
    const Start& start = static_cast<const Start&>(context);
    if (gradients.start.empty()) return;
    for_each_batch([&](int i) {
      const Points F_i = F(i, x), W = F(i, w), F_start = F(i, start.x);
      const auto rate = [&](int q) {
        const auto& p = start.params[place(i, q)];
        const Vec3<Pack> a = HillLaw::axis(p), f = at(F_i, q) * a, f_start = at(F_start, q) * a;
        const Pack l = HillLaw::length(f), l_start = HillLaw::length(f_start);
        const Pack mixed = mixed_derivative(start, place(i, q), l) * (dot(f, at(W, q) * a) / l);
        return outer((mixed / l_start) * f_start, a);
      };
      batches_[i].scatter_gradient(at_points(rate), Pack(scale) * batches_[i].volume, gradients.start);
    });
  }

 private:
  struct Start : Context {  // data of the start of the step
    std::vector<double> x;
    double activation = 0;
    Packs params;
  };

  // Returns d2psi / dl dl_n.
  Pack mixed_derivative(const Start& start, int index, const Pack& l) const {
    const auto& given = params_[index];
    HillLaw::Params<Pack> p = start.params[index];
    const Pack curvature = HillLaw::response(l, p).curvature;
    p.tension = Pack(start.h > 0 ? start.activation : 0.0) * given.tension / (given.start * given.start) *
                muscle_force(p.start / given.start).change;
    return HillLaw::response(l, p).slope - curvature;
  }

  const Packs& params(const Context& context) const override { return static_cast<const Start&>(context).params; }

  Activation activation_;
};

}  // namespace

std::unique_ptr<Damping> make_muscle_velocity(const FibrePlace& place, std::span<const MuscleVelocity> fibres,
                                              Activation activation) {
  return for_order_of(place, fibres, [&]<class Batch>() -> std::unique_ptr<Damping> {
    return std::make_unique<HillTerm<Batch>>(place, fibres, std::move(activation));
  });
}

}  // namespace aspic
