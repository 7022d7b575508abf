// Maxwell branches: derivatives, limits, energies.
#include "energy/maxwell_branches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/parallel.h"
#include "dynamics/step_derivatives.h"
#include "energy/internal_variables.h"
#include "energy/maxwell_factors.h"
#include "energy/tet_elasticity.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "mesh/vertices.h"

namespace aspic {
namespace {

const TetMesh& mesh_of_order(int order) {
  static const TetMesh linear = make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {3, 2, 2}), quadratic = raise_order(linear);
  return order == 1 ? linear : quadratic;
}

std::vector<double> deformed(const TetMesh& mesh, double amount, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  std::vector<double> x = rest_positions(mesh);
  for (double& xi : x) xi += uniform(random);
  for (size_t i = 0; i < x.size(); i += 3) x[i] += amount * x[i + 1], x[i + 2] *= 1 + amount;
  return x;
}

// A term in a step of 0.1 s that starts at a deformed shape with random stresses. One branch is absent from some tets.
struct Branches {
  explicit Branches(int order) : mesh(mesh_of_order(order)) {
    std::vector<double> some(mesh.tets.size());
    for (size_t t = 0; t < some.size(); ++t) some[t] = t % 5 == 0 ? 0 : 1 + 0.01 * static_cast<double>(t);
    V = make_maxwell_branches("viscoelastic", mesh, 0,
                              {{std::vector<double>(mesh.tets.size(), 2.0), 0.05}, {some, 0.4}});
    variables = dynamic_cast<const InternalVariables*>(V.get());
    Couplings couplings;
    V->add_couplings(couplings);
    pattern = make_pattern(mesh.vertex_count(), couplings);
    V->bind(pattern);
    z.resize(variables->internal_range().size());
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-0.3, 0.3);
    const int per_point = 12, points = order == 1 ? 1 : 4;
    for (size_t k = 0; k < z.size(); ++k)
      z[k] = k % per_point >= 6 && some[k / (per_point * points)] == 0 ? 0 : uniform(random);
    start = deformed(mesh, 0.03, 1);
    end = deformed(mesh, 0.05, 2);
  }
  ActiveTerm active() const {
    ActiveTerm term(*V, {start, 0.1, 0.1});
    variables->begin_internal(z, 0.1, term.context());
    return term;
  }
  std::vector<double> z_end(const ActiveTerm& term) const {
    std::vector<double> values(z.size());
    variables->end_internal(end, term.context(), values);
    return values;
  }

  const TetMesh& mesh;
  std::unique_ptr<Energy> V;
  const InternalVariables* variables;
  BlockPattern pattern;
  std::vector<double> z, start, end;
};

TEST(MaxwellBranches, DerivativesMatchDifferences) {
  for (const int order : {1, 2}) {
    const Branches b(order);
    const DerivativeReport report = check_derivatives(differentiable(b.active(), b.pattern), b.end, {.length = 0.2});
    for (const DerivativeCheck* check : {&report.gradient, &report.hessian}) {
      EXPECT_TRUE(check->passed) << order << ", " << entry_name(check->row) << ": " << check->smallest_error;
      EXPECT_TRUE(std::isnan(check->order) || std::abs(check->order - 2) < 0.2) << check->order;
    }
  }
}

TEST(MaxwellBranches, ProjectedHessianIsPositive) {
  for (const int order : {1, 2}) {
    const Branches b(order);
    const ActiveTerm term = b.active();
    int most = 0;
    for (const Definiteness kind : {Definiteness::clamped, Definiteness::absolute}) {
      BlockSparse H(b.pattern);
      most = std::max(most, term.add_hessian(b.end, 1, {kind}, H));
      std::mt19937 random(7);
      std::uniform_real_distribution<double> uniform(-1, 1);
      std::vector<double> d(b.end.size()), Hd(b.end.size());
      for (int k = 0; k < 50; ++k) {
        double product = 0;
        for (double& di : d) di = uniform(random);
        H.multiply(d, Hd);
        for (size_t i = 0; i < d.size(); ++i) product += d[i] * Hd[i];
        EXPECT_GE(product, 0);
      }
    }
    EXPECT_GT(most, 0) << "no element had to be modified";
  }
}

TEST(MaxwellBranches, ShortRelaxationIsStrainRateDamping) {
  constexpr double kViscosity = 3, kTime = 1e-9, kH = 0.1;
  for (const int order : {1, 2}) {
    const TetMesh& mesh = mesh_of_order(order);
    const std::vector<double> start = deformed(mesh, 0.03, 1), x = deformed(mesh, 0.05, 2);
    const auto branch = make_maxwell_branches("viscoelastic", mesh, 0,
                                              {{std::vector<double>(mesh.tets.size(), kViscosity / 2 / kTime), kTime}});
    const auto damping = make_strain_rate_damping(mesh, 0, std::vector<double>(mesh.tets.size(), kViscosity));
    const ActiveTerm a(*branch, {start, kH, kH}), b(*damping, {start, kH, kH});
    EXPECT_NEAR(a.value(x), b.value(x), 1e-7 * b.value(x));
    std::vector<double> ga(x.size()), gb(x.size());
    a.add_gradient(x, 1, ga);
    b.add_gradient(x, 1, gb);
    const double largest = std::abs(*std::max_element(gb.begin(), gb.end()));
    for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(ga[i], gb[i], 1e-7 * largest);
  }
}

