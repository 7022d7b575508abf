// A block of gel on a table, indented by a glued disc: small enough that hundreds of equilibria take a second.
#pragma once
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "mesh/generators.h"
#include "mesh/surface.h"
#include "model/misfit.h"

namespace aspic::test {

struct IndentedBlock {
  static constexpr double kSide = 0.06, kHeight = 0.04, kYoung = 2e4;  // [m], [m], [Pa]
  struct Site {
    std::string name;
    Vec3d point, inward;
  };
  Experiment experiment;

  explicit IndentedBlock(std::array<int, 3> cells = {3, 3, 2}) {
    TetMesh& mesh = experiment.mesh = make_box({{0, 0, 0}}, {{kSide, kSide, kHeight}}, cells, BoxCut::five);
    experiment.density.assign(mesh.tets.size(), 1000.0);
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.rest[v][2] < 1e-9) experiment.fixed.push_back(v);
    for (const Triangle& t : boundary_triangles(mesh, 0, mesh.tet_count()))
      if (mesh.rest[t[0]][2] + mesh.rest[t[1]][2] + mesh.rest[t[2]][2] > 1e-9)
        experiment.markers.push_back({t, {0.4, 0.3, 0.3}});
  }

  static std::vector<Site> sites() {
    const double s = kSide, h = kHeight;
    return {{"left", {{0.25 * s, 0.5 * s, h}}, {{0, 0, -1}}},
            {"right", {{0.75 * s, 0.5 * s, h}}, {{0, 0, -1}}},
            {"side", {{0, 0.5 * s, 0.6 * h}}, {{1, 0, 0}}},
            {"back", {{0.5 * s, s, 0.6 * h}}, {{0, -1, 0}}}};
  }

  // Pushed in and sideways; standard deviations relative to the depth and to a typical force.
  void add_indentation(const Site& site, double depth, double noise, bool with_force = true) {
    LoadCase load{.name = site.name, .group = site.name};
    load.indenter = Indenter{IndenterShape::disc, IndenterContact::bonded, 0.012, 1000 * kYoung / 0.012};
    load.touch = {.center = site.point, .axis = site.inward};
    load.pose = load.touch;
    load.pose.center = load.touch.center + depth * site.inward +
                       (0.3 * depth) * Vec3d{{site.inward[1], site.inward[2], site.inward[0]}};
    const double d = noise * depth, f = noise * kYoung * 0.012 * depth;
    for (size_t m = 0; m < experiment.markers.size(); ++m)
      load.positions.push_back({static_cast<int>(m), {}, {{d, d, d}}});
    if (with_force) load.force = Vec3d{}, load.force_sigma = {{f, f, f}};
    experiment.cases.push_back(load);
  }

  // Readings of a body with the parameters p of the map, with normal noise.
  void measure(const ParameterMap& map, std::span<const double> p, std::mt19937_64& random, double noise = 1) {
    Misfit truth(experiment, map);
    std::vector<double> r(truth.residual_count());
    ASSERT_TRUE(truth.evaluate(p, r)) << truth.failure();
    std::normal_distribution<double> normal;
    const auto read = [&](Vec3d x, const Vec3d& sigma) {
      for (int i = 0; i < 3; ++i) x[i] += noise * sigma[i] * normal(random);
      return x;
    };
    for (size_t c = 0; c < experiment.cases.size(); ++c) {
      LoadCase& load = experiment.cases[c];
      const CasePrediction& exact = truth.prediction(static_cast<int>(c));
      for (size_t k = 0; k < load.positions.size(); ++k)
        load.positions[k].position = read(exact.markers[k], load.positions[k].sigma);
      if (load.force) load.force = read(exact.wrench.force, load.force_sigma);
    }
  }

  ParameterMap map(std::vector<FitParameter> parameters = {{.guess = kYoung}}) const {
    return {experiment.mesh, "stable_neo_hookean",
            std::vector<MaterialParameters>(experiment.mesh.tets.size(), {lame_from_young_poisson(kYoung, 0.45)}),
            std::move(parameters)};
  }
};

}  // namespace aspic::test
