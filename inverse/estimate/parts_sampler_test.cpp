// Sampling of parts from noisy readings of every tet, with known values, locations and intervals.
#include "estimate/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "mesh/generators.h"

namespace aspic {
namespace {

constexpr double kNoise = 0.4;  // of the reading of a single tet

struct Body {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {5, 5, 5});
  std::vector<double> truth, read;

  explicit Body(double jump, unsigned seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (const auto& [a, b, c, d] : mesh.tets) {
      const Vec3d x = 0.25 * (mesh.rest[a] + mesh.rest[b] + mesh.rest[c] + mesh.rest[d]) - Vec3d{{0.5, 0.5, 0.5}};
      truth.push_back(dot(x, x) < 0.09 ? jump : 0);
      read.push_back(truth.back() + kNoise * normal(random));
    }
  }
  int size() const { return mesh.tet_count(); }

  // Layers of 0, 1 and so on, below the given heights.
  void set_layers(const std::vector<double>& heights, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (int t = 0; t < size(); ++t) {
      const auto& [a, b, c, d] = mesh.tets[t];
      const double height = (mesh.rest[a][2] + mesh.rest[b][2] + mesh.rest[c][2] + mesh.rest[d][2]) / 4;
      truth[t] = static_cast<double>(std::upper_bound(heights.begin(), heights.end(), height) - heights.begin());
      read[t] = truth[t] + kNoise * normal(random);
    }
  }

  // r = (z - read) / noise, about z = 0, in the norm of the unit matrix.
  PartsEstimate estimate(std::vector<double> levels) const {
    Spectrum s{.W = Columns(size()), .dual = Columns(size()), .complete = true};
    std::vector<double> unit(size(), 0.0), gradient;
    for (int t = 0; t < size(); ++t) {
      unit[t] = 1;
      s.W.push_back(unit), s.dual.push_back(unit), s.d.push_back(1 / (kNoise * kNoise));
      unit[t] = 0;
      gradient.push_back(-read[t] / (kNoise * kNoise));
    }
    return sample_parts({mesh, s, gradient, 0, std::vector<double>(size(), 0.0), 1}, std::move(levels),
                        {.sweeps = 200});
  }
};

TEST(PartsSampler, FindsValuesAndLocationsOfTwoParts) {
  const Body body(1.2);
  const PartsEstimate e = body.estimate({0.2, 0.8});
  EXPECT_NEAR(e.levels[0], 0, 0.06);
  EXPECT_NEAR(e.levels[1], 1.2, 0.12);
  int wrong = 0;
  for (int t = 0; t < body.size(); ++t) wrong += (e.share[1][t] > 0.5) != (body.truth[t] > 0) ? 1 : 0;
  EXPECT_LT(wrong, 0.05 * body.size()) << "of single readings alone, 7 % would be on the wrong side";
}

TEST(PartsSampler, FindsThreeLayers) {
  Body body(0);
  body.set_layers({0.4, 0.6}, 1);
  const PartsEstimate e = body.estimate({0.2, 0.8, 1.7});
  int wrong = 0;
  for (int t = 0; t < body.size(); ++t) wrong += e.share[static_cast<size_t>(body.truth[t])][t] < 0.5 ? 1 : 0;
  EXPECT_LT(wrong, 0.05 * body.size());
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(e.levels[k], k, 0.08);
}

TEST(PartsSampler, ReportsItsSamplingError) {
  double squares = 0, expected = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Body body(1, seed);
    const PartsEstimate e = body.estimate({0, 1});
    for (int t = 0; t < body.size(); ++t) {
      squares += (e.mean[t] - body.truth[t]) * (e.mean[t] - body.truth[t]);
      expected += e.sigma[t] * e.sigma[t];
    }
  }
  EXPECT_LT(squares, 2 * expected);
  EXPECT_GT(squares, expected / 2);
}

