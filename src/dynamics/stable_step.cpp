#include "dynamics/stable_step.h"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "dynamics/incremental_potential.h"
#include "linalg/linear_solver.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr int kIterations = 100;
constexpr double kSettled = 1e-3;             // relative change of h^2 between two iterations
constexpr double kPowerStepTolerance = 1e-6;  // tolerance of solves with M

int largest_vertex(std::span<const double> v) {
  int largest = -1;
  double most = 0;
  for (size_t i = 0; i + 2 < v.size(); i += 3) {
    const double size = norm(v.subspan(i, 3));
    if (size > most) most = size, largest = static_cast<int>(i / 3);
  }
  return largest;
}

// Power iteration for M^-1 (h^2 K + weight h C). The critical motion has the largest eigenvalue.
class PowerIteration {
 public:
  PowerIteration(const BlockSparse& M, const BlockSparse& C, const BlockSparse& K, const Pins& pins,
                 LinearSolver& solver)
      : M_(M), C_(C), K_(K), pins_(pins), solver_(solver) {}

  StableStep run(size_t size, double weight, bool is_rk4) {
    for (auto* v : {&u_, &Mu_, &Ku_, &Cu_}) v->resize(size);
    // In the fastest vibration, neighbors move in opposite directions.
    for (size_t i = 0; i < size; ++i) u_[i] = std::cos(2.4 * static_cast<double>(i)) + 0.1;
    pins_.set_zero(u_);
    StableStep stable{.h = std::numeric_limits<double>::infinity()};
    double last = stable.h;
    for (int i = 0; i < kIterations && norm(u_) > 0; ++i) {
      const auto [c, k] = quotients();
      if (!(k > 0 || c > 0)) break;
      const double h = symplectic_euler_limit(c, k);
      stable = {.h = is_rk4 ? rk4_limit(c, k) : h,
                .vertex = largest_vertex(u_),
                .frequency = std::sqrt(k) / (2 * std::numbers::pi),
                .is_damping = is_rk4 ? c * c > 4 * k : 2 * c > h * k};
      if (std::abs(h * h - last * last) <= kSettled * h * h) break;
      last = h;
      multiply(h * h, weight * h);
    }
    return stable;
  }

 private:
  struct Quotients {
    double c, k;
  };
  Quotients quotients() {
    const double scale = 1 / norm(u_);
    for (double& ui : u_) ui *= scale;
    M_.multiply(u_, Mu_);
    K_.multiply(u_, Ku_);
    C_.multiply(u_, Cu_);
    const double m = dot(u_, Mu_);
    return {dot(u_, Cu_) / m, dot(u_, Ku_) / m};
  }
  void multiply(double stiffness, double damping) {
    for (size_t j = 0; j < u_.size(); ++j) Ku_[j] = stiffness * Ku_[j] + damping * Cu_[j];
    pins_.set_zero(Ku_);
    solver_.solve(Ku_, u_, kPowerStepTolerance);
    pins_.set_zero(u_);
  }

  const BlockSparse &M_, &C_, &K_;
  const Pins& pins_;
  LinearSolver& solver_;
  std::vector<double> u_, Mu_, Ku_, Cu_;
};

}  // namespace

// Solves h^2 k + 2 h c = 4.
double symplectic_euler_limit(double c, double k) { return 4 / (c + std::sqrt(c * c + 4 * k)); }

// The root of larger magnitude limits the step.
double rk4_limit(double c, double k) {
  const std::complex<double> root = -(c + std::sqrt(std::complex<double>(c * c - 4 * k))) / 2.0;
  const double rate = std::abs(root);
  if (rate == 0) return std::numeric_limits<double>::infinity();
  const auto grows = [&](double s) {
    const std::complex<double> z = s * root / rate;
    return std::abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))) > 1 + 1e-14;
  };
  double low = 2.5, high = low;  // stable in the left half of the disc of this radius
  while (!grows(high)) low = high, high += 0.01;
  for (int i = 0; i < 40; ++i) (grows((low + high) / 2) ? high : low) = (low + high) / 2;
  return low / rate;
}

StableStep stable_step(const IncrementalPotential& E, const Model& model, const Pins& pins, std::span<const double> x,
                       StabilityLimit limit) {
  BlockSparse M(E.pattern());
  model.mass->add_to(1, M);
  pins.set_identity(M);
  const auto solver = make_linear_solver("auto");
  solver->analyze(E.pattern());
  if (!solver->factorize(M)) return {.h = 0};
  BlockSparse C(E.pattern()), K(E.pattern());
  for (const ActiveTerm& D : E.terms().damping())
    ActiveTerm(D.energy(), {.start = x, .h = 1, .shape = x}).add_hessian(x, 1, {Definiteness::clamped}, C);
  for (const ActiveTerm& V : E.terms().potential()) V.add_hessian(x, 1, {Definiteness::clamped}, K);
  pins.set_identity(K);
  PowerIteration iteration(M, C, K, pins, *solver);
  const bool is_rk4 = limit == StabilityLimit::rk4;
  const auto run = [&](double weight) {
    StableStep found = iteration.run(x.size(), weight, is_rk4);
    if (found.vertex >= 0) found.vertex = model.vertex_of_row(found.vertex);
    return found;
  };
  const StableStep stable = run(2);
  if (!is_rk4 || E.terms().damping().empty()) return stable;
  const StableStep fastest = run(0);
  return fastest.h < stable.h ? fastest : stable;
}

}  // namespace aspic
