#include "dynamics/stable_step.h"

#include <cmath>
#include <limits>
#include <vector>

#include "linalg/linear_solver.h"

namespace aspic {
namespace {

constexpr int kIterations = 100;
constexpr double kSettled = 1e-3;         // relative change of the frequency between two iterations
constexpr double kSolveTolerance = 1e-6;  // of M

double norm(std::span<const double> v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

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
  for (Energy* D : E.damping()) D->begin_step({.start = x});  // h = 0: no damping
  E.begin_step(x, 0, 1);
  const BlockSparse& K = E.hessian(x, {Definiteness::clamped});

  // Neighbours move against each other in the fastest vibration.
  std::vector<double> u(x.size()), Ku(x.size());
  for (size_t i = 0; i < u.size(); ++i) u[i] = std::cos(2.4 * static_cast<double>(i)) + 0.1;
  pins.set_zero(u);
  double square = 0;  // of the angular frequency [1/s^2]
  for (int i = 0; i < kIterations && norm(u) > 0; ++i) {
    const double scale = 1 / norm(u);
    for (double& ui : u) ui *= scale;
    K.multiply(u, Ku);
    pins.set_zero(Ku);
    solver->solve(Ku, u, kSolveTolerance);
    pins.set_zero(u);
    const double last = square;
    square = norm(u);
    if (std::abs(square - last) <= kSettled * square) break;
  }
  return {.h = square > 0 ? 2 / std::sqrt(square) : std::numeric_limits<double>::infinity(),
          .vertex = largest_vertex(u)};
}

}  // namespace aspic
