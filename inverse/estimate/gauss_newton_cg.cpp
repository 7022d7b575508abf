// Gauss-Newton for fields: inexact conjugate gradients for (J'J + weight R'') d = -g [Nash 2000]. With the
// preconditioner weight R'' they need about one iteration per direction that the data determine better than the prior.
#include <algorithm>
#include <cmath>

#include "estimate/fit_run.h"

namespace aspic {
namespace {

// Continues while iteration k contributes more than this, relative to the average so far, to the predicted decrease
// [Nash 2000, sec. 6]. The residual is no criterion: well determined directions dominate it and converge first. A step
// costs about twenty inner iterations, so one must contribute a twentieth.
constexpr double kWorthwhile = 0.05;

struct Solution {
  std::vector<double> d;
  double decrement = 0;  // sqrt(-g.d)
  int iterations = 0;
  bool ok = true;
};

class InnerSolver {
 public:
  InnerSolver(FitRun& run, const FitPoint& at) : run_(run), at_(at) {}

  Solution solve(std::span<const double> g) {
    const size_t n = g.size();
    Solution s{.d = std::vector<double>(n, 0.0)};
    std::vector<double> r(n), z(n), q(n), Hq(n);
    for (size_t i = 0; i < n; ++i) r[i] = -g[i];
    precondition(r, z);
    q = z;
    double rz = dot(r, z);
    double decrease = 0;  // -g.d
    while (rz > 0 && s.iterations < run_.options.max_inner && !run_.is_stopped()) {
      run_.multiply_curvature(at_, q, Hq);
      const double curvature = dot(q, Hq);
      if (!(curvature > 0) || !std::isfinite(curvature)) {
        s.ok = s.iterations > 0 && std::isfinite(curvature);
        break;
      }
      ++s.iterations;
      add_scaled(rz / curvature, q, s.d);
      add_scaled(-rz / curvature, Hq, r);
      precondition(r, z);
      const double added = rz * rz / curvature, before = rz;
      decrease += added;
      if (s.iterations * added <= kWorthwhile * decrease) break;
      rz = dot(r, z);
      for (size_t i = 0; i < n; ++i) q[i] = z[i] + rz / before * q[i];
    }
    s.decrement = std::sqrt(std::max(0.0, -dot(g, s.d)));
    return s;
  }

 private:
  void precondition(std::span<const double> r, std::span<double> z) {
    run_.solve_prior(at_.p, r, z);
    if (run_.weight > 0)
      for (double& zi : z) zi /= run_.weight;
  }

  FitRun& run_;
  const FitPoint& at_;
};

}  // namespace

Status gauss_newton_cg(FitRun& run, FitPoint& at, FitGoal& goal) {
  std::vector<double> g(at.p.size());
  for (;;) {
    if (run.is_stopped()) return run.stop_status();
    if (!run.linearize(at)) return Status::undefined;
    run.gradient(at, g);
    if (max_abs(g) == 0) return Status::converged;
    const Solution newton = InnerSolver(run, at).solve(g);
    if (run.is_stopped()) return run.stop_status();  // the direction may be truncated
    if (!newton.ok || !(newton.decrement > 0)) return Status::no_descent;
    if (goal.is_reached(newton.decrement)) return Status::converged;
    if (is_lost_in_noise(newton.decrement, at.objective(run.weight))) return Status::round_off;
    if (run.iterations_left() <= 0) return Status::iteration_limit;
    FitStep step;
    const bool found = search_along(run, at, newton.d, -newton.decrement * newton.decrement, step);
    const FitIteration done{.decrement = newton.decrement,
                            .step = step.length * max_abs(newton.d),
                            .inner = newton.iterations,
                            .trials = step.trials};
    run.note(done, at);
    if (!found) return run.is_stopped() ? run.stop_status() : Status::stuck;
    if (run.options.stop.requested()) return Status::interrupted;
  }
}

}  // namespace aspic
