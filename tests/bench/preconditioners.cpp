// Iterations of preconditioned conjugate gradients in time steps that are hard for a preconditioner: limbs, slivers,
// contrasts, stiff and nearly incompressible bodies, large deformations.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/machine.h"
#include "bench/program.h"
#include "bench/shapes.h"
#include "bench/stopwatch.h"
#include "dynamics/incremental_potential.h"
#include "dynamics/model_builder.h"
#include "io/mesh_file.h"
#include "linalg/linear_solver.h"
#include "mesh/generators.h"
#include "mesh/numbering.h"
#include "mesh/vertices.h"
#include "optimize/minimize.h"
#include "optimize/newton.h"

namespace aspic::bench {
namespace {

constexpr double kStep = 1.0 / 60;                                 // [s]
constexpr double kDensity = 1000;                                  // [kg/m^3]
constexpr std::array<double, 3> kTolerances = {1e-2, 1e-4, 1e-8};  // relative to the right-hand side

struct Case {
  std::string state = "bent";
  double young = 1e5;  // [Pa]
  double poisson = 0.45;
  double contrast = 1;  // ratio of stiffness in a 3-D checkerboard with cells of an eighth of the body
};

const std::vector<Case> kCases = {{.young = 1e3},
                                  {.young = 1e5},
                                  {.young = 1e7},
                                  {.young = 1e9},
                                  {.state = "twisted", .young = 1e7},
                                  {.state = "stretched", .young = 1e7},
                                  {.state = "recovering", .young = 1e7},
                                  {.young = 1e7, .poisson = 0.49},
                                  {.young = 1e7, .poisson = 0.495},
                                  {.young = 1e5, .contrast = 1e4},
                                  {.young = 1e7, .contrast = 1e4}};

// Moves every vertex randomly by up to `reach` [m] while every tet keeps a fiftieth of its volume. Creates slivers.
void roughen(TetMesh& mesh, double reach) {
  std::vector<std::vector<int>> around(mesh.vertex_count());
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (const int v : mesh.tets[t]) around[v].push_back(t);
  const auto volume = [&](int t) {
    const Tet& k = mesh.tets[t];
    const auto& X = mesh.rest;
    return determinant(from_columns(X[k[1]] - X[k[0]], X[k[2]] - X[k[0]], X[k[3]] - X[k[0]]));
  };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  const double least = volume(0) / 50;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d before = mesh.rest[v];
    mesh.rest[v] = before + Vec3d{uniform(random), uniform(random), uniform(random)};
    for (const int t : around[v])
      if (volume(t) < least) mesh.rest[v] = before;
  }
}

TetMesh filled(const std::string& name, const std::string& folder) {
  const size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon), detail = colon == std::string::npos ? "" : name.substr(colon + 1);
  const int n = std::atoi(detail.c_str());
  if (n > 0 && kind == "cube") return make_box({0, 0, 0}, {1, 1, 1}, {n, n, n});
  if (n > 0 && kind == "beam") return make_box({0, 0, 0}, {4, 1, 1}, {4 * n, n, n});
  if (n > 0 && kind == "slivers") {
    TetMesh mesh = make_box({0, 0, 0}, {1, 1, 1}, {n, n, n});
    roughen(mesh, 0.7 / n);
    return mesh;
  }
  if (detail.empty()) return read_tet_mesh(name);
  const Shape& shape = shape_named(kind);
  for (const Detail& d : shape.details)
    if (d.name == detail) return standing_mesh(shape, d, folder);
  throw InvalidInput("the shape '" + kind + "' has no detail '" + detail + "' (try 3k)");
}

// Scales the mesh to a longest side of 1 m, along x.
TetMesh lying_mesh(const std::string& name, const std::string& folder) {
  TetMesh mesh = filled(name, folder);
  Vec3d low = mesh.rest.at(0), high = low;
  for (const Vec3d& X : mesh.rest)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], X[k]), high[k] = std::max(high[k], X[k]);
  const Vec3d side = high - low;
  const int x = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
  for (Vec3d& X : mesh.rest) {
    const Vec3d Y = (1 / side[x]) * (X - low);
    X = {Y[x], Y[(x + 1) % 3], Y[(x + 2) % 3]};
  }
  return from_user(locality_numbering(mesh), mesh);
}

Model make_model(const TetMesh& mesh, const Case& c) {
  std::vector<MaterialParameters> parameters;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Vec3d center{};
    for (const int v : mesh.tets[t]) center = center + 0.25 * mesh.rest[v];
    const double checkers = std::sin(25 * center[0]) * std::sin(25 * center[1]) * std::sin(25 * center[2]);
    parameters.push_back({.lame = lame_from_young_poisson(c.young * (checkers > 0 ? c.contrast : 1), c.poisson)});
  }
  return ModelBuilder(mesh)
      .material("neo_hookean", parameters)
      .density(kDensity)
      .mass(MassKind::lumped)
      .pin("end", [](const Vec3d& X) { return X[0] < 0.05; })
      .build();
}

