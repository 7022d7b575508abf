#include "model/condensed_readings.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "base/parallel.h"
#include "estimate/fit.h"
#include "math/vectors.h"
#include "model/common_errors.h"
#include "model/indented_block_test.h"
#include "model/regularizer.h"

namespace aspic {
static_assert(!std::is_convertible_v<Condensed, Corrected> && !std::is_convertible_v<Measured, Corrected>);

namespace {

using test::IndentedBlock;

// Thousands of readings of a poked block, with equal standard deviations in one case and other ones per axis in the
// next.
IndentedBlock dense_block(int per_triangle) {
  IndentedBlock block;
  const std::vector<SurfacePoint> centers = block.experiment.markers;
  block.experiment.markers.clear();
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.05, 1);
  for (const SurfacePoint& center : centers)
    for (int k = 0; k < per_triangle; ++k) {
      const double a = uniform(random), b = uniform(random), c = uniform(random), sum = a + b + c;
      block.experiment.markers.push_back({center.vertices, {a / sum, b / sum, c / sum}});
    }
  const std::vector<IndentedBlock::Site> sites = IndentedBlock::sites();
  block.add_indentation(sites[0], 0.004, 0.02);
  block.add_indentation(sites[2], 0.003, 0.02);
  for (MarkerReading& reading : block.experiment.cases[1].positions)
    for (int i = 0; i < 3; ++i) reading.sigma[i] *= uniform(random);
  block.measure(block.map(), block.map().guess(), random);
  // A common error that is no motion of the corners, and a small one of the force.
  for (LoadCase& load : block.experiment.cases) {
    CommonError& error = load.common_errors.emplace_back();
    for (size_t k = 0; k < load.positions.size(); ++k)
      error.markers.push_back({{1e-4 * uniform(random), 1e-4, -2e-4 * uniform(random)}});
    error.wrench.force = 0.3 * load.force_sigma;
  }
  return block;
}

struct Products {
  double squares = 0;
  std::vector<double> gradient, curvature;
  int residuals = 0, readings = 0;
};

Products products_of(const Experiment& experiment, const ParameterMap& map, std::span<const double> p) {
  Misfit misfit(experiment, map, {.tolerance = 1e-13, .adjoint_tolerance = 1e-12});
  WithUncertainLayers data(misfit);
  Products result{.residuals = data.residual_count(), .readings = data.reading_count()};
  std::vector<double> r(static_cast<size_t>(result.residuals)), v(p.size());
  EXPECT_TRUE(data.evaluate(p, r) && data.linearize()) << misfit.failure();
  result.squares = dot(r, r);
  result.gradient.resize(p.size());
  data.multiply_transposed(r, result.gradient);
  for (size_t i = 0; i < v.size(); ++i) v[i] = std::sin(1 + static_cast<double>(i));
  data.multiply(v, r);
  result.curvature.resize(p.size());
  data.multiply_transposed(r, result.curvature);
  return result;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double relative) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], relative * max_abs(a)) << i;
}

TEST(CondensedReadings, HaveEqualValuesAndProducts) {
  const IndentedBlock block = dense_block(60);
  const ParameterMap map = block.map({{.parameterization = Parameterization::tets, .guess = IndentedBlock::kYoung}});
  const std::span<const double> guess = map.guess();
  std::vector<double> p(guess.begin(), guess.end());
  for (size_t i = 0; i < p.size(); ++i) p[i] += 0.2 * std::cos(static_cast<double>(i));
  ASSERT_TRUE(has_dense_readings({block.experiment}));
  const Experiment fewer = condensed({block.experiment});
  const Products all = products_of(block.experiment, map, p), few = products_of(fewer, map, p);
  EXPECT_EQ(few.readings, all.residuals) << "the expectation of |r|^2 remains";
  EXPECT_LT(2 * few.residuals, all.residuals);
  EXPECT_GT(all.squares, 1.1 * all.residuals) << "p is far from the truth";
  EXPECT_NEAR(few.squares, all.squares, 1e-9 * all.squares);
  expect_near(all.gradient, few.gradient, 1e-8);
  expect_near(all.curvature, few.curvature, 1e-8);
}

TEST(CondensedReadings, GiveTheSameFit) {
  const IndentedBlock block = dense_block(40);
  const ParameterMap map = block.map({{.guess = 0.7 * IndentedBlock::kYoung}});
  const auto prior = make_regularizer(block.experiment.mesh, map, {});
  const Experiment fewer = condensed({block.experiment});
  const auto fitted = [&](const Experiment& experiment) {
    Misfit misfit(experiment, map);
    WithUncertainLayers data(misfit);
    return fit(data, *prior, map.guess(), {});
  };
  const FitReport all = fitted(block.experiment), few = fitted(fewer);
  ASSERT_TRUE(is_success(all.status) && is_success(few.status)) << all.message << "; " << few.message;
  EXPECT_NEAR(all.p[0], few.p[0], 1e-7);
  EXPECT_NEAR(all.misfit, few.misfit, 1e-7 * all.misfit);
}

TEST(CondensedReadings, AreBoundedByTheSurface) {
  const IndentedBlock some = dense_block(40), more = dense_block(400);
  const Experiment few = condensed({some.experiment}), many = condensed({more.experiment});
  for (size_t c = 0; c < 2; ++c) {
    EXPECT_EQ(many.cases[c].positions.size(), few.cases[c].positions.size());
    EXPECT_LT(40 * few.cases[c].positions.size(), more.experiment.cases[c].positions.size());
  }
}

TEST(CondensedReadings, LeaveSparseReadingsUnchanged) {
  const IndentedBlock block = dense_block(9);
  EXPECT_FALSE(has_dense_readings({block.experiment}));
  const Experiment same = condensed({block.experiment});
  EXPECT_EQ(same.markers.size(), block.experiment.markers.size());
  EXPECT_EQ(same.cases[0].merged, 0);
}

TEST(CondensedReadings, AreIndependentOfThreads) {
  const IndentedBlock block = dense_block(40);
  const int before = thread_count();
  std::vector<Experiment> results;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    results.push_back(condensed({block.experiment}));
  }
  set_thread_count(before);
  for (size_t c = 0; c < 2; ++c) {
    const auto &a = results[0].cases[c].positions, &b = results[1].cases[c].positions;
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(a[i].position[k], b[i].position[k]);
        EXPECT_EQ(results[0].markers[a[i].marker].weights[k], results[1].markers[b[i].marker].weights[k]);
      }
  }
}

TEST(CondensedReadings, KeepTheConstantOfNoise) {
  IndentedBlock block = dense_block(60);
  Experiment exact = block.experiment;
  block.experiment.cases[0].positions[100].position[1] += 0.01;
  const ParameterMap map = block.map();
  const Products with = products_of(condensed({block.experiment}), map, map.guess());
  const Products all = products_of(block.experiment, map, map.guess()), without = products_of(exact, map, map.guess());
  EXPECT_GT(all.squares, 1.5 * without.squares);
  EXPECT_NEAR(with.squares, all.squares, 1e-9 * all.squares);
}

}  // namespace
}  // namespace aspic
