#include "dynamics/stable_step.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "linalg/linear_solver.h"

namespace aspic {
namespace {

constexpr int kIterations = 100;
constexpr double kSettled = 1e-3;         // relative change of h^2 between two iterations
constexpr double kSolveTolerance = 1e-6;  // of M

double product(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double norm(std::span<const double> v) { return std::sqrt(product(v, v)); }

int largest_vertex(std::span<const double> v) {
  int largest = -1;
  double most = 0;
  for (size_t i = 0; i + 2 < v.size(); i += 3) {
    const double size = norm(v.subspan(i, 3));
    if (size > most) most = size, largest = static_cast<int>(i / 3);
  }
  return largest;
}

}  // namespace

StableStep stable_step(IncrementalPotential& E, const Model& model, const Pins& pins, std::span<const double> x) {
  BlockSparse M(E.pattern());
  model.mass->add_to(1, M);
  pins.set_identity(M);
  const auto solver = make_linear_solver("auto");
  solver->analyze(E.pattern());
  if (!solver->factorize(M)) return {.h = 0};
  BlockSparse C(E.pattern());
  for (Energy* D : E.damping()) {
    D->begin_step({.start = x, .h = 1, .shape = x});
    D->add_hessian(x, 1, {Definiteness::clamped}, C);
    D->begin_step({.start = x});  // h = 0: no damping
  }
  E.begin_step(x, 0, 1);
  const BlockSparse& K = E.hessian(x, {Definiteness::clamped});

  // Neighbours move against each other in the fastest vibration.
  std::vector<double> u(x.size()), Mu(x.size()), Ku(x.size()), Cu(x.size());
  for (size_t i = 0; i < u.size(); ++i) u[i] = std::cos(2.4 * static_cast<double>(i)) + 0.1;
  pins.set_zero(u);
  StableStep stable{.h = std::numeric_limits<double>::infinity()};
  for (int i = 0; i < kIterations && norm(u) > 0; ++i) {
    const double scale = 1 / norm(u);
    for (double& ui : u) ui *= scale;
    M.multiply(u, Mu);
    K.multiply(u, Ku);
    C.multiply(u, Cu);
    const double m = product(u, Mu), k = product(u, Ku) / m, c = product(u, Cu) / m;
    if (!(k > 0 || c > 0)) break;
    // Where h^2 k + 2 h c = 4.
    const double last = stable.h, h = 4 / (c + std::sqrt(c * c + 4 * k));
    stable = {.h = h,
              .vertex = largest_vertex(u),
              .frequency = std::sqrt(k) / (2 * std::numbers::pi),
              .is_damping = 2 * c > h * k};
    if (std::abs(h * h - last * last) <= kSettled * h * h) break;
    for (size_t j = 0; j < u.size(); ++j) Ku[j] = h * h * Ku[j] + 2 * h * Cu[j];
    pins.set_zero(Ku);
    solver->solve(Ku, u, kSolveTolerance);
    pins.set_zero(u);
  }
  return stable;
}

}  // namespace aspic
