// Sparse Cholesky factorization on one and two threads, compared with CHOLMOD if it is installed, in alternation.
// usage: bench_cholesky [mesh file]...; default: beams and cubes. Times: CPU time [ms] for one thread, wall time
// relative to one thread for two; minimum of several runs. The system determines the BLAS of CHOLMOD (LD_LIBRARY_PATH).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "bench/beam_problem.h"
#include "bench/cholmod_times.h"
#include "bench/stopwatch.h"
#include "dynamics/model_builder.h"
#include "io/mesh_file.h"
#include "linalg/cholesky.h"
#include "mesh/vertices.h"

namespace {

using namespace aspic;
using bench::CholeskyTimes;

constexpr int kRuns = 7;

struct Problem {
  BlockPattern pattern;
  std::unique_ptr<BlockSparse> H;  // Hessian of a time step at rest
  std::vector<double> b;
};

Problem make_problem(const TetMesh& mesh) {
  const Model model = ModelBuilder(mesh)
                          .material("neo_hookean_log", {.young = bench::kYoung, .poisson = bench::kPoisson})
                          .density(bench::kDensity)
                          .mass(MassKind::lumped)
                          .build();
  const std::vector<double> x = rest_positions(mesh);
  Couplings couplings;
  model.elasticity[0]->add_couplings(couplings);
  model.mass->add_couplings(couplings);
  Problem problem;
  problem.pattern = make_pattern(mesh.vertex_count(), std::move(couplings));
  model.mass->bind(problem.pattern);
  model.elasticity[0]->bind(problem.pattern);
  problem.H = std::make_unique<BlockSparse>(problem.pattern);
  problem.H->set_zero();
  model.mass->add_to(1, *problem.H);
  model.elasticity[0]->add_hessian(x, bench::kTimeStep * bench::kTimeStep, {Definiteness::exact}, *problem.H);
  for (size_t i = 0; i < x.size(); ++i) problem.b.push_back(std::sin(static_cast<double>(i)));
  return problem;
}

template <class Time>
CholeskyTimes run_once(const Problem& problem, Cholesky& solver, Time time) {
  CholeskyTimes times;
  std::vector<double> x(problem.b.size());
  const bench::Stopwatch analysis;
  solver.analyze(problem.pattern);
  times.analysis = time(analysis);
  solver.factorize(*problem.H);  // touches the memory
  const bench::Stopwatch factorization;
  if (!solver.factorize(*problem.H)) std::puts("the matrix is not positive definite");
  times.factorization = time(factorization);
  solver.solve(problem.b, x, 1e-10);
  const bench::Stopwatch solve;
  solver.solve(problem.b, x, 1e-10);
  times.solve = time(solve);
  return times;
}

void compare(const std::string& name, const TetMesh& mesh) {
  const Problem problem = make_problem(mesh);
  const auto cpu = [](const bench::Stopwatch& watch) { return watch.cpu_seconds(); };
  const auto wall = [](const bench::Stopwatch& watch) { return watch.seconds(); };
  CholeskyTimes own, cholmod, one, two;
  Cholesky solver;
  bench::Cholmod oracle(*problem.H);
  for (int run = 0; run < kRuns; ++run) {
    cholmod.lower_to(oracle.run_once(problem.b));
    set_thread_count(1);
    own.lower_to(run_once(problem, solver, cpu));
    one.lower_to(run_once(problem, solver, wall));
    set_thread_count(2);
    two.lower_to(run_once(problem, solver, wall));
  }
  const CholeskyAnalysis& cost = solver.analysis();
  const double ms = 1e3;
  std::printf("%-12s %6zu %6.2f %6.1f | %6.1f %7.1f %6.2f | %5.2f %5.2f %5.2f | %5.2f %5.2f %5.2f | %4.1f\n",
              name.c_str(), problem.b.size(), static_cast<double>(cost.nnz) * 1e-6, cost.flops * 1e-9,
              own.analysis * ms, own.factorization * ms, own.solve * ms, own.analysis / cholmod.analysis,
              own.factorization / cholmod.factorization, own.solve / cholmod.solve, two.analysis / one.analysis,
              two.factorization / one.factorization, two.solve / one.solve, cost.flops * 1e-9 / own.factorization);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::puts(
      "                    nnz(L)        |  one thread [ms]       |  own / CHOLMOD    |  two threads/one  |\n"
      "mesh            dof [1e6] Gflop   | anal.  factor. solve   | anal. fact. solve | anal. fact. solve | Gflop/s");
  if (argc > 1) {
    for (int i = 1; i < argc; ++i) compare(std::filesystem::path(argv[i]).filename(), read_tet_mesh(argv[i]));
    return 0;
  }
  for (const int n : {7, 14}) compare("beam " + std::to_string(n), bench::make_beam(n));
  for (const int n : {13, 20}) compare("cube " + std::to_string(n), make_box({0, 0, 0}, {1, 1, 1}, {n, n, n}));
}
