// The kernels that a step is made of, on the beam of 56 x 14 x 14 cells: 12 825 vertices, 65 856 tets.
// usage: bench_kernels [--benchmark_filter=hessian] ...
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/beam_problem.h"
#include "energy/mass.h"
#include "energy/tet_elasticity.h"
#include "linalg/linear_solver.h"

namespace {

using namespace aspic;

constexpr int kCells = 14;

// The beam bent and sheared a little, one material, and the Hessian of a time step.
struct Beam {
  TetMesh mesh = bench::make_beam(kCells);
  std::vector<double> x;
  std::unique_ptr<TetElasticity> elasticity;
  BlockPattern pattern;
  std::unique_ptr<BlockSparse> H;

  explicit Beam(const std::string& material) {
    const MaterialParameters parameters{.lame = lame_from_young_poisson(bench::kYoung, bench::kPoisson)};
    elasticity = make_tet_elasticity(material, mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), parameters));
    for (const Vec3d& X : mesh.rest) {
      x.insert(x.end(), {X[0] + 0.02 * std::sin(X[1]), X[1] - 0.01 * X[0] * X[0], X[2] + 0.03 * X[0] * X[1]});
    }
    Couplings couplings;
    elasticity->add_couplings(couplings);
    MassMatrix mass(mesh, std::vector<double>(mesh.tet_count(), bench::kDensity), MassKind::consistent);
    mass.add_couplings(couplings);
    pattern = make_pattern(mesh.vertex_count(), std::move(couplings));
    mass.bind(pattern);
    elasticity->bind(pattern);
    H = std::make_unique<BlockSparse>(pattern);
    H->set_zero();
    mass.add_to(1, *H);
    elasticity->add_hessian(x, bench::kTimeStep * bench::kTimeStep, {Definiteness::exact}, *H);
  }
};

// Processor time of all threads for one tet, block, or call.
void report(benchmark::State& state, double items) {
  using benchmark::Counter;
  state.counters["per_item"] = Counter(items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void value(benchmark::State& state, const std::string& material) {
  const Beam beam(material);
  for (auto _ : state) benchmark::DoNotOptimize(beam.elasticity->value(beam.x));
  report(state, beam.mesh.tet_count());
}

void gradient(benchmark::State& state, const std::string& material) {
  const Beam beam(material);
  std::vector<double> g(beam.x.size());
  for (auto _ : state) beam.elasticity->add_gradient(beam.x, 1, g);
  report(state, beam.mesh.tet_count());
}

void hessian(benchmark::State& state, const std::string& material, Definiteness definiteness) {
  Beam beam(material);
  for (auto _ : state) beam.elasticity->add_hessian(beam.x, 1e-4, {definiteness}, *beam.H);
  report(state, beam.mesh.tet_count());
}

void block_product(benchmark::State& state) {
  const Beam beam("neo_hookean_log");
  std::vector<double> y(beam.x.size());
  for (auto _ : state) beam.H->multiply(beam.x, y);
  report(state, static_cast<double>(beam.pattern.block_count()));
}

void analysis(benchmark::State& state) {
  const Beam beam("neo_hookean_log");
  for (auto _ : state) make_linear_solver("cholesky")->analyze(beam.pattern);
  report(state, 1);
}

void factorisation(benchmark::State& state) {
  const Beam beam("neo_hookean_log");
  const auto solver = make_linear_solver("cholesky");
  solver->analyze(beam.pattern);
  for (auto _ : state) {
    if (!solver->factorize(*beam.H)) throw std::runtime_error("the matrix is not positive definite");
  }
  report(state, 1);
}

void triangular_solve(benchmark::State& state) {
  const Beam beam("neo_hookean_log");
  const auto solver = make_linear_solver("cholesky");
  solver->analyze(beam.pattern);
  if (!solver->factorize(*beam.H)) throw std::runtime_error("the matrix is not positive definite");
  std::vector<double> y(beam.x.size());
  for (auto _ : state) solver->solve(beam.x, y, 1e-10);
  report(state, 1);
}

}  // namespace

int main(int argc, char** argv) {
  const auto add = [](const std::string& name, const auto& function, const auto&... arguments) {
    benchmark::RegisterBenchmark(name.c_str(), function, arguments...)
        ->Unit(benchmark::kMillisecond)
        ->MeasureProcessCPUTime();
  };
  for (const MaterialInfo& material : materials()) {
    const std::string& name = material.name;
    add("value/" + name, value, name);
    add("gradient/" + name, gradient, name);
    add("hessian/" + name, hessian, name, Definiteness::exact);
    add("clamped_hessian/" + name, hessian, name, Definiteness::clamped);
  }
  add("block_product", block_product);
  add("cholesky/analysis", analysis);
  add("cholesky/factorisation", factorisation);
  add("cholesky/solve", triangular_solve);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
