#include "material/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "material/from_energy.h"
#include "material/list.h"
#include "material/states.h"

namespace aspic {
namespace {

TEST(Registry, ContainsEveryListedMaterial) {
  EXPECT_EQ(materials().size(), std::tuple_size_v<MaterialList>);
  std::set<std::string> names;
  for (const MaterialInfo& info : materials()) {
    names.insert(info.name);
    EXPECT_EQ(&material_info(info.name), &info);
    EXPECT_FALSE(info.formula.empty());
    EXPECT_FALSE(info.remarks.empty());
    EXPECT_LE(info.extra.size(), std::size_t{kMaxExtraParameters});
    for (const ExtraParameter& extra : info.extra) {
      EXPECT_LE(extra.min, extra.fallback);
      EXPECT_LE(extra.fallback, extra.max);
    }
  }
  EXPECT_EQ(names.size(), materials().size());
}

TEST(Registry, CallsNamedMaterialOnce) {
  for_each_material([]<class M>() {
    int calls = 0;
    with_material(M::info().name, [&]<class Found>() { calls += std::is_same_v<Found, M>; });
    EXPECT_EQ(calls, 1);
  });
}

TEST(Registry, RejectsUnknownNameWithSuggestion) {
  try {
    with_material("neohookean", []<class M>() { ADD_FAILURE(); });
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'neohookean'"));
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'neo_hookean'?"));
  }
}

// Minimal user-defined material: psi only.
struct NeoHookeanEnergy {
  template <class T>
  struct Params {
    T mu, lambda;
  };
  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const T dJ = determinant(F) - 1.0;
    return 0.5 * p.mu * (squared_norm(F) - 3.0) - p.mu * dJ + 0.5 * p.lambda * dJ * dJ;
  }
};
static_assert(Material<FromEnergy<NeoHookeanEnergy>>);

TEST(FromEnergy, DerivesStressAndHessianFromPsi) {
  using M = FromEnergy<NeoHookeanEnergy>;
  const NeoHookean::Params<double> p = ordinary_params<NeoHookean>();
  const M::Params<double> q{p.mu, p.lambda};
  for (const auto& [name, F] : smooth_states<NeoHookean>()) {
    SCOPED_TRACE(name);
    const Mat9d H = NeoHookean::hessian(F, p);
    const double scale = 1e-13 * largest(H.a);
    EXPECT_LE(largest_difference(M::pk1(F, q).a, NeoHookean::pk1(F, p).a), scale * (1 + std::sqrt(squared_norm(F))));
    EXPECT_LE(largest_difference(M::hessian(F, q).a, H.a), scale);

    Mat3<Pack> lanes;
    for (int i = 0; i < 9; ++i) lanes.a[i] = F.a[i];
    const Mat9<Pack> HP = M::hessian(lanes, broadcast_params<M, Pack>(q));
    for (int i = 0; i < 81; ++i) EXPECT_NEAR(HP.a[i][kPackWidth - 1], H.a[i], scale);
  }
}

}  // namespace
}  // namespace aspic