// Means over neighborhoods of all vertices: like data of a surface, they hardly distinguish small stiff parts from
// large soft ones.
PartsEstimate estimate_of_means(const Body& body, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Spectrum s{.W = Columns(body.size()), .dual = Columns(body.size()), .complete = true};
  std::vector<double> gradient(body.size(), 0.0);
  for (int v = 0; v < body.mesh.vertex_count(); ++v) {
    std::vector<double> weight(body.size(), 0.0), unit(body.size(), 0.0);
    double sum = 0, mean = 0;
    for (int t = 0; t < body.size(); ++t) {
      const auto& [a, b, c, d] = body.mesh.tets[t];
      const Vec3d x = 0.25 * (body.mesh.rest[a] + body.mesh.rest[b] + body.mesh.rest[c] + body.mesh.rest[d]);
      sum += weight[t] = std::exp(-dot(x - body.mesh.rest[v], x - body.mesh.rest[v]) / 0.06);
    }
    for (int t = 0; t < body.size(); ++t) weight[t] /= sum, mean += weight[t] * body.truth[t];
    unit[v] = 1;
    s.W.push_back(unit), s.dual.push_back(weight), s.d.push_back(1 / (noise * noise));
    gradient[v] = -(mean + noise * normal(random)) / (noise * noise);
  }
  return sample_parts({body.mesh, s, gradient, 0, std::vector<double>(body.size(), 0.0), 1}, {0, 1}, {.sweeps = 300});
}

TEST(PartsSampler, FindsTheSizeOfABlurredInclusion) {
  const Body body(1.2);
  const auto tets_inside = static_cast<double>(std::count(body.truth.begin(), body.truth.end(), 1.2));
  double size = 0, level = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const PartsEstimate e = estimate_of_means(body, 0.03, seed);
    EXPECT_LT(std::abs(e.levels[1] - 1.2), 1.96 * e.level_sigma[1]) << "value " << e.levels[1];
    size += std::accumulate(e.share[1].begin(), e.share[1].end(), 0.0) / tets_inside / 4;
    level += e.levels[1] / 4;
  }
  EXPECT_NEAR(size, 1, 0.15);
  EXPECT_NEAR(level, 1.2, 0.2) << "a penalty of the surface alone finds 1.49";
}

TEST(PartsSampler, IntervalsOfValuesContainTheTruth) {
  constexpr int kRuns = 30;
  const double truths[] = {0, 1, 1};  // two values and their difference
  int inside[3] = {};
  double squares[3] = {};
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    Body body(0);
    body.set_layers({0.6}, seed);
    const PartsEstimate e = body.estimate({0, 1});
    const double found[] = {e.levels[0], e.levels[1], e.levels[1] - e.levels[0]};
    const double sigma[] = {e.level_sigma[0], e.level_sigma[1], e.contrast_sigma};
    for (int k = 0; k < 3; ++k) {
      const double error = (found[k] - truths[k]) / sigma[k];
      inside[k] += std::abs(error) < 1.96 ? 1 : 0;
      squares[k] += error * error / kRuns;
    }
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(inside[k], 26) << k << ": fewer than 26 of 30 have a probability of 2 % for 95 % intervals";
    EXPECT_GT(squares[k], 0.3) << k << ": the interval is too wide";
  }
}

TEST(PartsSampler, DrawsTheSameAgain) {
  const Body body(1);
  EXPECT_EQ(body.estimate({0, 1}).mean, body.estimate({0, 1}).mean);
}

TEST(GatheredLevels, AreTheMeansOfWhatIsNear) {
  const std::vector<double> z{0, 0.1, 1, 1.1}, volume{1, 1, 3, 1};
  const std::vector<double> levels = gathered_levels(z, volume, 2);
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_NEAR(levels[0], 0.05, 1e-12);
  EXPECT_NEAR(levels[1], 1.025, 1e-12);
  EXPECT_EQ(gathered_levels(std::vector<double>{1, 1}, std::vector<double>{1, 1}, 2).size(), 1u)
      << "one value gathers about one level";
}

}  // namespace
}  // namespace aspic
