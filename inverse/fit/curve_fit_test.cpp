#include "fit/curve_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"

namespace aspic {
namespace {

using testing::HasSubstr;

constexpr Deformation kTests[] = {Deformation::uniaxial, Deformation::equibiaxial, Deformation::planar,
                                  Deformation::simple_shear};

std::vector<TestCurve> made_curves(const std::string& material, const MaterialParameters& m, double noise,
                                   Volume volume) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<TestCurve> curves;
  for (const Deformation d : kTests) {
    TestCurve curve{.name = std::string(name(d)), .deformation = d, .stretch = {}, .stress = {}};
    for (int i = 0; i < 25; ++i) {
      const double l = d == Deformation::simple_shear ? 0.05 + 0.06 * i : 1.03 + 0.06 * i;
      const double P = homogeneous_state(material, m, d, l, volume).stress;
      curve.stretch.push_back(l);
      curve.stress.push_back(P * (1 + noise * normal(random)));
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

TEST(FitCurves, RecoverTheMaterialThatMadeThem) {
  struct Case {
    const char* material;
    std::vector<double> extra;
  };
  for (const Case& c : {Case{"neo_hookean_isochoric", {}}, Case{"mooney_rivlin", {0.2}}, Case{"fung", {0.4}}})
    for (const Volume volume : {Volume::incompressible, Volume::compressible}) {
      MaterialParameters m{lame_from_young_poisson(3e5, 0.45), {}};
      std::copy(c.extra.begin(), c.extra.end(), m.extra.begin());
      const auto curves = made_curves(c.material, m, 0, volume);
      const CurveFit fit = fit_curves(curves, {.material = c.material, .volume = volume, .poisson = 0.45});
      EXPECT_TRUE(fit.is_converged);
      EXPECT_NEAR(fit.fitted[0].value, 3e5, 0.3) << c.material;
      for (size_t k = 0; k < c.extra.size(); ++k) EXPECT_NEAR(fit.fitted[k + 1].value, c.extra[k], 1e-5) << c.material;
      EXPECT_LT(fit.relative, 1e-6);
    }
}

TEST(FitCurves, RecoverTheStressesOfASpline) {
  MaterialParameters m{{1e5, 1e6}, {0.15, 0.8, 0, 0.3, 0, 0.4, 0.2, 0, 0, 0, 0, 0.01}};
  const auto curves = made_curves("spline", m, 0, Volume::incompressible);
  const CurveFit fit = fit_curves(curves, {.material = "spline"});
  EXPECT_LT(fit.relative, 1e-5);
  EXPECT_NEAR(fit.fitted[0].value, 2 * 1.49 * 1e5, 0.05 * 2.98e5);
  for (const FittedParameter& f : fit.fitted) EXPECT_GE(f.value, 0) << f.name;
}

TEST(FitCurves, SigmaCoversTheTruth) {
  MaterialParameters m{{1e5, 1e6}, {0.2}};
  int covered = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    auto curves = made_curves("mooney_rivlin", m, 0, Volume::incompressible);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 2e3);
    for (TestCurve& curve : curves)
      for (double& s : curve.stress) s += noise(random);
    const CurveFit fit =
        fit_curves(curves, {.material = "mooney_rivlin", .weighting = Weighting::absolute, .starts = 1});
    covered += std::abs(fit.fitted[1].value - 0.2) < 2 * fit.fitted[1].sigma;
  }
  EXPECT_GE(covered, 88);  // 95 expected, deviation 2.2
  EXPECT_LE(covered, 100);
}

TEST(CurveMisfit, HasTheJacobianThatDifferencesShow) {
  MaterialParameters m{{1e5, 1e6}, {0.15, 0.8, 0, 0.3, 0, 0.4, 0.2}};
  for (const char* material : {"spline", "fung", "mooney_rivlin"})
    for (const Weighting weighting : {Weighting::absolute, Weighting::balanced, Weighting::relative}) {
      const auto curves = made_curves("spline", m, 0, Volume::incompressible);
      CurveMisfit misfit(curves, {.material = material, .volume = Volume::compressible, .weighting = weighting});
      std::vector<double> p = misfit.guess(3), r(misfit.residual_count()), above = r, below = r, dr = r;
      ASSERT_TRUE(misfit.evaluate(p, r));
      std::mt19937 random(1);
      std::uniform_real_distribution<double> unit(-1, 1);
      std::vector<double> dp(p.size()), w(r.size()), pbar(p.size());
      for (double& x : dp) x = unit(random);
      for (double& x : w) x = unit(random);
      misfit.multiply(dp, dr);
      misfit.multiply_transposed(w, pbar);
      double one = 0, other = 0;
      for (size_t i = 0; i < w.size(); ++i) one += w[i] * dr[i];
      for (size_t k = 0; k < dp.size(); ++k) other += pbar[k] * dp[k];
      EXPECT_NEAR(one, other, 1e-12 * std::abs(one) + 1e-12);
      const double h = 1e-6;
      std::vector<double> q = p;
      for (size_t k = 0; k < p.size(); ++k) q[k] = p[k] + h * dp[k];
      ASSERT_TRUE(misfit.evaluate(q, above));
      for (size_t k = 0; k < p.size(); ++k) q[k] = p[k] - h * dp[k];
      ASSERT_TRUE(misfit.evaluate(q, below));
      double largest = 0;
      for (const double x : dr) largest = std::fmax(largest, std::abs(x));
      for (size_t i = 0; i < dr.size(); ++i) EXPECT_NEAR((above[i] - below[i]) / (2 * h), dr[i], 1e-6 * largest);
    }
}

TEST(FitCurves, HoldWhatIsNotToBeFitted) {
  MaterialParameters m{{1e5, 1e6}, {0.2}};
  const auto curves = made_curves("mooney_rivlin", m, 0, Volume::incompressible);
  const CurveFit fit = fit_curves(curves, {.material = "mooney_rivlin", .held = {"share"}});
  EXPECT_TRUE(fit.fitted[1].is_held);
  EXPECT_EQ(fit.fitted[1].value, 0.5);
  EXPECT_GT(fit.relative, 0.01);
}

std::string refusal(std::vector<TestCurve> curves, const CurveFitOptions& options) {
  try {
    fit_curves(curves, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FitCurves, RefuseWhatMakesNoSense) {
  const TestCurve good{"pull", Deformation::uniaxial, {1.1, 1.2}, {1e4, 2e4}};
  EXPECT_EQ(refusal({good}, {}), "accepted");
  EXPECT_THAT(refusal({}, {}), HasSubstr("no curve"));
  EXPECT_THAT(refusal({good}, {.material = "funk"}), HasSubstr("'fung'"));
  EXPECT_THAT(refusal({good}, {.poisson = 0.5}), HasSubstr("0.49"));
  EXPECT_THAT(refusal({good}, {.material = "fung", .held = {"c"}}), HasSubstr("'c' is not a parameter"));
  EXPECT_THAT(refusal({{"pull", Deformation::uniaxial, {1.1, -1}, {1, 2}}}, {}), HasSubstr("point 2"));
  EXPECT_THAT(refusal({{"pull", Deformation::uniaxial, {1.1}, {NAN}}}, {}), HasSubstr("no finite stress"));
  EXPECT_THAT(refusal({{"pull", Deformation::uniaxial, {1.1, 1.2}, {-1, -2}}}, {}), HasSubstr("sign"));
  EXPECT_THAT(refusal({{"pull", Deformation::uniaxial, {1.1}, {0}}}, {}), HasSubstr("all stresses are 0"));
}

TEST(SceneLine, IsTheMaterialOfAScene) {
  const TestCurve curve{"pull", Deformation::uniaxial, {1.1, 1.2}, {3e4, 6e4}};
  const std::string line = scene_line(fit_curves({curve}, {.material = "mooney_rivlin", .held = {"share"}}));
  EXPECT_THAT(line, HasSubstr("material = { model = \"mooney_rivlin\", young = "));
  EXPECT_THAT(line, HasSubstr(", poisson = 0.49, share = 0.5 }"));
}

}  // namespace
}  // namespace aspic
