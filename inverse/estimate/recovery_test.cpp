// Fits of bodies to their own predictions: exact data recover the material.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "estimate/fit.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "model/misfit.h"

namespace aspic {
namespace {

constexpr double kCubeSide = 0.1, kCubeYoung = 2e4;  // [m], [Pa]

// Cube on the ground, pushed down by an indenter at two places to two depths each.
Experiment indented_cube() {
  Experiment e;
  TetMesh& mesh = e.mesh = make_box({{0, 0, 0}}, {{kCubeSide, kCubeSide, kCubeSide}}, {3, 3, 4});
  e.density.assign(mesh.tets.size(), 1000);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][2] == 0) e.fixed.push_back(v);
  for (const auto& [a, b, c, d] : mesh.tets)
    mesh.region.push_back(mesh.rest[a][2] + mesh.rest[b][2] + mesh.rest[c][2] + mesh.rest[d][2] < 2 * kCubeSide);
  for (const Triangle& t : boundary_triangles(mesh, 0, mesh.tet_count()))
    if (mesh.rest[t[0]][2] + mesh.rest[t[1]][2] + mesh.rest[t[2]][2] > 0) e.markers.push_back({t, {0.3, 0.3, 0.4}});
  for (const double x : {0.03, 0.06})
    for (const double depth : {0.004, 0.008}) {
      LoadCase load{.name = "poke", .group = "at " + std::to_string(x)};
      load.indenter = Indenter{IndenterShape::disc, IndenterContact::bonded, 0.02, 1e8};
      load.touch.center = {{x, 0.05, kCubeSide}};
      load.pose = load.touch;
      load.pose.center = {{x + depth / 4, 0.05, kCubeSide - depth}};
      load.force = Vec3d{};
      load.force_sigma = {{0.01, 0.01, 0.01}};
      for (size_t m = 0; m < e.markers.size(); ++m)
        load.positions.push_back({static_cast<int>(m), {}, {{1e-5, 1e-5, 1e-5}}});
      e.cases.push_back(std::move(load));
    }
  return e;
}

ParameterMap map_of(const Experiment& e, std::vector<FitParameter> parameters,
                    const std::string& material = "neo_hookean") {
  return ParameterMap(
      e.mesh, material,
      std::vector<MaterialParameters>(e.mesh.tets.size(), {lame_from_young_poisson(kCubeYoung, 0.4), {4}}),
      std::move(parameters));
}

const EquilibriumOptions kSynthetic{.tolerance = 1e-13};

// Simulated measurements of a body with these parameters, with noise in standard deviations.
void measure(Experiment& e, const ParameterMap& map, const std::vector<double>& p, double noise = 0) {
  Misfit body(e, map, kSynthetic);
  std::vector<double> r(body.residual_count());
  ASSERT_TRUE(body.evaluate(p, r)) << body.failure();
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto reading = [&](Vec3d exact, const Vec3d& sigma) {
    for (int k = 0; k < 3; ++k) exact[k] += noise * sigma[k] * normal(random);
    return exact;
  };
  for (size_t c = 0; c < e.cases.size(); ++c) {
    const CasePrediction& exact = body.prediction(static_cast<int>(c));
    for (size_t m = 0; m < exact.markers.size(); ++m)
      e.cases[c].positions[m].position = reading(exact.markers[m], e.cases[c].positions[m].sigma);
    e.cases[c].force = reading(exact.wrench.force, e.cases[c].force_sigma);
  }
}

FitReport fitted(const Experiment& e, const ParameterMap& map, FitOptions options) {
  Misfit misfit(e, map, kSynthetic);
  const auto prior = make_regularizer(e.mesh, map, {});
  return fit(misfit, *prior, map.guess(), options);
}

TEST(Recovery, FindsOneModulusAgainFromExactData) {
  Experiment e = indented_cube();
  const ParameterMap map = map_of(e, {{"young", Parameterization::uniform, 0, 3 * kCubeYoung}});
  measure(e, map, {std::log(kCubeYoung)});
  const FitReport report = fitted(e, map, {.tolerance = 1e-10, .weight = 0});
  EXPECT_TRUE(is_success(report.status)) << report.message;
  EXPECT_NEAR(map.values(0, report.p)[0], kCubeYoung, 1e-6 * kCubeYoung);
}

TEST(Recovery, RecoversModulusRatioAndStiffeningFromExactData) {
  Experiment e = indented_cube();
  const ParameterMap map = map_of(e,
                                  {{"young", Parameterization::uniform, 0, 0.5 * kCubeYoung},
                                   {"poisson", Parameterization::uniform, 0, 0.3},
                                   {"b", Parameterization::uniform, 0, 1}},
                                  "fung");
  std::vector<double> truth(map.guess().begin(), map.guess().end());
  truth[0] += 0.8, truth[1] += 0.5, truth[2] += 1;
  measure(e, map, truth);
  const FitReport report = fitted(e, map, {.tolerance = 1e-10, .weight = 0});
  EXPECT_TRUE(is_success(report.status)) << report.message;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(report.p[i], truth[i], 1e-5);
}

TEST(Recovery, FindsTwoLayersAgainFromExactData) {
  Experiment e = indented_cube();
  const ParameterMap map = map_of(e, {{"young", Parameterization::regions, 0, kCubeYoung}});
  const std::vector<double> truth{std::log(0.4 * kCubeYoung), std::log(4 * kCubeYoung)};
  measure(e, map, truth);
  const FitReport report = fitted(e, map, {.tolerance = 1e-10, .weight = 0});
  EXPECT_TRUE(is_success(report.status)) << report.message;
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(report.p[i], truth[i], 1e-6);
}

TEST(Recovery, OfFieldLeavesNoiseAndFindsStiffLayer) {
  Experiment e = indented_cube();
  const ParameterMap map = map_of(e, {{"young", Parameterization::tets, 0, kCubeYoung}});
  std::vector<double> truth;
  for (int region : e.mesh.region) truth.push_back(std::log(region == 1 ? 4 * kCubeYoung : 0.7 * kCubeYoung));
  measure(e, map, truth, 1);
  const FitReport report = fitted(e, map, {});
  ASSERT_TRUE(is_success(report.status)) << report.message;
  const double residuals = 3.0 * static_cast<double>(e.cases.size()) * static_cast<double>(e.markers.size() + 1);
  EXPECT_NEAR(2 * report.misfit / residuals, 1, 0.1);
  double mean[2] = {}, count[2] = {};
  for (size_t t = 0; t < truth.size(); ++t) mean[e.mesh.region[t]] += report.p[t], ++count[e.mesh.region[t]];
  EXPECT_NEAR(mean[0] / count[0], std::log(0.7 * kCubeYoung), 0.3);
  EXPECT_NEAR(mean[1] / count[1], std::log(4 * kCubeYoung), 0.4);
}

}  // namespace
}  // namespace aspic
