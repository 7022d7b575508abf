// Uniaxial stress with free lateral faces: small-strain moduli and reference values at large strain.
#include <gtest/gtest.h>

#include "material/states.h"
#include "reference/uniaxial.h"

namespace aspic {
namespace {

struct Uniaxial {
  double lateral;  // stretch t of the lateral directions [1]
  double stress;   // nominal stress P_11 [Pa]
};

// Applies Newton's method to P_22(diag(l, t, t)) = 0.
template <class M>
Uniaxial uniaxial(double l, double t, const typename M::template Params<double>& p) {
  for (int i = 0; i < 50; ++i) {
    const Mat9d H = M::hessian(diagonal(l, t, t), p);
    t -= M::pk1(diagonal(l, t, t), p)(1, 1) / (H(4, 4) + H(4, 8));
  }
  return {t, M::pk1(diagonal(l, t, t), p)(0, 0)};
}

TEST(Materials, ReproduceYoungAndPoissonAtSmallStrain) {
  for_each_material([]<class M>() {
    for (const double poisson : {-0.3, 0.0, 0.3, 0.45, 0.499}) {
      const double young = 3e5, strain = 1e-4;  // central differences have an error of about strain^2
      const auto p = ordinary_params<M>(young, poisson);
      const Uniaxial pull = uniaxial<M>(1 + strain, 1, p), push = uniaxial<M>(1 - strain, 1, p);
      const double measured_young = (pull.stress - push.stress) / (2 * strain);
      const double measured_poisson = -(pull.lateral - push.lateral) / (2 * strain);
      const Lame lame = lame_from_young_poisson(young, poisson);
      const bool mu_only = std::is_same_v<M, Arap>;
      // Fibres straighten from rest on, over E = 0.03: the pull of 1e-4 already meets a part of their stiffness. Their
      // Hessian at rest is tested below.
      const double bound = std::is_same_v<M, NeoHookeanFibres> ? 0.01 : 1e-6;
      EXPECT_NEAR(measured_young, mu_only ? 2 * lame.mu : young, bound * young) << M::info().name << ' ' << poisson;
      EXPECT_NEAR(measured_poisson, mu_only ? 0 : poisson, bound) << M::info().name << ' ' << poisson;
    }
  });
}

TEST(Materials, HaveHessianOfLinearElasticityAtRest) {
  for_each_material([]<class M>() {
    for (const double poisson : {-0.3, 0.0, 0.3, 0.45, 0.499}) {
      MaterialParameters m{lame_from_young_poisson(1, poisson), {}};
      if (std::is_same_v<M, Arap>) m.lame.lambda = 0;
      const Mat9d expected = Linear::hessian(identity3<double>(), Linear::params(m));
      for (size_t k = 0; k < M::info().extra.size(); ++k) m.extra[k] = M::info().extra[k].fallback;
      const Mat9d H = M::hessian(identity3<double>(), M::params(m));
      EXPECT_LE(largest_difference(H.a, expected.a), 1e-14 * largest(expected.a)) << M::info().name;
    }
  });
}

TEST(Materials, MatchUniaxialReferenceTable) {
  const double half_a_digit = 0.51e-8;
  for (const verify::UniaxialReference& row : verify::uniaxial_table()) {
    with_material(row.material, [&]<class M>() {
      const auto p = ordinary_params<M>(1, row.poisson);
      const Uniaxial found = uniaxial<M>(row.stretch, std::pow(row.stretch, -row.poisson), p);
      EXPECT_NEAR(found.lateral, row.expected.lateral, half_a_digit) << row.material << ' ' << row.stretch;
      EXPECT_NEAR(found.stress, row.expected.stress, half_a_digit) << row.material << ' ' << row.stretch;
    });
  }
}

// Energy under uniform scaling by s: the sign of dpsi/ds shows whether a compressed body expands.
template <class M>
double pressure(double s, double poisson) {
  return trace(M::pk1(diagonal(s, s, s), ordinary_params<M>(1, poisson)));
}

TEST(NeoHookean, CollapsesBelowDocumentedSize) {
  EXPECT_GT(pressure<NeoHookean>(0.290, 0.3), 0);
  EXPECT_LT(pressure<NeoHookean>(0.292, 0.3), 0);
  EXPECT_GT(pressure<NeoHookean>(0.0905, 0.45), 0);
  EXPECT_LT(pressure<NeoHookean>(0.0915, 0.45), 0);
}

TEST(OtherInvertibleMaterials, ResistCompressionAtEverySize) {
  for (const double poisson : {-0.3, 0.0, 0.3, 0.45, 0.499})
    for (double s = 1e-6; s < 0.99; s = 1.1 * s + 1e-6) {
      EXPECT_LT(pressure<StableNeoHookean>(s, poisson), 0);
      EXPECT_LT(pressure<Corotated>(s, poisson), 0);
      EXPECT_LT(pressure<NeoHookeanLog>(s, std::fmax(poisson, 0)), 0);
      EXPECT_LT(pressure<NeoHookeanLogJ2>(s, poisson), 0);
    }
}

TEST(Stvk, SoftensBelowDocumentedSize) {
  const double s = 1 / std::sqrt(3.0), small = 1e-3;
  EXPECT_GT(pressure<Stvk>(s - small, 0.3), pressure<Stvk>(s, 0.3));
  EXPECT_GT(pressure<Stvk>(s + small, 0.3), pressure<Stvk>(s, 0.3));
}

}  // namespace
}  // namespace aspic
