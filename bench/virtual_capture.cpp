#include "bench/virtual_capture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "base/error.h"
#include "mesh/generators.h"
#include "mesh/numbering.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"
#include "mesh/vertices.h"

namespace aspic::bench {
namespace {

constexpr double kDensity = 1000;  // [kg/m^3]

struct Site {
  Vec3d point;  // in units of the cube's side
  Vec3d inwards;
};
const std::array<Site, 9> kSites = {{{{0.3, 0.3, 1}, {0, 0, -1}},
                                     {{0.7, 0.7, 1}, {0, 0, -1}},
                                     {{0.7, 0.3, 1}, {0, 0, -1}},
                                     {{0.3, 0.7, 1}, {0, 0, -1}},
                                     {{0, 0.5, 0.6}, {1, 0, 0}},
                                     {{1, 0.5, 0.6}, {-1, 0, 0}},
                                     {{0.5, 0, 0.6}, {0, 1, 0}},
                                     {{0.5, 1, 0.6}, {0, -1, 0}},
                                     {{0.5, 0.5, 1}, {0, 0, -1}}}};

TetMesh cube(double side, int cells) {
  const TetMesh mesh = make_box({0, 0, 0}, {side, side, side}, {cells, cells, cells});
  return from_user(locality_numbering(mesh), mesh);
}

bool is_in_ball(const VirtualCapture& setup, const Vec3d& X) {
  const Vec3d u = (1 / setup.side) * X - Vec3d{0.5, 0.5, 0.6};
  return dot(u, u) < 0.25 * 0.25;
}

std::vector<double> true_field(const VirtualCapture& setup, const TetMesh& mesh) {
  std::vector<double> z;
  for (int t = 0; t < mesh.tet_count(); ++t)
    z.push_back(std::log(setup.young * (is_in_ball(setup, centroid(mesh, t)) ? setup.contrast : 1)));
  return z;
}

// Points on the top and the sides.
std::vector<Vec3d> marker_points(const VirtualCapture& setup) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.02, 0.98);
  std::vector<Vec3d> points;
  for (int i = 0; i < setup.markers; ++i) {
    const double u = uniform(random), v = uniform(random);
    const std::array<Vec3d, 5> faces = {{{u, v, 1}, {0, u, v}, {1, u, v}, {u, 0, v}, {u, 1, v}}};
    points.push_back(setup.side * faces[i % 5]);
  }
  return points;
}

// Surface triangle that contains a point, with the point's weights.
SurfacePoint locate(const TetMesh& mesh, const std::vector<Triangle>& triangles, const Vec3d& p) {
  SurfacePoint best;
  double least = INFINITY;
  for (const Triangle& t : triangles) {
    const Vec3d &a = mesh.rest[t[0]], &b = mesh.rest[t[1]], &c = mesh.rest[t[2]], n = cross(b - a, c - a);
    const double area = dot(n, n);
    const std::array<double, 3> w = {dot(n, cross(b - p, c - p)) / area, dot(n, cross(c - p, a - p)) / area,
                                     dot(n, cross(a - p, b - p)) / area};
    const double away = dot(n, p - a) * dot(n, p - a) / area;  // squared distance from the plane
    const double outside = std::max(0.0, -*std::min_element(w.begin(), w.end()));
    if (const double cost = away / std::sqrt(area) + outside; cost < least) least = cost, best = {t, w};
  }
  return best;
}

LoadCase indentation(const VirtualCapture& setup, int site) {
  const auto& [point, inwards] = kSites.at(site);
  LoadCase load;
  load.name = load.group = "poke " + std::to_string(site + 1);
  const double radius = 0.12 * setup.side;
  load.tip = Tip{TipShape::disc, TipContact::bonded, radius, 200 * setup.young / setup.side};
  load.touch = {setup.side * point, inwards, {}};
  load.pose = {setup.side * point + setup.depth * inwards, inwards, {}};
  for (int m = 0; m < setup.markers; ++m) load.positions.push_back({m, {}, {1, 1, 1}});
  load.force = Vec3d{};
  load.force_sigma = {1, 1, 1};
  return load;
}

Experiment experiment_on(const VirtualCapture& setup, int cells) {
  Experiment e;
  e.mesh = cube(setup.side, cells);
  e.density.assign(e.mesh.tets.size(), kDensity);
  e.fixed = vertices_where(e.mesh, [](const Vec3d& X) { return X[2] == 0; });
  const std::vector<Triangle> surface = boundary_triangles(e.mesh, 0, e.mesh.tet_count());
  for (const Vec3d& p : marker_points(setup)) e.markers.push_back(locate(e.mesh, surface, p));
  for (int site = 0; site < setup.indentations; ++site) e.cases.push_back(indentation(setup, site));
  return e;
}

Vec3d rest_position(const Experiment& e, int marker) {
  Vec3d sum{};
  for (int k = 0; k < 3; ++k) sum = sum + e.markers[marker].weights[k] * e.mesh.rest[e.markers[marker].vertices[k]];
  return sum;
}

}  // namespace

std::vector<MaterialParameters> known(const VirtualCapture& setup, const TetMesh& mesh) {
  return std::vector<MaterialParameters>(mesh.tets.size(), {lame_from_young_poisson(setup.young, setup.poisson), {}});
}

Captured capture(const VirtualCapture& setup) {
  const Experiment source = experiment_on(setup, setup.data_cells);
  const ParameterMap map(source.mesh, "neo_hookean", known(setup, source.mesh),
                         {{"young", Parameterization::tets, 0, setup.young}});
  Misfit model(source, map);
  std::vector<double> r(model.residual_count());
  if (!model.evaluate(true_field(setup, source.mesh), r))
    throw InvalidInput("the data cannot be made: " + model.failure());

  double motion = 0, force = 0;
  for (int c = 0; c < setup.indentations; ++c) {
    const CasePrediction& found = model.prediction(c);
    for (int m = 0; m < setup.markers; ++m) {
      const Vec3d u = found.markers[m] - rest_position(source, m);
      motion = std::max(motion, norm(u));
    }
    force = std::max(force, norm(found.wrench.force));
  }

  Captured data{experiment_on(setup, setup.cells), {}, {}};
  std::mt19937 random(setup.seed);
  std::normal_distribution<double> normal;
  const auto measured = [&](const Vec3d& x, double sigma) {
    return x + setup.noise * sigma * Vec3d{normal(random), normal(random), normal(random)};
  };
  const auto stated = [&](double size) {  // exact data need a positive standard deviation, too
    const double d = std::max(setup.noise, 1e-4) * size;
    return Vec3d{d, d, d};
  };
  for (int c = 0; c < setup.indentations; ++c) {
    LoadCase& load = data.experiment.cases[c];
    const CasePrediction& found = model.prediction(c);
    for (int m = 0; m < setup.markers; ++m) load.positions[m] = {m, measured(found.markers[m], motion), stated(motion)};
    load.force = measured(found.wrench.force, force);
    load.force_sigma = stated(force);
  }
  const TetMesh& mesh = data.experiment.mesh;
  data.truth = true_field(setup, mesh);
  for (int t = 0; t < mesh.tet_count(); ++t) data.inside.push_back(is_in_ball(setup, centroid(mesh, t)));
  return data;
}

}  // namespace aspic::bench
