// Iterations of preconditioned conjugate gradients on the systems of time steps, on what is hard for a preconditioner:
// limbs, slivers, contrasts, stiff and nearly incompressible bodies, states far from rest. usage: bench_preconditioners
// [--solver NAME]... [--state NAME]... MESH...   MESH: a file, cube:N or beam:N (cells)
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/stopwatch.h"
#include "dynamics/incremental_potential.h"
#include "io/mesh_file.h"
#include "linalg/linear_solver.h"
#include "mesh/generators.h"

namespace aspic::bench {
namespace {

constexpr double kStep = 1.0 / 60;  // [s]
constexpr double kDensity = 1000;   // [kg/m^3]
constexpr std::array<double, 3> kTolerances = {1e-2, 1e-4, 1e-8};

struct Case {
  std::string state = "bent";
  double young = 1e5;  // [Pa]
  double poisson = 0.45;
  double contrast = 1;
};

TetMesh load(const std::string& name) {
  TetMesh mesh;
  if (name.starts_with("cube:")) {
    const int n = std::atoi(name.c_str() + 5);
    mesh = make_box({0, 0, 0}, {1, 1, 1}, {n, n, n});
  } else if (name.starts_with("beam:")) {
    const int n = std::atoi(name.c_str() + 5);
    mesh = make_box({0, 0, 0}, {4, 1, 1}, {4 * n, n, n});
  } else {
    mesh = read_tet_mesh(name);
  }
  Vec3d low = mesh.rest[0], high = low;
  for (const Vec3d& X : mesh.rest)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], X[k]), high[k] = std::max(high[k], X[k]);
  const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  for (Vec3d& X : mesh.rest) X = (1 / size) * (X - low);
  return mesh;
}

int longest_axis(const TetMesh& mesh) {
  Vec3d high = mesh.rest[0];
  for (const Vec3d& X : mesh.rest)
    for (int k = 0; k < 3; ++k) high[k] = std::max(high[k], X[k]);
  return high[0] >= high[1] && high[0] >= high[2] ? 0 : high[1] >= high[2] ? 1 : 2;
}

std::vector<double> deformed(const TetMesh& mesh, const std::string& state) {
  const int axis = longest_axis(mesh), u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> x;
  for (const Vec3d& X : mesh.rest) {
    Vec3d y = X;
    if (state == "bent") {
      for (int k = 0; k < 3; ++k)
        y[k] = X[k] * (k == 0 ? 1.05 : k == 1 ? 0.97 : 0.99) + 0.05 * std::sin(3 * X[(k + 1) % 3]);
    } else if (state == "twisted") {
      const double angle = 2 * X[axis], c = std::cos(angle), s = std::sin(angle);
      y[u] = c * X[u] - s * X[v];
      y[v] = s * X[u] + c * X[v];
    } else if (state == "stretched") {
      y[axis] = 3 * X[axis];
    } else if (state == "noisy") {
      for (int k = 0; k < 3; ++k) y[k] += 0.02 * uniform(random);
    } else if (state != "rest") {
      throw InvalidInput("no state '" + state + "'");
    }
    x.insert(x.end(), {y[0], y[1], y[2]});
  }
  return x;
}

Model make_model(const TetMesh& mesh, const Case& c) {
  Model model;
  model.mesh = mesh;
  model.bodies = {{"body", 0, mesh.vertex_count(), 0, mesh.tet_count()}};
  model.density.assign(mesh.tet_count(), kDensity);
  model.mass = std::make_unique<MassMatrix>(mesh, model.density, MassKind::lumped);
  std::vector<MaterialParameters> parameters;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Vec3d center{};
    for (const int v : mesh.tets[t]) center = center + 0.25 * mesh.rest[v];
    const double checker = std::sin(25 * center[0]) * std::sin(25 * center[1]) * std::sin(25 * center[2]);
    const double young = c.young * (c.contrast > 1 && checker > 0 ? c.contrast : 1);
    parameters.push_back({.lame = lame_from_young_poisson(young, c.poisson)});
  }
  model.elasticity.push_back(make_tet_elasticity("neo_hookean", mesh, 0, parameters));
  Pin& pin = model.pins.emplace_back();
  const int axis = longest_axis(mesh);
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (mesh.rest[i][axis] < 0.05) pin.vertices.push_back(i);
  return model;
}

