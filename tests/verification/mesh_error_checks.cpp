// The estimate of the discretization error of linear tets.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "reference/models.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// A static problem on meshes of n cells across.
struct Problem {
  std::function<TetMesh(int n)> mesh;
  // Adds pins and loads.
  std::function<void(const TetMesh& mesh, ModelBuilder& builder)> amend;
  int steps = 1;
};

ModelBuilder builder_of(const TetMesh& mesh, double poisson, double young = 1e5) {
  return model_of(mesh, {.material = "neo_hookean_log_j2", .young = young, .poisson = poisson, .gravity = {}});
}

Simulation solved(const Problem& problem, int n, double poisson, bool is_quadratic) {
  TetMesh mesh = problem.mesh(n);
  if (is_quadratic) mesh = raise_order(std::move(mesh));
  ModelBuilder builder = builder_of(mesh, poisson);
  problem.amend(mesh, builder);
  return equilibrium(builder.build(), problem.steps, "mesh error", 1e-9);
}

// Potential energies [J]: elastic and total.
struct Energies {
  double elastic, total;
};
Energies energies(const Simulation& simulation) {
  Energies sum{simulation.potential_energies()[0], 0};
  for (const double V : simulation.potential_energies()) sum.total += V;
  return sum;
}

// The estimated stiffness over the true one, minus 1 each. Truth: quadratic tets on two finer meshes.
struct Judged {
  double estimate, truth;
};
Judged judged(const Problem& problem, int n, double poisson, int finer) {
  const Simulation linear = solved(problem, n, poisson, false);
  const Energies on_mesh = energies(linear), coarse = energies(solved(problem, finer, poisson, true)),
                 fine = energies(solved(problem, 2 * finer, poisson, true));
  const double total = fine.total + (fine.total - coarse.total) / 3;
  const MeshErrorEstimate error = linear.mesh_error();
  return {error.bodies.at(0).stiffness, (on_mesh.total - total) / std::min(on_mesh.elastic, fine.elastic)};
}

TetMesh bar(double length, int n) { return make_box({{0, -.5, -.5}}, {{length, .5, .5}}, {int(length) * n, n, n}); }

Problem cantilever() {
  return {
      [](int n) { return bar(6, n); },
      [](const TetMesh& mesh, ModelBuilder& builder) {
        builder.pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
            .load(make_growing_load(traction_on(mesh, [](const Vec3d& X) { return X[0] > 6 - 1e-9; }, {{0, 0, -2}})));
      }};
}

Problem twist() {
  return {[](int n) { return bar(4, n); },
          [](const TetMesh&, ModelBuilder& builder) {
            builder.pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
                .pin(
                    "turned", [](const Vec3d& X) { return X[0] > 4 - 1e-9; },
                    [](const Vec3d& X, double t) {
                      const double a = t * std::numbers::pi / 2, c = std::cos(a), s = std::sin(a);
                      return Vec3d{{X[0], c * X[1] - s * X[2], s * X[1] + c * X[2]}};
                    });
          },
          3};
}

Problem cook() {
  return {[](int n) {
            TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 10}}, {n, n, std::max(1, n / 4)});
            for (Vec3d& X : mesh.rest) X = {{48 * X[0], 44 * X[0] + X[1] * (44 - 28 * X[0]), X[2]}};
            return mesh;
          },
          [](const TetMesh& mesh, ModelBuilder& builder) {
            builder.pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
                .load(make_growing_load(
                    traction_on(mesh, [](const Vec3d& X) { return X[0] > 48 - 1e-9; }, {{0, 1000, 0}})));
          },
          2};
}

std::string of_poisson(const std::string& what, double poisson) {
  return what + ", nu = " + std::to_string(poisson).substr(0, 4);
}

void check_clamped_beam(const Subject& subject, Findings& found) {
  Plot plot{"a clamped beam of linear tets is too stiff",
            "cells across",
            "stiffer than the body by [%]",
            Scales::logarithmic,
            {}};
  int color = 0;
  for (const double poisson : {0.3, 0.45, 0.49}) {
    Curve truth{of_poisson("true", poisson), {}, {}, CurveStyle::line, color};
    Curve estimated{of_poisson("estimated", poisson), {}, {}, CurveStyle::points, color++};
    for (const int n : subject.quick ? std::vector<int>{2} : std::vector<int>{1, 2, 3}) {
      const Judged k = judged(cantilever(), n, poisson, 4);
      truth.x.push_back(n), truth.y.push_back(100 * k.truth);
      estimated.x.push_back(n), estimated.y.push_back(100 * k.estimate);
      if (n == 1) continue;  // where quadratic tets err, too
      found.expect(of_poisson("beam, " + std::to_string(n) + " cells across", poisson) + ": estimate over truth",
                   {k.estimate / k.truth, 1, 0.05}, "the error of quadratic tets on this mesh");
    }
    plot.curves.insert(plot.curves.end(), {truth, estimated});
  }
  found.plots.push_back(plot);
}

