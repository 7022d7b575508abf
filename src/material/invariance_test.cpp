// Properties of all materials: rest state, rotation invariance, barriers, independence of lanes.
#include <gtest/gtest.h>

#include <limits>

#include "material/states.h"

namespace aspic {
namespace {

TEST(Materials, HaveNoEnergyAndNoStressAtRest) {
  for_each_material([]<class M>() {
    for (const double poisson : {-0.2, 0.0, 0.3, 0.45, 0.499}) {
      const auto p = ordinary_params<M>(1, poisson);
      const Mat3d I = identity3<double>();
      const double stiffness = largest(M::hessian(I, p).a);
      EXPECT_NEAR(M::psi(I, p), 0, 1e-15 * stiffness) << M::info().name;
      EXPECT_LE(largest(M::pk1(I, p).a), 1e-15 * stiffness) << M::info().name;
    }
  });
}

TEST(Materials, AreInvariantUnderRotation) {
  for_each_material([]<class M>() {
    if constexpr (std::is_same_v<M, Linear>) return;
    const auto p = ordinary_params<M>();
    std::mt19937 random(3);
    for (int i = 0; i < 50; ++i) {
      const Mat3d F = random_deformation(random), R = random_rotation(random);
      const double stiffness = largest(M::hessian(F, p).a);
      EXPECT_NEAR(M::psi(R * F, p), M::psi(F, p), 1e-13 * stiffness) << M::info().name;
      if constexpr (!std::is_same_v<M, NeoHookeanFibres>) {
        EXPECT_NEAR(M::psi(F * R, p), M::psi(F, p), 1e-13 * stiffness) << M::info().name << " is not isotropic";
      }
      EXPECT_LE(largest_difference(M::pk1(R * F, p).a, (R * M::pk1(F, p)).a), 1e-13 * stiffness) << M::info().name;
    }
  });
}

TEST(LinearMaterial, IsNotInvariantUnderRotation) {
  std::mt19937 random(3);
  EXPECT_GT(Linear::psi(random_rotation(random), ordinary_params<Linear>()), 0.1);
}

TEST(BarrierMaterials, AreInfiniteUnlessVolumeIsPositive) {
  for_each_material([]<class M>() {
    const auto p = ordinary_params<M>();
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const Mat3d& F :
         {diagonal(0, 0, 0), diagonal(1, 1, 0), diagonal(1, 1, -1), diagonal(-2, -1, -1e-9), diagonal(nan, 1, 1)}) {
      if (M::info().barrier) {
        EXPECT_EQ(M::psi(F, p), inf) << M::info().name;
      } else if (!std::isnan(F.a[0])) {
        EXPECT_TRUE(std::isfinite(M::psi(F, p))) << M::info().name;
      }
    }
  });
}

TEST(Fung, OverflowsToInfinityAndNeverToNan) {
  const auto p = ordinary_params<Fung>();
  EXPECT_TRUE(std::isinf(Fung::psi(diagonal(1, 1, 1e-8), p)));
  EXPECT_TRUE(std::isinf(Fung::psi(diagonal(1e6, 1e-2, 1e-2), p)));
  for (const double size : {1e-150, 1e-100, 1e-10, 1e10, 1e100})
    EXPECT_FALSE(std::isnan(Fung::psi(diagonal(size, 2 * size, 3 * size), p))) << size;
}

TEST(BarrierMaterials, DoNotAffectOtherLanes) {
  for_each_material([]<class M>() {
    if (!M::info().barrier) return;
    const auto p = ordinary_params<M>();
    std::mt19937 random(9);
    for (int bad = 0; bad < kPackWidth; ++bad) {
      Mat3d lanes[kPackWidth];
      Mat3<Pack> F;
      for (int lane = 0; lane < kPackWidth; ++lane) {
        lanes[lane] = lane == bad ? diagonal(-1, 1, 1) : random_deformation(random);
        for (int i = 0; i < 9; ++i) F.a[i].set(lane, lanes[lane].a[i]);
      }
      const Pack psi = M::psi(F, broadcast_params<M, Pack>(p));
      const Mat9<Pack> H = M::hessian(F, broadcast_params<M, Pack>(p));
      for (int lane = 0; lane < kPackWidth; ++lane) {
        EXPECT_EQ(std::isinf(psi[lane]), lane == bad) << M::info().name;
        if (lane == bad) continue;
        EXPECT_NEAR(psi[lane], M::psi(lanes[lane], p), 1e-13 * H(0, 0)[lane]);
      }
    }
  });
}

TEST(Materials, LanesMatchScalars) {
  for_each_material([]<class M>() {
    using Params = typename M::template Params<double>;
    const auto states = smooth_states<M>();
    for (std::size_t first = 0; first < states.size(); ++first) {
      std::vector<Params> params;
      Mat3<Pack> F;
      for (int lane = 0; lane < kPackWidth; ++lane) {
        params.push_back(ordinary_params<M>(1 + lane, 0.05 * lane));
        for (int i = 0; i < 9; ++i) F.a[i].set(lane, states[(first + lane) % states.size()].F.a[i]);
      }
      const auto p = pack_params<M>(params);
      const Pack psi = M::psi(F, p);
      const Mat3<Pack> P = M::pk1(F, p);
      const Mat9<Pack> H = M::hessian(F, p);
      for (int lane = 0; lane < kPackWidth; ++lane) {
        const auto& [name, Fl] = states[(first + lane) % states.size()];
        SCOPED_TRACE(M::info().name + " at " + name);
        const Mat9d Hl = M::hessian(Fl, params[lane]);
        const Mat3d Pl = M::pk1(Fl, params[lane]);
        // The compiler may fuse multiply-adds differently; J loses digits by cancellation in the determinant.
        const double scale = 1e-13 * largest(Hl.a), size = 1 + std::sqrt(squared_norm(Fl));
        EXPECT_NEAR(psi[lane], M::psi(Fl, params[lane]), scale * size * size + 1e-14);
        for (int i = 0; i < 9; ++i) EXPECT_NEAR(P.a[i][lane], Pl.a[i], scale * size);
        for (int i = 0; i < 81; ++i) EXPECT_NEAR(H.a[i][lane], Hl.a[i], scale);
      }
    }
  });
}

TEST(PackParams, RepeatsLastForMissingLanes) {
  const std::vector<NeoHookean::Params<double>> params = {{1, 2}, {3, 4}};
  const auto p = pack_params<NeoHookean>(params);
  EXPECT_EQ(p.mu[0], 1);
  EXPECT_EQ(p.lambda[0], 2);
  for (int lane = 1; lane < kPackWidth; ++lane) {
    EXPECT_EQ(p.mu[lane], 3);
    EXPECT_EQ(p.lambda[lane], 4);
  }
}

}  // namespace
}  // namespace aspic