void run(const std::string& name, const TetMesh& mesh, const Case& c, const std::string& solver_name) {
  const Model model = make_model(mesh, c);
  std::vector<double> rest;
  for (const Vec3d& X : mesh.rest) rest.insert(rest.end(), {X[0], X[1], X[2]});
  const Pins pins(model.pins, rest);
  IncrementalPotential E(model, pins);
  const std::vector<double> x = deformed(mesh, c.state);
  E.begin_step(x, 1, kStep * kStep);
  const BlockSparse& H = E.hessian(x, {Definiteness::clamped});
  std::vector<double> b(x.size()), d(x.size());
  for (int v = 0; v < mesh.vertex_count(); ++v)
    for (int k = 0; k < 3; ++k)
      b[3 * v + k] = std::array{0.3, -9.8, 0.1}[k] * model.mass->vertex_mass()[v] * kStep * kStep;
  pins.set_zero(b);

  const auto solver = make_linear_solver(solver_name);
  Stopwatch stopwatch;
  solver->analyze(*H.pattern);
  if (!solver->factorize(H)) {
    std::printf("%-28s %-9s E %.0e nu %.3f contrast %.0e: not positive definite\n", name.c_str(), c.state.c_str(),
                c.young, c.poisson, c.contrast);
    return;
  }
  const double analysis = stopwatch.cpu_seconds();
  stopwatch = {};
  solver->factorize(H);
  const double factorisation = stopwatch.cpu_seconds();
  std::printf("%-28s %7d %-9s E %.0e nu %.3f contrast %.0e %-12s", name.substr(name.rfind('/') + 1).c_str(),
              mesh.vertex_count(), c.state.c_str(), c.young, c.poisson, c.contrast, solver_name.c_str());
  double per_iteration = 0;
  for (const double tolerance : kTolerances) {
    stopwatch = {};
    const SolveReport report = solver->solve(b, d, tolerance);
    per_iteration = stopwatch.cpu_seconds() / std::max(1, report.iterations);
    std::printf(report.ok ? " %5d" : " >%4d", report.iterations);
  }
  std::printf("  analysis %7.1f ms  set-up %6.2f ms  iteration %6.3f ms\n", 1e3 * analysis, 1e3 * factorisation,
              1e3 * per_iteration);
  std::printf("   %s\n", solver->description().c_str());
  std::fflush(stdout);
}

}  // namespace
}  // namespace aspic::bench

int main(int argc, char** argv) {
  using namespace aspic;
  using namespace aspic::bench;
  std::vector<std::string> meshes, solvers;
  bool brief = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--solver") == 0)
      solvers.emplace_back(argv[++i]);
    else if (std::strcmp(argv[i], "--brief") == 0)
      brief = true;
    else
      meshes.emplace_back(argv[i]);
  }
  set_thread_count(1);
  if (solvers.empty()) solvers = {"multigrid"};
  const std::vector<Case> brief_cases = {{.state = "rest", .young = 1e9, .poisson = 0.3},
                                         {.state = "rest", .young = 1e9, .poisson = 0.45},
                                         {.state = "bent", .young = 1e9, .poisson = 0.3},
                                         {},
                                         {.young = 1e9},
                                         {.state = "twisted", .young = 1e8},
                                         {.young = 1e5, .contrast = 1e4}};
  const std::vector<Case> all_cases = {{.young = 1e3},
                                       {},
                                       {.young = 1e7},
                                       {.young = 1e9},
                                       {.state = "twisted", .young = 1e8},
                                       {.state = "stretched", .young = 1e8},
                                       {.state = "noisy", .young = 1e8},
                                       {.young = 1e8, .poisson = 0.49},
                                       {.young = 1e8, .poisson = 0.495},
                                       {.young = 1e5, .contrast = 1e4},
                                       {.young = 1e8, .contrast = 1e4}};
  for (const std::string& name : meshes) {
    const TetMesh mesh = load(name);
    for (const Case& c : brief ? brief_cases : all_cases)
      for (const std::string& solver : solvers) run(name, mesh, c, solver);
  }
  return 0;
}