void check_others(const Subject& subject, Findings& found) {
  const auto expect = [&](const std::string& name, const Problem& problem, std::array<int, 2> n, double poisson) {
    const Judged k = judged(problem, n[0], poisson, n[1]);
    found.expect(of_poisson(name, poisson) + ": estimate over truth", {k.estimate / k.truth, 1, 0.15},
                 "the error of quadratic tets on this mesh");
  };
  for (const double poisson : {0.3, 0.45, 0.49}) {
    if (subject.quick && poisson > 0.3) continue;
    expect("bar twisted by 90 degrees, 3 cells across", twist(), {3, 4}, poisson);
    expect("Cook's membrane, 8 cells", cook(), {8, subject.quick ? 8 : 12}, poisson);
  }
}

void check_ratios(const Subject& subject, Findings& found) {
  check_clamped_beam(subject, found);
  check_others(subject, found);
}

// The same estimate if only the middles of edges move, by an equilibrium in which pins hold the vertices, over the
// truth.
double of_edges_only(const Problem& problem, int n, double poisson) {
  const Simulation linear = solved(problem, n, poisson, false);
  std::map<std::array<double, 3>, Vec3d> place;
  const TetMesh& mesh = linear.model().mesh;
  std::vector<int> corners;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d& X = mesh.rest[v];
    place[{X[0], X[1], X[2]}] = point(linear.state().q, v);
    corners.push_back(v);
  }
  const TetMesh raised = raise_order(problem.mesh(n));
  ModelBuilder builder = builder_of(raised, poisson);
  problem.amend(raised, builder);
  builder.pin("corners", corners, [place](const Vec3d& X, double t) {
    return X + t * (place.at({X[0], X[1], X[2]}) - X);
  });
  const Energies on_edges = energies(equilibrium(builder.build(), problem.steps, "mesh error", 1e-9));
  const Energies on_mesh = energies(linear);
  return (on_mesh.total - on_edges.total) / on_mesh.elastic / judged(problem, n, poisson, 4).truth;
}

void check_invariance(const Subject&, Findings& found) {
  const Problem problem = cantilever();
  const auto stiffness = [&](double scale, double pressure) {
    TetMesh mesh = bar(6, 2);
    for (Vec3d& X : mesh.rest) X = scale * X;
    ModelBuilder builder = builder_of(mesh, 0.3, 1e5 * pressure);
    builder.pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
        .load(make_growing_load(
            traction_on(mesh, [=](const Vec3d& X) { return X[0] > scale * (6 - 1e-9); }, {{0, 0, -2 * pressure}})));
    return equilibrium(builder.build(), 1, "mesh error", 1e-10).mesh_error().bodies.at(0).stiffness;
  };
  const double in_meters = stiffness(1, 1);
  found.expect("beam in mm and MPa", {stiffness(1e3, 1e-6), in_meters, 1e-6 * in_meters}, "the residual of the solve");
  const int threads = thread_count();
  set_thread_count(1);
  const double alone = stiffness(1, 1);
  set_thread_count(threads);
  found.expect("bits with another number of threads: difference", {alone - in_meters, 0, 0}, "equal bits");
  std::vector<double> by_mesh;
  for (const int n : {2, 4, 8}) by_mesh.push_back(solved(problem, n, 0.3, false).mesh_error().bodies.at(0).stiffness);
  found.expect("order in the edge length", {std::log2(by_mesh[1] / by_mesh[2]), 2, 0.3}, "the next term");
  found.expect("correction of edges only, over the truth: no estimate", {of_edges_only(problem, 2, 0.3), 0.48, 0.02},
               "another program");
}

}  // namespace

void add_mesh_error_checks(std::vector<Check>& checks) {
  const std::string reference = "Quadratic tets on two finer meshes, extrapolated";
  checks.push_back({"statics",
                    "mesh_error",
                    "The estimate of the mesh error",
                    "The stiffness of linear tets over the true one, minus 1: estimated by one linear solve with "
                    "quadratic tets, and true.",
                    reference,
                    check_ratios,
                    {"Bank1993"}});
  checks.push_back({"statics",
                    "mesh_error_invariance",
                    "The estimate of the mesh error: units, threads and order",
                    "A clamped beam in other units, with another number of threads, and on finer meshes.",
                    "The estimate in meters; order 2",
                    check_invariance,
                    {"Bank1993"}});
}

}  // namespace aspic::verify
