// Uniaxial stress with free lateral faces: small-strain moduli and reference values at large strain.
#include <gtest/gtest.h>

#include "material/states_test.h"

namespace aspic {
namespace {

struct Uniaxial {
  double lateral;  // stretch t of the lateral directions [1]
  double stress;   // nominal stress P_11 [Pa]
};

// Newton's method on P_22(diag(l, t, t)) = 0.
template <class M>
Uniaxial uniaxial(double l, double t, const typename M::template Params<double>& p) {
  for (int i = 0; i < 50; ++i) {
    const Mat9d H = M::hessian(diagonal(l, t, t), p);
    t -= M::pk1(diagonal(l, t, t), p)(1, 1) / (H(4, 4) + H(4, 8));
  }
  return {t, M::pk1(diagonal(l, t, t), p)(0, 0)};
}

TEST(Materials, ReproduceYoungModulusAndPoissonRatioAtSmallStrain) {
  for_each_material([]<class M>() {
    for (const double poisson : {-0.3, 0.0, 0.3, 0.45, 0.499}) {
      const double young = 3e5, strain = 1e-4;  // the error of the central difference is about strain^2
      const auto p = ordinary_params<M>(young, poisson);
      const Uniaxial pull = uniaxial<M>(1 + strain, 1, p), push = uniaxial<M>(1 - strain, 1, p);
      const double measured_young = (pull.stress - push.stress) / (2 * strain);
      const double measured_poisson = -(pull.lateral - push.lateral) / (2 * strain);
      const Lame lame = lame_from_young_poisson(young, poisson);
      const bool mu_only = std::is_same_v<M, Arap>;
      EXPECT_NEAR(measured_young, mu_only ? 2 * lame.mu : young, 1e-6 * young) << M::info().name << ' ' << poisson;
      EXPECT_NEAR(measured_poisson, mu_only ? 0 : poisson, 1e-6) << M::info().name << ' ' << poisson;
    }
  });
}

TEST(Materials, HaveTheHessianOfLinearElasticityAtRest) {
  for_each_material([]<class M>() {
    for (const double poisson : {-0.3, 0.0, 0.3, 0.45, 0.499}) {
      MaterialParameters m{lame_from_young_poisson(1, poisson), {}};
      if (std::is_same_v<M, Arap>) m.lame.lambda = 0;
      const Mat9d expected = Linear::hessian(identity3<double>(), Linear::params(m));
      if (!M::info().extra.empty()) m.extra[0] = M::info().extra[0].fallback;
      const Mat9d H = M::hessian(identity3<double>(), M::params(m));
      EXPECT_LE(largest_difference(H.a, expected.a), 1e-14 * largest(expected.a)) << M::info().name;
    }
  });
}

struct Reference {
  const char* material;
  double poisson, stretch;
  Uniaxial expected;
};

// E = 1. Computed independently of this code and printed to 8 decimals.
const Reference kReferences[] = {
    {"neo_hookean_log", 0.3, 0.5, {1.21076739, -0.93535206}},
    {"neo_hookean_log", 0.3, 1.5, {0.88017459, 0.37828018}},
    {"neo_hookean_log", 0.3, 2.0, {0.79807754, 0.64674466}},
    {"neo_hookean", 0.3, 0.5, {1.09544512, -0.73076923}},
    {"neo_hookean", 0.3, 1.5, {0.86922699, 0.38319088}},
    {"neo_hookean", 0.3, 2.0, {0.77459667, 0.65384615}},
    {"stable_neo_hookean", 0.3, 0.5, {1.09464699, -0.70585424}},
    {"stable_neo_hookean", 0.3, 1.5, {0.86708612, 0.40444552}},
    {"stable_neo_hookean", 0.3, 2.0, {0.77104534, 0.73211342}},
    {"corotated", 0.3, 0.5, {1.14713687, -0.64428635}},
    {"corotated", 0.3, 1.5, {0.86933210, 0.44286862}},
    {"corotated", 0.3, 2.0, {0.77317017, 0.83668387}},
    {"stvk", 0.3, 0.5, {1.10679718, -0.18750000}},
    {"stvk", 0.3, 1.5, {0.79056942, 0.93750000}},
    {"stvk", 0.3, 2.0, {0.31622777, 3.00000000}},
    {"neo_hookean", 0.45, 0.5, {1.34164079, -1.06896552}},
    {"neo_hookean", 0.45, 1.5, {0.82999331, 0.35887612}},
    {"neo_hookean", 0.45, 2.0, {0.72456884, 0.59913793}},
    {"stable_neo_hookean", 0.45, 0.5, {1.33193685, -1.10935098}},
    {"stable_neo_hookean", 0.45, 1.5, {0.82899404, 0.37542793}},
    {"stable_neo_hookean", 0.45, 2.0, {0.72288084, 0.66717118}},
};

TEST(Materials, MatchTheUniaxialReferenceTable) {
  const double half_a_digit = 0.51e-8;
  for (const Reference& row : kReferences) {
    with_material(row.material, [&]<class M>() {
      const auto p = ordinary_params<M>(1, row.poisson);
      const Uniaxial found = uniaxial<M>(row.stretch, std::pow(row.stretch, -row.poisson), p);
      EXPECT_NEAR(found.lateral, row.expected.lateral, half_a_digit) << row.material << ' ' << row.stretch;
      EXPECT_NEAR(found.stress, row.expected.stress, half_a_digit) << row.material << ' ' << row.stretch;
    });
  }
}

// Uniform scaling by s: the sign of dpsi/ds tells where a shrunk body goes.
template <class M>
double pressure(double s, double poisson) {
  return trace(M::pk1(diagonal(s, s, s), ordinary_params<M>(1, poisson)));
}

TEST(NeoHookean, CollapsesBelowTheDocumentedSize) {
  EXPECT_GT(pressure<NeoHookean>(0.290, 0.3), 0);
  EXPECT_LT(pressure<NeoHookean>(0.292, 0.3), 0);
  EXPECT_GT(pressure<NeoHookean>(0.0905, 0.45), 0);
  EXPECT_LT(pressure<NeoHookean>(0.0915, 0.45), 0);
}

TEST(OtherInvertibleMaterials, PushBackAtEverySize) {
  for (const double poisson : {-0.3, 0.0, 0.3, 0.45, 0.499})
    for (double s = 1e-6; s < 0.99; s = 1.1 * s + 1e-6) {
      EXPECT_LT(pressure<StableNeoHookean>(s, poisson), 0);
      EXPECT_LT(pressure<Corotated>(s, poisson), 0);
      EXPECT_LT(pressure<NeoHookeanLog>(s, std::fmax(poisson, 0)), 0);
      EXPECT_LT(pressure<NeoHookeanLogJ2>(s, poisson), 0);
    }
}

TEST(Stvk, SoftensBelowTheDocumentedSize) {
  const double s = 1 / std::sqrt(3.0), small = 1e-3;
  EXPECT_GT(pressure<Stvk>(s - small, 0.3), pressure<Stvk>(s, 0.3));
  EXPECT_GT(pressure<Stvk>(s + small, 0.3), pressure<Stvk>(s, 0.3));
}

}  // namespace
}  // namespace aspic
