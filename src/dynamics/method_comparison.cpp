#include "dynamics/method_comparison.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/stopwatch.h"

namespace aspic {
namespace {

constexpr int kMaxIterations = 1'000'000;  // practically unlimited; the time limit applies
constexpr int kRepetitions = 3;
constexpr double kWorthRepeating = 0.5;  // [s]; longer runs are hardly disturbed by other load

// Linear tets: the smallest eigenvalue of the consistent mass matrix is at least 1/5 of the smallest lumped mass.
double smallest_mass_eigenvalue(const MassMatrix& mass) {
  double least = INFINITY;
  for (const double m : mass.row_mass())
    if (m > 0) least = std::min(least, m);
  return mass.kind() == MassKind::lumped ? least : least / 5;
}

class Comparer {
 public:
  Comparer(Simulation& simulation, const ComparisonOptions& options)
      : simulation_(simulation), options_(options), base_(simulation.options().solver) {
    require_one_minimization();
  }
  ~Comparer() { simulation_.set_solver(base_); }  // options of a compared method refer to the comparer

  Comparison compare() {
    Comparison comparison;
    comparison.step = options_.step;
    comparison.interrupted = true;
    if (!take_steps_before() || !solve_reference(comparison.reference)) return comparison;
    comparison.has_reference = true;
    for (const ComparedMethod& method : options_.methods) {
      if (options_.begun) options_.begun(method.name);
      MethodResult result = run(method, comparison.reference);
      if (options_.stop.stopped()) return comparison;
      comparison.results.push_back(std::move(result));
    }
    comparison.interrupted = false;
    return comparison;
  }

 private:
  // If a step is one minimization, all methods have the same minimizer. Later stages depend on earlier ones, and a
  // single iteration need not reach a minimizer.
  void require_one_minimization() const {
    const IntegratorFacts& facts = simulation_.integrator();
    const auto require = [&](bool holds, const char* reason) {
      if (!holds)
        throw InvalidInput("the integrator " + std::string(facts.name) + " " + reason +
                           "; compare methods with an implicit one of one minimization per step, such as "
                           "backward_euler");
    };
    require(facts.is_implicit, "minimizes nothing");
    require(!facts.takes_one_iteration, "always takes one iteration");
    require(!facts.minimizes_twice, "minimizes twice per step, the second time from the first result");
    require(!facts.is_multistep || options_.step > 1, "minimizes twice in its first step (compare in a later one)");
    if (simulation_.options().adaptive.tolerance > 0)
      throw InvalidInput("adaptive steps are divided into substeps; compare methods with a constant step length");
  }

  bool take_steps_before() {
    while (simulation_.steps_taken() < options_.step - 1) {
      const StepReport report = simulation_.step({}, options_.stop);
      if (report.status == Status::interrupted) return false;
      if (!is_success(report.status))
        throw InvalidInput("step " + std::to_string(report.step) + " of the scene did not converge (" +
                           std::string(to_string(report.status)) +
                           "), so there is no state to compare from; choose an earlier step");
    }
    start_ = simulation_.snapshot();
    return true;
  }

  // With friction, a second solution keeps the normal forces of the first, so that all methods minimize the same E.
  bool solve_reference(StepReport& report) {
    if (!solve_exactly(report)) return false;
    if (!simulation_.model().friction) return true;
    lag_at_ = reference_;
    simulation_.restore(start_);
    return solve_exactly(report);
  }

  bool solve_exactly(StepReport& report) {
    SolverOptions exact;
    exact.minimize = base_.minimize;
    exact.minimize.criterion = Criterion::scale;
    exact.minimize.tolerance = 0;  // limit of double precision
    exact.minimize.max_iterations = 1000;
    exact.minimize.line_search = {};
    exact.minimize.lag_at = lag_at_;
    simulation_.set_solver(exact);
    report = simulation_.step({}, options_.stop);
    if (report.status == Status::interrupted) return false;
    if (!is_success(report.status))
      throw InvalidInput("Newton's method found no minimizer of step " + std::to_string(options_.step) +
                         " to compare with (" + std::string(to_string(report.status)) + ")");
    reference_ = simulation_.state().q;
    return true;
  }