Vec3d moved(const std::string& state, const Vec3d& X) {
  if (state == "bent") {
    const Vec3d stretch = {1.05, 0.97, 0.99};
    Vec3d y;
    for (int k = 0; k < 3; ++k) y[k] = stretch[k] * X[k] + 0.05 * std::sin(3 * X[(k + 1) % 3]);
    return y;
  }
  if (state == "twisted") {  // by 2 rad from end to end
    const double c = std::cos(2 * X[0]), s = std::sin(2 * X[0]);
    return {X[0], c * X[1] - s * X[2], s * X[1] + c * X[2]};
  }
  return {3 * X[0], X[1], X[2]};  // stretched
}

// State after five Newton iterations from random displacements of up to 3 cm, which invert many tets.
std::vector<double> recovering(IncrementalPotential& E, std::vector<double> x, const Pins& pins) {
  std::vector<double> start = x;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-0.03, 0.03);
  for (double& xi : x) xi += uniform(random);
  pins.place(0, x);
  E.at({.predicted = start, .factor = kStep * kStep});
  Newton newton(make_linear_solver("auto"), NewtonDefiniteness::clamped);
  MinimizeOptions options;
  options.max_iterations = 5;
  Minimizer().minimize(E, newton, x, options);
  return x;
}

void measure(const std::string& name, const TetMesh& mesh, const Case& c, const std::string& linear) {
  const Model model = make_model(mesh, c);
  const std::vector<double> rest = rest_positions(mesh);
  const Pins pins(model.pins, rest);
  IncrementalPotential E(model, pins);
  std::vector<double> x = rest;
  if (c.state == "recovering") {
    x = recovering(E, rest, pins);
  } else {
    for (int v = 0; v < mesh.vertex_count(); ++v) std::copy_n(moved(c.state, mesh.rest[v]).a, 3, &x[3 * v]);
  }
  E.at({.predicted = x, .factor = kStep * kStep});
  const BlockSparse& H = E.hessian(x, {Definiteness::clamped});
  std::vector<double> b(x.size()), d(x.size());
  for (size_t i = 0; i < b.size(); ++i)
    b[i] = std::array{0.3, -9.8, 0.1}[i % 3] * model.mass->vertex_mass()[i / 3] * kStep * kStep;
  pins.set_zero(b);

  std::printf("%-14s %7d %-10s %6.0e %6.3f %8.0e %-12s |", name.c_str(), mesh.vertex_count(), c.state.c_str(), c.young,
              c.poisson, c.contrast, linear.c_str());
  const auto solver = make_linear_solver(linear);
  Stopwatch stopwatch;
  solver->analyze(*H.pattern);
  bool definite = solver->factorize(H);  // one-time work is done here
  const double analysis = stopwatch.lap().processor;
  solver->begin();
  definite = solver->factorize(H) && definite;
  const double set_up = stopwatch.lap().processor;
  if (!definite) return void(std::printf(" not positive definite\n"));
  double per_iteration = 0;
  for (const double tolerance : kTolerances) {
    stopwatch.lap();
    const SolveReport report = solver->solve(b, d, tolerance);
    per_iteration = stopwatch.lap().processor / std::max(1, report.iterations);
    std::printf(report.ok ? " %5d" : " >%4d", report.iterations);
  }
  std::printf(" | %8.1f %8.2f %8.3f\n", 1e3 * (analysis - set_up), 1e3 * set_up, 1e3 * per_iteration);
  std::fflush(stdout);
}

}  // namespace
}  // namespace aspic::bench

int main(int argc, char** argv) {
  using namespace aspic;
  using namespace aspic::bench;
  std::vector<std::string> meshes = {"cube:13", "slivers:13", "beam:14", "bunny:3k", "bunny:10k"},
                           linear = {"multigrid"};
  std::string folder = "build/shapes";
  bool quiet = false;
  CLI::App app(
      "Counts iterations of preconditioned conjugate gradients on systems that are hard for a preconditioner.");
  app.add_option("mesh", meshes, "cube:N, slivers:N, beam:N, SHAPE:DETAIL (see bench_characters --list) or a file")
      ->capture_default_str();
  app.add_option("--linear", linear, "Linear solvers")->capture_default_str();
  app.add_option("--shapes", folder, "Folder of the surfaces and the generated meshes")->capture_default_str();
  app.add_flag("--quiet", quiet, "Omit the description of the machine");
  return run_program(app, argc, argv, [&] {
    for (const std::string& solver : linear) make_linear_solver(solver);  // reports misspelled names early
    if (!quiet) print_facts(machine_facts());
    set_thread_count(1);
    std::printf(
        "\nh = 1/60 s, 5 %% of the length held; iterations to 1e-2, 1e-4, 1e-8 of the right-hand side; analysis, "
        "set-up "
        "and an iteration in ms of one thread\n%-14s %7s %-10s %6s %6s %8s %-12s | %5s %5s %5s | %8s %8s %8s\n",
        "mesh", "verts", "state", "E [Pa]", "nu", "contrast", "solver", "1e-2", "1e-4", "1e-8", "analysis", "set-up",
        "iteration");
    for (const std::string& name : meshes) {
      const TetMesh mesh = lying_mesh(name, folder);
      for (const Case& c : kCases)
        for (const std::string& solver : linear) measure(name, mesh, c, solver);
    }
    return 0;
  });
}
