// Terms of fibres and muscle: derivatives, directions at quadrature points, loss.
#include "energy/fibres.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dynamics/step_derivatives.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

TetMesh fibrous_mesh(int order) {
  const TetMesh box = make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {2, 1, 1});
  return order == 2 ? raise_order(box) : box;
}

std::vector<double> stretched_positions(const TetMesh& mesh, double stretch, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-0.03, 0.03);
  std::vector<double> x;
  for (const Vec3d& X : mesh.rest)
    for (int r = 0; r < 3; ++r) x.push_back(stretch * X[r] + 0.2 * X[(r + 1) % 3] + noise(random));
  return x;
}

// Directions that differ between the points of a tet.
template <class Fibre>
std::vector<Fibre> fibres_in(const TetMesh& mesh, const Fibre& like) {
  std::vector<Fibre> fibres(mesh.tets.size(), like);
  for (size_t t = 0; t < fibres.size(); ++t)
    for (int q = 0; q < 4; ++q) {
      const Vec3d a = {{1, 0.1 * static_cast<double>(t), 0.3 * q}};
      fibres[t].directions[q] = (1 / norm(a)) * a;
    }
  return fibres;
}

void expect_term_derivatives(Energy& V, const TetMesh& mesh, const StepContext& step, const std::vector<double>& x) {
  Couplings couplings;
  V.add_couplings(couplings);
  const BlockPattern pattern = make_pattern(mesh.vertex_count(), couplings);
  V.bind(pattern);
  const DerivativeReport report = check_derivatives(differentiable(ActiveTerm(V, step), pattern), x, {.length = 0.3});
  for (const DerivativeCheck* check : {&report.gradient, &report.hessian})
    EXPECT_TRUE(check->passed) << V.name() << ", " << entry_name(check->row) << ": " << check->smallest_error;
}

Activation half_activation() {
  return [](double) { return 0.5; };
}

TEST(Fibres, DerivativesOfEveryLawAreRight) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = fibrous_mesh(order);
    const std::vector<double> start = stretched_positions(mesh, 1.15, 1), x = stretched_positions(mesh, 1.1, 2);
    const StepContext step{start, 0.1, 0.1};
    const FibrePlace place{"fibre", mesh};
    const MuscleVelocity slowed{{{}, 2, 1.1}, 3, 0.25, 1.5};
    expect_term_derivatives(*make_fibres(place, fibres_in(mesh, Fibre{{}, 3, 0.8, 0.1})), mesh, step, x);
    expect_term_derivatives(*make_fibres(place, fibres_in(mesh, GuccioneFibre{{}, 3, 4, 1, 2})), mesh, step, x);
    expect_term_derivatives(*make_fibres(place, fibres_in(mesh, WeissFibre{{}, 3, 5, 1.6, 40})), mesh, step, x);
    expect_term_derivatives(*make_muscle(place, fibres_in(mesh, MuscleFibre{{}, 2, 1.1}), half_activation()), mesh,
                            step, x);
    expect_term_derivatives(*make_muscle(place, fibres_in(mesh, TensionFibre{{}, 2}), half_activation()), mesh, step,
                            x);
    expect_term_derivatives(*make_muscle_velocity(place, fibres_in(mesh, slowed), half_activation()), mesh, step, x);
  }
}

// psi = T/2 (|F a|^2 - 1) for the mean of a a' over the points.
TEST(Fibres, UseTheDirectionOfEachQuadraturePoint) {
  const TetMesh mesh = fibrous_mesh(2);
  const auto fibres = fibres_in(mesh, TensionFibre{{}, 1});
  const auto term = make_muscle({"muscle", mesh}, fibres, [](double) { return 1.0; });
  std::vector<double> x;
  for (const Vec3d& X : mesh.rest) x.insert(x.end(), {2 * X[0], X[1], X[2]});
  double exact = 0;
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (const Vec3d& a : fibres[t].directions) exact += volume(mesh, t) / 4 * 0.5 * 3 * a[0] * a[0];
  EXPECT_NEAR(ActiveTerm(*term).value(x), exact, 1e-14);
}

TEST(MuscleVelocity, DerivativesWithRespectToTheStartAreRight) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = fibrous_mesh(order);
    const auto term = make_muscle_velocity(
        {"muscle_velocity", mesh}, fibres_in(mesh, MuscleVelocity{{{}, 2, 1.1}, 3, 0.25, 1.5}), half_activation());
    const std::vector<double> start = stretched_positions(mesh, 1.15, 1), x = stretched_positions(mesh, 1.1, 2),
                              w = stretched_positions(mesh, 0.3, 3), d = stretched_positions(mesh, 0.1, 4);
    const auto work = [&](double shift) {
      std::vector<double> moved = start, g(x.size());
      for (size_t i = 0; i < moved.size(); ++i) moved[i] += shift * d[i];
      ActiveTerm(*term, {moved, 0.1, 0.1}).add_gradient(x, 1, g);
      double sum = 0;
      for (size_t i = 0; i < g.size(); ++i) sum += w[i] * g[i];
      return sum;
    };
    std::vector<double> gradient(x.size());
    const ActiveTerm active(*term, {start, 0.1, 0.1});
    term->add_derivatives(x, active.context(), w, 2, {gradient, {}});
    double rate = 0;
    for (size_t i = 0; i < d.size(); ++i) rate += gradient[i] * d[i];
    constexpr double kShift = 1e-5;
    EXPECT_NEAR(rate, (work(kShift) - work(-kShift)) / kShift, 1e-6 * std::abs(rate));
    EXPECT_GT(std::abs(rate), 0.01);
  }
}

TEST(MuscleVelocity, NeverCreatesEnergyAndVanishesInStatics) {
  const TetMesh mesh = fibrous_mesh(2);
  const auto term = make_muscle_velocity(
      {"muscle_velocity", mesh}, fibres_in(mesh, MuscleVelocity{{{}, 2, 1.1}, 3, 0.25, 1.5}), half_activation());
  const std::vector<double> start = stretched_positions(mesh, 1.1, 1);
  for (unsigned seed = 2; seed < 12; ++seed) {
    const std::vector<double> x = stretched_positions(mesh, 0.8 + 0.05 * seed, seed);
    const ActiveTerm active(*term, {start, 0.1, 0.1}), still(*term, {start, 0, 0.1});
    EXPECT_GE(active.value(x), 0);
    EXPECT_EQ(still.value(x), 0);
  }
}

}  // namespace
}  // namespace aspic
