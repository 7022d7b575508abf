// L-BFGS in the inner product of the prior: the library's minimizer for f with the preconditioner s R''. One gradient
// per iteration and no product with J'J, for when products cost more than iterations.
#include <cmath>

#include "base/check.h"
#include "estimate/fit_run.h"
#include "optimize/lbfgs.h"

namespace aspic {
namespace {

// Its decrements use an approximate Hessian, so a single small one may be accidental.
constexpr int kSuccessive = 5;

class FitObjective : public Objective, public HasPreconditioner {
 public:
  FitObjective(FitRun& run, FitPoint& at) : run_(run), at_(at), trial_(at), origin_(at.p) {}

  Evaluation evaluate(std::span<const double> p) override {
    if (is_same(p, at_)) return at_iterate();
    return {run_.evaluate(p, trial_) ? trial_.objective(run_.weight) : INFINITY, at_iterate().round_off};
  }
  Evaluation at_iterate() const {
    const double value = at_.objective(run_.weight);
    return {value, 1e-10 * std::abs(value)};
  }
  void gradient(std::span<const double> p, std::span<double> g) override {
    const FitPoint& point = is_same(p, at_) ? at_ : trial_;
    ASPIC_CHECK(is_same(p, point));
    if (run_.linearize(point))
      run_.gradient(point, g);
    else
      std::fill(g.begin(), g.end(), std::nan(""));
  }
  void note_iterate(std::span<const double> p) override {
    if (!is_same(p, at_)) std::swap(at_, trial_);
  }
  double max_step(std::span<const double>, std::span<const double> d) override {
    return run_.options.max_step / std::max(max_abs(d), 1e-300);
  }

  // s R'' at the first iterate, with s the curvature of f along the first direction.
  bool precondition(std::span<const double> r, std::span<double> z) override {
    run_.solve_prior(origin_, r, z);
    if (scale_ == 0) scale_ = curvature(z);
    if (!(scale_ > 0) || !std::isfinite(scale_)) return false;
    for (double& zi : z) zi /= scale_;
    return true;
  }

 private:
  static bool is_same(std::span<const double> p, const FitPoint& point) {
    return std::equal(p.begin(), p.end(), point.p.begin(), point.p.end());
  }
  double curvature(std::span<const double> d) {
    std::vector<double> Hd(d.size()), Rd(d.size(), 0.0);
    run_.multiply_curvature(at_, d, Hd);
    run_.add_prior_product(at_, d, 1, Rd);
    return dot(d, Hd) / dot(d, Rd);
  }
  const BlockSparse& evaluate_hessian(std::span<const double>, const Projection&) override {
    check_failed("a fit has no Hessian of blocks", __FILE__, __LINE__);
  }

  FitRun& run_;
  FitPoint& at_;
  FitPoint trial_;
  std::vector<double> origin_;
  double scale_ = 0;
};

}  // namespace

Status fit_by_lbfgs(FitRun& run, FitPoint& at, FitGoal& goal) {
  if (run.iterations_left() <= 0) return Status::iteration_limit;
  FitObjective f(run, at);
  LBFGS direction{Preconditioner(PreconditionerKind::own)};
  Status ended = Status::interrupted;
  int small = 0;
  bool is_done = false;
  const auto observe = [&](const LiveIteration& i) {
    const double decrement = std::sqrt(std::max(0.0, 2 * i.decrement));
    run.note({.decrement = decrement, .step = i.alpha * max_abs(i.d), .trials = static_cast<int>(i.tried.size())}, at);
    small = goal.is_reached(decrement) ? small + 1 : 0;
    if (small == kSuccessive)
      ended = Status::converged;
    else if (is_lost_in_noise(decrement, at.objective(run.weight)))
      ended = Status::round_off;
    is_done = ended != Status::interrupted;
  };
  Minimizer minimizer;
  std::vector<double> p = at.p;
  const MinimizeOptions options{.max_iterations = run.iterations_left(),
                                .tolerance = 0,
                                .criterion = Criterion::first_gradient,
                                .line_search = {.tolerance = 1e-6},
                                .stop = StopToken([&] { return is_done || run.is_stopped(); })};
  const MinimizeReport report = minimizer.minimize(f, direction, {p, f.at_iterate()}, options, observe);
  return report.status == Status::interrupted ? ended : report.status;
}

}  // namespace aspic