  MethodResult run(const ComparedMethod& method, const StepReport& reference) {
    SolverOptions solver = method.solver;
    solver.minimize.max_iterations = kMaxIterations;
    // Without a line search, E may rise until the deadline; such a step is discarded.
    const bool keeps_last = solver.minimize.line_search.test != DecreaseTest::none;
    solver.time_budget = keeps_last ? options_.max_seconds : 0;
    solver.minimize.lag_at = lag_at_;
    MethodResult best;
    for (int i = 0; i < kRepetitions; ++i) {
      simulation_.restore(start_);
      simulation_.set_solver(solver);
      MethodResult result = run_once(keeps_last);
      if (i == 0 || result.seconds < best.seconds) best = std::move(result);
      if (best.seconds > kWorthRepeating || options_.stop.stopped()) break;
    }
    best.method = method.name;
    best.description = simulation_.solver_description();
    judge(reference, best);
    return best;
  }

  MethodResult run_once(bool keeps_last) {
    MethodResult result;
    Stopwatch stopwatch;
    double seconds = 0;
    int gradients = 1, hessians = 0;
    result.report = simulation_.step(
        [&](const LiveIteration& iteration) {
          seconds += stopwatch.lap();
          if (result.work.empty()) result.work.push_back({.gradients = 1});
          // The result of an iteration is the initial point of the next.
          result.work.back().value = iteration.value;
          result.work.back().gradient_norm = iteration.gradient_norm;
          gradients += iteration.gradients;
          hessians += iteration.direction.hessians;
          result.work.push_back({.iteration = static_cast<int>(result.work.size()),
                                 .gradients = gradients,
                                 .hessians = hessians,
                                 .seconds = seconds});
          stopwatch.lap();
        },
        StopToken([&] { return (!keeps_last && seconds >= options_.max_seconds) || options_.stop.stopped(); }));
    result.seconds = seconds;
    if (!result.work.empty()) {
      result.work.back().value = result.report.objective;
      result.work.back().gradient_norm = result.report.objective_gradient;
    }
    return result;
  }

  // E lies above its quadratic form M wherever V is convex, so |x - x*|_M <= |g(x)| / sqrt(smallest eigenvalue of M). A
  // method whose distance exceeds the bound from its own gradient and that of the reference found another minimizer.
  void judge(const StepReport& reference, MethodResult& result) const {
    const std::vector<double>& x = simulation_.state().q;
    std::vector<double> dx(x.size()), Mdx(x.size());
    for (size_t i = 0; i < x.size(); ++i) dx[i] = x[i] - reference_[i];
    for (size_t i = 0; i + 2 < x.size(); i += 3)
      result.distance = std::max(result.distance, std::hypot(dx[i], dx[i + 1], dx[i + 2]));
    if (result.report.status == Status::interrupted) result.distance = NAN;  // the step was discarded
    const MassMatrix& mass = *simulation_.model().mass;
    mass.multiply(dx, Mdx);
    double square = 0, norm = 0;
    for (size_t i = 0; i < x.size(); ++i) square += dx[i] * Mdx[i], norm += dx[i] * dx[i];
    result.mass_distance = std::sqrt(square);
    const double excess = result.report.objective - reference.objective;
    result.excess = result.work.empty() ? 0 : excess / (result.work.front().value - reference.objective);

    const double gradients = result.report.objective_gradient + reference.objective_gradient;
    const bool is_static = simulation_.integrator().is_static();
    result.allowed_distance = is_static ? INFINITY : gradients / std::sqrt(smallest_mass_eigenvalue(mass));
    const double noise = 1e-12 * std::abs(reference.objective);
    const bool energies_agree = std::abs(excess) <= gradients * std::sqrt(norm) + noise;
    result.same_minimizer = is_success(result.report.status) && energies_agree &&
                            (result.mass_distance <= result.allowed_distance || result.distance <= 1e-12 * size());
  }

  double size() const {
    double size = 0;
    for (const double q : reference_) size = std::max(size, std::abs(q));
    return size;
  }

  Simulation& simulation_;
  const ComparisonOptions& options_;
  const SolverOptions base_;
  Simulation::Snapshot start_;
  std::vector<double> reference_;  // q after the step
  std::vector<double> lag_at_;     // q at which normal forces of friction are evaluated; empty without friction
};

}  // namespace

Comparison compare_methods(Simulation& simulation, const ComparisonOptions& options) {
  return Comparer(simulation, options).compare();
}

}  // namespace aspic
