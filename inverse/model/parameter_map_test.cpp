#include "model/parameter_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "base/error.h"
#include "mesh/generators.h"
#include "model/quantity_scale.h"

namespace aspic {
namespace {

using testing::Each;
using testing::HasSubstr;

TetMesh two_layers() {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {3, 3, 3});
  for (const Tet& tet : mesh.tets) {
    double z = 0;
    for (int v : tet) z += mesh.rest[v][2] / 4;
    mesh.region.push_back(z < 0.5 ? 7 : 3);
  }
  return mesh;
}

std::vector<MaterialParameters> known(const TetMesh& mesh, double extra = 0.25) {
  return std::vector<MaterialParameters>(mesh.tets.size(),
                                         {lame_from_young_poisson(2e5, 0.3), {extra, 1, 0.2, -0.5, 0.8}});
}

std::vector<double> numbers(size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> v(n);
  for (double& x : v) x = uniform(random);
  return v;
}

double inner(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::string refusal(const TetMesh& mesh, const std::string& material, std::vector<FitParameter> parameters) {
  try {
    ParameterMap map(mesh, material, known(mesh), std::move(parameters));
    return "accepted";
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

TEST(QuantityScale, InvertsAndHasItsSlope) {
  const struct {
    QuantityScale scale;
    double q;
  } cases[] = {{QuantityScale::positive(), 3e5},
               {QuantityScale::bounded(-1, 0.5), 0.49},
               {QuantityScale::bounded(0, 1), 0.2},
               {QuantityScale::bounded_powers(1e-3, 1e3), 40},
               {QuantityScale::powers_from_zero(1000), 0.02},
               {QuantityScale::powers_from_zero(1000), 300}};
  for (const auto& [scale, q] : cases) {
    const double z = scale.fitted(q), h = 1e-5;
    EXPECT_NEAR(scale.value(z), q, 1e-12 * q);
    EXPECT_NEAR((scale.value(z + h) - scale.value(z - h)) / (2 * h), scale.slope(z), 1e-8 * scale.slope(z));
  }
}

TEST(QuantityScale, StaysInsideItsRange) {
  const QuantityScale nu = QuantityScale::bounded(-1, 0.5), b = QuantityScale::bounded_powers(1e-3, 1e3);
  for (double z : {-1e3, -30.0, -1.0, 0.0, 1.0, 30.0, 1e3}) {
    EXPECT_GE(nu.value(z), -1);
    EXPECT_LE(nu.value(z), 0.5);
    EXPECT_GE(b.value(z), 1e-3 * (1 - 1e-14));
    EXPECT_LE(b.value(z), 1e3 * (1 + 1e-14));
  }
  EXPECT_NEAR(b.slope(0) / b.value(0), 1, 1e-14) << "in the middle of its range it is a logarithm";
}

TEST(QuantityScale, OfPowersResolvesSmallAndLargeValues) {
  const QuantityScale growth = QuantityScale::powers_from_zero(1000);
  double last = growth.fitted(0.5);
  for (const double q : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0}) {  // linearly, 0.5 to 1 would be 1/400 of 100 to 300
    const double z = growth.fitted(q);
    EXPECT_GT(z - last, 0.5) << q;
    EXPECT_LT(z - last, 3) << q;
    last = z;
  }
  for (double z : {-1e3, -30.0, 0.0, 30.0, 1e3}) {
    EXPECT_GE(growth.value(z), 0);
    EXPECT_LE(growth.value(z), 1000 * (1 + 1e-13));
  }
}

TEST(ParameterMap, FitsGrowthsOnThatScale) {
  const TetMesh mesh = two_layers();
  const ParameterMap map(
      mesh, "spline", std::vector<MaterialParameters>(mesh.tet_count()),
      {{"growth_2", Parameterization::uniform, 0, 0.5}, {"share", Parameterization::uniform, 0, 0.5}});
  EXPECT_DOUBLE_EQ(map.guess()[0], QuantityScale::powers_from_zero(1000).fitted(0.5));
  EXPECT_DOUBLE_EQ(map.guess()[1], QuantityScale::bounded(0, 1).fitted(0.5));
}

TEST(FieldBasis, IsAPartitionOfUnity) {
  const TetMesh mesh = two_layers();
  const int tets = mesh.tet_count();
  for (const FieldBasis& basis :
       {FieldBasis::uniform(tets), FieldBasis::tets(tets), FieldBasis::regions(mesh.region),
        FieldBasis::radial(mesh, 1), FieldBasis::radial(mesh, 9), FieldBasis::radial(mesh, tets)}) {
    std::vector<double> z(tets);
    basis.multiply(std::vector<double>(basis.size(), 1.0), z);
    EXPECT_THAT(z, Each(testing::DoubleNear(1, 1e-14)));
    basis.for_each_weight([](int, int, double w) { EXPECT_GT(w, 0); });
  }
}

TEST(FieldBasis, GivesEveryHandleItsTets) {
  const TetMesh mesh = two_layers();
  const FieldBasis basis = FieldBasis::radial(mesh, 20);
  std::vector<double> share(20, 0.0);
  basis.add_transposed(std::vector<double>(mesh.tets.size(), 1.0), share);
  EXPECT_THAT(share, Each(testing::Gt(0.5)));
}

TEST(ParameterMap, StartsAtGuessAndKeepsKnownValues) {
  const TetMesh mesh = two_layers();
  const ParameterMap map(mesh, "mooney_rivlin", known(mesh, 0.75), {{"young", Parameterization::handles, 5, 4e4}});
  for (const MaterialParameters& m : map.parameters(map.guess())) {
    EXPECT_NEAR(young_modulus(m.lame), 4e4, 1e-9 * 4e4);
    EXPECT_NEAR(poisson_ratio(m.lame), 0.3, 1e-12);
    EXPECT_EQ(m.extra[0], 0.75);
  }
  EXPECT_THAT(map.values(0, map.guess()), Each(testing::DoubleNear(4e4, 1e-9 * 4e4)));
}

TEST(ParameterMap, GivesEachRegionItsOwnValue) {
  const TetMesh mesh = two_layers();
  const ParameterMap map(mesh, "neo_hookean", known(mesh), {{"young", Parameterization::regions, 0, 1e5}});
  ASSERT_EQ(map.size(), 2);
  const std::vector<double> E = map.values(0, std::vector{std::log(1e4), std::log(5e4)});
  for (size_t t = 0; t < E.size(); ++t) EXPECT_NEAR(E[t], mesh.region[t] == 3 ? 1e4 : 5e4, 1e-7);
}

struct MapCase {
  std::string name, material;
  std::vector<FitParameter> parameters;
};

class ParameterMapDerivatives : public testing::TestWithParam<MapCase> {};

// theta(p + h dp) - theta(p) - h dtheta falls with h^2.
TEST_P(ParameterMapDerivatives, AgreeWithDifferencesToSecondOrder) {
  const TetMesh mesh = two_layers();
  const ParameterMap map(mesh, GetParam().material, known(mesh), GetParam().parameters);
  const int n = map.parameters_per_tet();
  std::vector<double> p(map.guess().begin(), map.guess().end());
  const std::vector<double> shift = numbers(p.size(), 1), dp = numbers(p.size(), 2);
  for (size_t i = 0; i < p.size(); ++i) p[i] += 0.3 * shift[i];
  const auto theta = [&](double h) {
    std::vector<double> q = p, flat;
    for (size_t i = 0; i < q.size(); ++i) q[i] += h * dp[i];
    for (const MaterialParameters& m : map.parameters(q)) {
      flat.insert(flat.end(), {m.lame.mu, m.lame.lambda});
      flat.insert(flat.end(), m.extra.begin(), m.extra.begin() + n - 2);
    }
    return flat;
  };
  std::vector<double> dtheta(mesh.tets.size() * n);
  map.multiply(p, dp, dtheta);
  const std::vector<double> at = theta(0);
  const auto error = [&](double h) {
    const std::vector<double> moved = theta(h);
    double sum = 0;
    for (size_t i = 0; i < at.size(); ++i) {
      const double e = (moved[i] - at[i] - h * dtheta[i]) / std::max(std::abs(at[i]), 1e-3);
      sum += e * e;
    }
    return std::sqrt(sum);
  };
  double before = error(1e-1);
  for (double h : {1e-2, 1e-3, 1e-4}) {
    const double now = error(h);
    EXPECT_NEAR(std::log10(before / now), 2, 0.1) << "h = " << h;
    before = now;
  }
}

TEST_P(ParameterMapDerivatives, TransposeIsTheTranspose) {
  const TetMesh mesh = two_layers();
  const ParameterMap map(mesh, GetParam().material, known(mesh), GetParam().parameters);
  std::vector<double> p(map.guess().begin(), map.guess().end());
  const std::vector<double> shift = numbers(p.size(), 1), dp = numbers(p.size(), 2);
  for (size_t i = 0; i < p.size(); ++i) p[i] += 0.3 * shift[i];
  const size_t count = mesh.tets.size() * map.parameters_per_tet();
  const std::vector<double> w = numbers(count, 3);
  std::vector<double> dtheta(count), pbar(p.size(), 0.0);
  map.multiply(p, dp, dtheta);
  map.add_transposed(p, w, pbar);
  EXPECT_NEAR(inner(w, dtheta), inner(pbar, dp), 1e-12 * std::sqrt(inner(w, w) * inner(dtheta, dtheta)));
}

INSTANTIATE_TEST_SUITE_P(
    Of, ParameterMapDerivatives,
    testing::Values(MapCase{"Uniform", "neo_hookean", {{"young", Parameterization::uniform, 0, 3e4}}},
                    MapCase{
                        "Both",
                        "neo_hookean",
                        {{"young", Parameterization::tets, 0, 3e4}, {"poisson", Parameterization::regions, 0, 0.4}}},
                    MapCase{"PoissonAlone", "stvk", {{"poisson", Parameterization::handles, 6, 0.45}}},
                    MapCase{"Share",
                            "mooney_rivlin",
                            {{"share", Parameterization::tets, 0, 0.4}, {"young", Parameterization::handles, 4, 1e5}}},
                    MapCase{"Fung",
                            "fung",
                            {{"young", Parameterization::tets, 0, 1e5},
                             {"poisson", Parameterization::uniform, 0, 0.3},
                             {"b", Parameterization::handles, 7, 12}}},
                    MapCase{"Fibres",
                            "neo_hookean_fibres",
                            {{"fibre_tilt_2", Parameterization::regions, 0, 0},
                             {"fibre_ratio", Parameterization::uniform, 0, 2},
                             {"fibre_tilt_1", Parameterization::regions, 0, 0.5},
                             {"young", Parameterization::tets, 0, 1e5}}}),
    [](const auto& each) { return each.param.name; });

TEST(ParameterMap, RefusesWhatCannotBeFitted) {
  TetMesh mesh = two_layers();
  EXPECT_THAT(refusal(mesh, "fung", {}), HasSubstr("there is no parameter to fit"));
  EXPECT_THAT(refusal(mesh, "fung", {{.quantity = "yuong"}}), HasSubstr("did you mean 'young'?"));
  EXPECT_THAT(refusal(mesh, "neo_hookean", {{"b", Parameterization::uniform, 0, 1}}),
              HasSubstr("not a quantity of the model neo_hookean"));
  EXPECT_THAT(refusal(mesh, "fung", {{"young", Parameterization::uniform, 0, -2}}), HasSubstr("must be positive"));
  EXPECT_THAT(refusal(mesh, "fung", {{"young", Parameterization::uniform, 0, NAN}}), HasSubstr("must be positive"));
  EXPECT_THAT(refusal(mesh, "fung", {{"poisson", Parameterization::uniform, 0, 0.5}}), HasSubstr("between -1 and 0.5"));
  EXPECT_THAT(refusal(mesh, "mooney_rivlin", {{"share", Parameterization::uniform, 0, 0}}),
              HasSubstr("between 0 and 1"));
  EXPECT_THAT(refusal(mesh, "fung", {{}, {}}), HasSubstr("twice"));
  EXPECT_THAT(refusal(mesh, "fung", {{"young", Parameterization::handles, 0, 1e5}}), HasSubstr("at 0 handles"));
  EXPECT_THAT(refusal(mesh, "fung", {{"young", Parameterization::handles, 1000, 1e5}}), HasSubstr("1 to 162"));
  mesh.region.clear();
  EXPECT_THAT(refusal(mesh, "fung", {{"young", Parameterization::regions, 0, 1e5}}), HasSubstr("has none"));
}

}  // namespace
}  // namespace aspic
