#include "model/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/check.h"
#include "base/formatted.h"
#include "dynamics/incremental_potential.h"
#include "energy/lagged_product.h"
#include "linalg/auto_solver.h"
#include "math/vectors.h"
#include "model/elastic_parameters.h"
#include "model/limits.h"
#include "optimize/newton.h"

namespace aspic {
namespace {

std::string message_of(const MinimizeReport& report) {
  const std::string status(to_string(report.status));
  if (report.status == Status::undefined) return "the energy is not finite at the initial guess (" + status + ")";
  return "no equilibrium was found: " + status + " after " + std::to_string(report.iterations) +
         " iterations; residual force " + three_digits(report.reached) + " N, tolerance " +
         three_digits(report.threshold) + " N";
}

// Fills b with parts along all modes of a body, identically on every system.
void fill_without_pattern(std::span<double> b) {
  for (size_t i = 0; i < b.size(); ++i) b[i] = std::sin(1.0 + 12.9898 * static_cast<double>(i % 100'003));
}

}  // namespace

struct Equilibrium::Impl {
  Impl(Model m, std::vector<double> start, const EquilibriumOptions& o)
      : options(o),
        model(std::move(m)),
        x(std::move(start)),
        pins(model.pins, x),
        E(model, pins),
        newton(make_linear_solver(o.linear)),
        solver(make_linear_solver(o.adjoint, o.solves)),
        K(E.pattern()),
        theta(model) {
    minimize.tolerance = o.tolerance;
    minimize.max_iterations = o.max_iterations;
    minimize.updates_lagged = true;
    for (const auto& D : model.damping)
      if (const auto* term = dynamic_cast<const LaggedProduct*>(D.get())) lagged.push_back(term);
    pins.place(0, x);
    parameters = linear_parameters = theta.get();
    for (auto* v : {&trial, &b, &u}) v->resize(x.size());
    if (pins.any_moves()) all_rows.emplace(E.pattern());
    linear_x.reserve(x.size());
  }

  void update_terms(std::span<const double> at) {
    const StepContext context{at, 0, 0};
    E.at({.predicted = at, .inertia = 0, .context = context, .counts_pinned_forces = true});
  }

  MinimizeReport solve(const IterationObserver& observe) {
    use(parameters);
    std::copy(x.begin(), x.end(), trial.begin());
    update_terms(x);
    const MinimizeReport report = minimizer.minimize(E, newton, trial, minimize, observe);
    if (is_success(report.status)) {
      std::swap(x, trial);
    } else {
      failure = message_of(report);
    }
    return report;
  }

  bool factorize() {
    linear_x.clear();
    use(parameters);
    update_terms(x);
    K.block = E.hessian(x, {Definiteness::exact}).block;  // copied, because E may overwrite it
    if (all_rows) {
      all_rows->set_zero();
      for (const ActiveTerm& V : E.terms().potential()) V.add_hessian(x, 1, {Definiteness::exact}, *all_rows);
    }
    stiff_rows = E.traits().stiff_rows->stiff_rows();
    solver->set_stiff_rows(stiff_rows.empty() ? nullptr : &stiff_rows);
    if (!is_analyzed) solver->analyze(E.pattern());
    is_analyzed = true;
    solver->begin();
    if (!solver->factorize(K)) return refuse();
    linear_x.assign(x.begin(), x.end());
    linear_parameters = parameters;
    if (as_cholesky(*solver)) return true;
    // Conjugate gradients detect an indefinite matrix by negative curvature, at the latest when the residual is smaller
    // than the part of b along any mode.
    fill_without_pattern(b);
    pins.set_zero(b);
    const SolveReport report = solver->solve(b, u, 0.01 / std::sqrt(static_cast<double>(b.size())));
    if (!report.indefinite && std::isfinite(report.relative_residual)) return true;
    linear_x.clear();
    return refuse();
  }

  bool refuse() {
    const Cholesky* cholesky = as_cholesky(*solver);
    failure = cholesky && cholesky->refused()
                  ? "the factor of the stiffness matrix does not fit into memory: " + solver->description() +
                        " (try the solver 'multigrid')"
                  : "the stiffness matrix is not positive definite: the equilibrium is unstable, or nothing holds "
                    "the body";
    return false;
  }

  SolveReport solve_stiffness(std::span<const double> rhs, std::span<double> result, bool is_transposed = false) {
    ASPIC_CHECK(!linear_x.empty());
    if (rhs.data() != b.data()) std::copy(rhs.begin(), rhs.end(), b.begin());
    const SolveReport report = solve_symmetric(result);
    return lagged.empty() || !report.ok ? report : add_lagged(report, result, is_transposed);
  }

  SolveReport solve_symmetric(std::span<double> result) {
    pins.set_zero(b);
    SolveReport report = solver->solve(b, result, options.adjoint_tolerance);
    report.ok = report.ok || (!report.indefinite && report.relative_residual <= kStagnated);
    return report;
  }

  // result = (S + C)^-1 b from S^-1 b, as the sum of (-S^-1 C)^k S^-1 b.
  SolveReport add_lagged(SolveReport report, std::span<double> result, bool is_transposed) {
    std::vector<double> term(result.begin(), result.end());
    for (int k = 0; k < kMaxTerms; ++k) {
      std::fill(b.begin(), b.end(), 0.0);
      for (const LaggedProduct* D : lagged)
        is_transposed ? D->add_lagged_transposed(linear_x, term, -1, b) : D->add_lagged_product(linear_x, term, -1, b);
      report = solve_symmetric(term);
      if (!report.ok) return report;
      add_scaled(1, term, result);
      report.relative_residual = norm(term) / norm(result);
      if (!(report.relative_residual > options.adjoint_tolerance)) return report;
    }
    report.ok = report.relative_residual <= kStagnated;
    return report;
  }

  SolveReport tangent(std::span<const double> dtheta, std::span<double> dx) {
    use(linear_parameters);
    std::fill(b.begin(), b.end(), 0.0);
    theta.add_force(linear_x, dtheta, -1, b);
    return solve_stiffness(b, dx);
  }

  SolveReport add_adjoint(std::span<const double> xbar, std::span<double> thetabar) {
    use(linear_parameters);
    const SolveReport report = solve_stiffness(xbar, u, true);
    theta.add_gradient(linear_x, u, -1, thetabar);
    return report;
  }

  void force_tangent(std::span<const double> dtheta, std::span<const double> dx, std::span<double> dg) {
    ASPIC_CHECK(all_rows && !linear_x.empty());
    use(linear_parameters);
    all_rows->multiply(dx, dg);
    if (!dtheta.empty()) theta.add_force(linear_x, dtheta, 1, dg);
  }

  void add_force_transposed(std::span<const double> gbar, std::span<double> xbar, std::span<double> thetabar) {
    ASPIC_CHECK(all_rows && !linear_x.empty());
    use(linear_parameters);
    all_rows->multiply(gbar, u);
    for (size_t i = 0; i < u.size(); ++i) xbar[i] += u[i];
    theta.add_gradient(linear_x, gbar, 1, thetabar);
  }

  // Sets the parameters of the elastic terms to those of the last solve or the linearization.
  void use(const std::vector<MaterialParameters>& wanted) {
    if (in_force == &wanted) return;
    theta.set(wanted);
    in_force = &wanted;
  }

  // Of add_lagged(): terms that shrink by 20 % reach 1e-9. Slower ones are refused.
  static constexpr int kMaxTerms = 100;

  EquilibriumOptions options;
  Model model;
  std::vector<double> x;
  Pins pins;
  IncrementalPotential E;
  Newton newton;
  Minimizer minimizer;
  MinimizeOptions minimize;
  std::unique_ptr<LinearSolver> solver;  // factorization of K
  BlockSparse K;
  StiffRows stiff_rows;                 // of K
  std::optional<BlockSparse> all_rows;  // K with the rows of pinned vertices, if they move
  ElasticParameters theta;
  std::vector<const LaggedProduct*> lagged;
  std::vector<MaterialParameters> parameters, linear_parameters;
  const std::vector<MaterialParameters>* in_force = &parameters;
  std::vector<double> linear_x;  // empty: no derivatives
  bool is_analyzed = false;
  std::string failure;
  std::vector<double> trial, b, u;  // scratch
};

Equilibrium::Equilibrium(Model model, std::vector<double> x, const EquilibriumOptions& options)
    : impl_(std::make_unique<Impl>(std::move(model), std::move(x), options)) {}
Equilibrium::~Equilibrium() = default;
Equilibrium::Equilibrium(Equilibrium&&) noexcept = default;

const Model& Equilibrium::model() const { return impl_->model; }
Model& Equilibrium::model() { return impl_->model; }
int Equilibrium::parameters_per_tet() const { return impl_->model.elasticity.front()->parameter_count(); }

void Equilibrium::set_parameters(std::span<const MaterialParameters> parameters) {
  impl_->parameters.assign(parameters.begin(), parameters.end());
  impl_->in_force = nullptr;
}

MinimizeReport Equilibrium::solve(const IterationObserver& observe) { return impl_->solve(observe); }
std::span<const double> Equilibrium::x() const { return impl_->x; }

void Equilibrium::set_x(std::span<const double> x) {
  std::copy(x.begin(), x.end(), impl_->x.begin());
  impl_->pins.place(0, impl_->x);
}

bool Equilibrium::factorize() { return impl_->factorize(); }
std::span<const double> Equilibrium::linearized_x() const { return impl_->linear_x; }
SolveReport Equilibrium::solve_stiffness(std::span<const double> b, std::span<double> u, bool is_transposed) {
  return impl_->solve_stiffness(b, u, is_transposed);
}
SolveReport Equilibrium::tangent(std::span<const double> dtheta, std::span<double> dx) {
  return impl_->tangent(dtheta, dx);
}
SolveReport Equilibrium::add_adjoint(std::span<const double> xbar, std::span<double> thetabar) {
  return impl_->add_adjoint(xbar, thetabar);
}
void Equilibrium::add_forces(std::span<double> g) const {
  for (const ActiveTerm& V : impl_->E.terms().potential()) V.add_gradient(impl_->x, 1, g);
}
void Equilibrium::force_tangent(std::span<const double> dtheta, std::span<const double> dx, std::span<double> dg) {
  impl_->force_tangent(dtheta, dx, dg);
}
void Equilibrium::add_force_transposed(std::span<const double> gbar, std::span<double> xbar,
                                       std::span<double> thetabar) {
  impl_->add_force_transposed(gbar, xbar, thetabar);
}
const std::string& Equilibrium::failure() const { return impl_->failure; }
std::string Equilibrium::solver_description() const { return impl_->solver->description(); }

}  // namespace aspic