TEST(MaxwellBranches, RotationsOfTheEndChangeNothing) {
  const Branches b(2);
  const ActiveTerm term = b.active();
  const double c = std::cos(0.7), s = std::sin(0.7);
  std::vector<double> turned = b.end;
  for (size_t i = 0; i < turned.size(); i += 3) {
    turned[i] = c * b.end[i] - s * b.end[i + 1] + 3;
    turned[i + 1] = s * b.end[i] + c * b.end[i + 1];
  }
  EXPECT_NEAR(term.value(turned), term.value(b.end), 1e-13 * std::abs(term.value(b.end)));
  std::vector<double> z(b.z.size());
  b.variables->end_internal(turned, term.context(), z);
  const std::vector<double> expected = b.z_end(term);
  for (size_t k = 0; k < z.size(); ++k) EXPECT_NEAR(z[k], expected[k], 1e-13);
}

// D dominates the gain of stored energy, which backward Euler's energy bound needs.
TEST(MaxwellBranches, GainIsAtMostPotential) {
  for (const int order : {1, 2}) {
    const Branches b(order);
    const ActiveTerm term = b.active();
    const InternalEnergies e = b.variables->internal_energies({b.start, b.end, b.z_end(term)}, term.context());
    EXPECT_GT(e.loss, 0);
    EXPECT_LE(e.gain, term.value(b.end));
    EXPECT_NEAR(term.value(b.start), 0, 1e-15);
  }
}

// For small strains the work is at least stored plus dissipated energy: the step creates none.
TEST(MaxwellBranches, SmallStrainsLoseEnergyNumerically) {
  Branches b(1);
  for (const double scale : {1e-5, -1e-5, 3e-6}) {
    b.start = rest_positions(b.mesh);
    b.end = b.start;
    for (size_t i = 0; i < b.end.size(); ++i) b.end[i] += scale * std::sin(5.0 * static_cast<double>(i));
    for (double& z : b.z) z *= std::abs(scale);
    const ActiveTerm term = b.active();
    const InternalEnergies e = b.variables->internal_energies({b.start, b.end, b.z_end(term)}, term.context());
    EXPECT_GT(e.work - e.gain - e.loss, 0);
    EXPECT_GT(e.loss, 0);
  }
}

TEST(MaxwellBranches, SameBitsForAnyNumberOfThreads) {
  const Branches b(2);
  const int before = thread_count();
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    const ActiveTerm term = b.active();
    std::vector<double> numbers = b.z_end(term);
    const InternalEnergies e = b.variables->internal_energies({b.start, b.end, numbers}, term.context());
    numbers.insert(numbers.end(), {term.value(b.end), e.work, e.gain, e.loss});
    results.push_back(numbers);
  }
  set_thread_count(before);
  EXPECT_EQ(results[0], results[1]);
}

// Simpson's rule on the stress within the step.
double dissipation(double x, double s, double w) {
  constexpr int kCells = 20000;
  const auto squared = [&](double y) {
    const double stress = std::exp(-y) * s - std::expm1(-y) / x * w;
    return stress * stress;
  };
  double sum = squared(0) + squared(x);
  for (int i = 1; i < kCells; ++i) sum += (i % 2 ? 4 : 2) * squared(x * i / kCells);
  return sum * x / kCells / 3;
}

TEST(MaxwellFactors, MatchQuadrature) {
  for (const double x : {1e-4, 0.01, 0.3, 0.69, 0.7, 1.0, 3.0, 20.0}) {
    const MaxwellFactors f = maxwell_factors(x);
    for (const auto& [s, w] : {std::pair(1.0, 0.0), {0.0, 1.0}, {1.0, -1.5}, {0.4, 2.0}}) {
      const double mixed = s + f.mixture * w, closed = f.loss_sum * mixed * mixed + f.loss_rest * w * w;
      EXPECT_NEAR(closed, dissipation(x, s, w), 1e-9 * (s * s + w * w) * std::min(x, 1.0)) << x;
    }
  }
}

TEST(MaxwellFactors, AreContinuousAndNotNegative) {
  for (int k = -300; k < 150; ++k) {
    const double x = std::pow(1.1, k);
    const MaxwellFactors f = maxwell_factors(x), next = maxwell_factors(x * (1 + 1e-9));
    EXPECT_GE(f.loss_sum, 0);
    EXPECT_GE(f.loss_rest, 0);
    EXPECT_NEAR(f.loss_rest, next.loss_rest, 1e-7 * f.loss_rest) << x;
    EXPECT_NEAR(f.decay + f.phi * x, 1, 1e-12 * (1 + x)) << x;
  }
  EXPECT_EQ(maxwell_factors(0).decay, 1);
  EXPECT_EQ(maxwell_factors(0).phi, 1);
  EXPECT_NEAR(maxwell_factors(1e-9).loss_rest, 1e-9 / 12, 1e-16);
}

}  // namespace
}  // namespace aspic
