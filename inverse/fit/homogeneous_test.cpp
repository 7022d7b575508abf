#include "fit/homogeneous.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "material/list.h"

namespace aspic {
namespace {

MaterialParameters parameters_of(const MaterialInfo& info, double poisson) {
  MaterialParameters m{lame_from_young_poisson(3e5, poisson), {}};
  for (size_t k = 0; k < info.extra.size(); ++k)
    m.extra[k] = info.extra[k].fallback == 0 ? 0.05 * static_cast<double>(k + 1) : info.extra[k].fallback;
  return m;
}

constexpr Deformation kAll[] = {Deformation::uniaxial, Deformation::equibiaxial, Deformation::planar,
                                Deformation::simple_shear};

// [Treloar 1944]: with mu the stresses of the incompressible neo-Hookean solid.
TEST(HomogeneousState, OfIncompressibleNeoHookeanMatchesTextbook) {
  const MaterialParameters m{{2, 1}, {}};
  for (const double l : {0.5, 0.9, 1.3, 4.0}) {
    const auto stress = [&](Deformation d) {
      return homogeneous_state("neo_hookean_isochoric", m, d, l, Volume::incompressible).stress;
    };
    EXPECT_NEAR(stress(Deformation::uniaxial), 2 * (l - 1 / (l * l)), 1e-13 * l);
    EXPECT_NEAR(stress(Deformation::equibiaxial), 2 * (l - std::pow(l, -5)), 1e-12);
    EXPECT_NEAR(stress(Deformation::planar), 2 * (l - std::pow(l, -3)), 1e-13 * l);
    EXPECT_NEAR(stress(Deformation::simple_shear), 2 * l, 1e-13 * l);
  }
}

// Mooney-Rivlin: 2 (c10 + c01 / l) (l - 1 / l^2), 2 (c10 + c01 l^2) (l - 1 / l^5), 2 (c10 + c01) (l - 1 / l^3).
TEST(HomogeneousState, OfIncompressibleMooneyRivlinMatchesTextbook) {
  const double c10 = 0.7, c01 = 0.3;
  const MaterialParameters m{{2 * (c10 + c01), 1}, {c01 / (c10 + c01)}};
  for (const double l : {0.6, 1.5, 3.0}) {
    const auto stress = [&](Deformation d) {
      return homogeneous_state("mooney_rivlin", m, d, l, Volume::incompressible).stress;
    };
    EXPECT_NEAR(stress(Deformation::uniaxial), 2 * (c10 + c01 / l) * (l - 1 / (l * l)), 1e-12);
    EXPECT_NEAR(stress(Deformation::equibiaxial), 2 * (c10 + c01 * l * l) * (l - std::pow(l, -5)), 1e-11);
    EXPECT_NEAR(stress(Deformation::planar), 2 * (c10 + c01) * (l - std::pow(l, -3)), 1e-12);
  }
}

TEST(HomogeneousState, LeavesTheFreeFacesWithoutTraction) {
  for_each_material([]<class M>() {
    if constexpr (std::is_same_v<M, NeoHookeanFibres>) return;  // its lateral stretches differ
    const MaterialParameters m = parameters_of(M::info(), 0.3);
    for (const Deformation d : kAll)
      for (const double l : {0.9, 1.15, 1.3}) {
        SCOPED_TRACE(M::info().name + " " + std::string(name(d)));
        const HomogeneousState s = homogeneous_state(M::info().name, m, d, l, Volume::compressible);
        ASSERT_TRUE(s.is_found);
        const Mat3d P = M::pk1(s.F, M::params(m));
        if (d == Deformation::uniaxial) {
          EXPECT_NEAR(P(1, 1), 0, 1e-7);
        }
        if (d == Deformation::uniaxial || d == Deformation::equibiaxial || d == Deformation::planar) {
          EXPECT_NEAR(P(2, 2), 0, 1e-7);
        }
        EXPECT_NEAR(s.stress, d == Deformation::simple_shear ? P(0, 1) : P(0, 0), 1e-12 * std::abs(s.stress));
      }
  });
}

TEST(HomogeneousState, BecomesIncompressibleAsPoissonApproachesOneHalf) {
  for (const char* material : {"neo_hookean_isochoric", "mooney_rivlin", "fung", "spline"}) {
    const MaterialInfo& info = material_info(material);
    for (const Deformation d : kAll) {
      const auto stress = [&](double poisson, Volume volume) {
        MaterialParameters m = parameters_of(info, poisson);
        m.lame.mu = 1e5;
        m.lame.lambda = 2e5 * poisson / (1 - 2 * poisson);
        return homogeneous_state(material, m, d, 1.6, volume).stress;
      };
      const double limit = stress(0.49, Volume::incompressible);
      EXPECT_NEAR(stress(0.4999999, Volume::compressible), limit, 1e-4 * limit) << material << ' ' << name(d);
    }
  }
}

TEST(HomogeneousState, HasTheSlopesThatDifferencesShow) {
  for_each_material([]<class M>() {
    const MaterialInfo info = M::info();
    const MaterialParameters m = parameters_of(info, 0.35);
    for (const Volume volume : {Volume::compressible, Volume::incompressible})
      for (const Deformation d : kAll) {
        const HomogeneousState s = homogeneous_state(info.name, m, d, 1.2, volume);
        ASSERT_EQ(s.slopes.size(), 2 + info.extra.size());
        for (size_t k = 0; k < s.slopes.size(); ++k) {
          const auto moved = [&](double h) {
            MaterialParameters n = m;
            double& value = k == 0 ? n.lame.mu : k == 1 ? n.lame.lambda : n.extra[k - 2];
            const double size = k < 2 ? m.lame.mu : 1;
            value += h * size;
            return homogeneous_state(info.name, n, d, 1.2, volume).stress / size;
          };
          const double difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
          const double size = k < 2 ? 1 : m.lame.mu;
          EXPECT_NEAR(s.slopes[k], difference, 1e-7 * size) << info.name << ' ' << name(d) << ' ' << k;
        }
      }
  });
}

TEST(HomogeneousState, IsNotFoundWhereTheMaterialHasNone) {
  // St. Venant-Kirchhoff with free sides: for l^2 > 1 + 1/nu no lateral stretch is traction-free.
  const MaterialParameters m{lame_from_young_poisson(1, 0.4), {}};
  EXPECT_TRUE(homogeneous_state("stvk", m, Deformation::uniaxial, 1.8, Volume::compressible).is_found);
  EXPECT_FALSE(homogeneous_state("stvk", m, Deformation::uniaxial, 2.0, Volume::compressible).is_found);
}

TEST(DeformationNamed, SuggestsTheNearestName) {
  EXPECT_EQ(deformation_named("planar"), Deformation::planar);
  try {
    deformation_named("uniaxal");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("uniaxial"));
  }
}

}  // namespace
}  // namespace aspic
