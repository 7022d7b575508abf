// bench_kernels: kernels of a step, each compared with the machine's limits. Options: --help, and those of Google
// Benchmark, such as --benchmark_filter=hessian, which selects kernels by name.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "bench/kernel_beam.h"
#include "bench/kernel_report.h"
#include "bench/machine.h"
#include "bench/program.h"
#include "linalg/cholesky.h"
#include "linalg/conjugate_gradient.h"
#include "linalg/multigrid.h"
#include "material/registry.h"

namespace aspic::bench {
namespace {

struct Arguments {
  std::vector<int> sizes = {14}, threads = {1};
  std::vector<std::string> materials = {"neo_hookean_log"};
  double seconds = 0.05;
  int repetitions = 5;
  bool all_materials = false, quiet = false;
  std::string csv;
};

void declare(CLI::App& app, Arguments& arguments) {
  app.add_option("n", arguments.sizes, "Cells through the beam: 14 has 12 825 vertices, 28 has 95 033")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--threads", arguments.threads, "Numbers of threads, separated by commas")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--material", arguments.materials)->delimiter(',')->capture_default_str();
  app.add_flag("--all-materials", arguments.all_materials,
               "Run all materials, for the first size and number of threads");
  app.add_option("--seconds", arguments.seconds, "Minimum duration of each repetition [s]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--repetitions", arguments.repetitions, "Number of repetitions; the median is reported")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--csv", arguments.csv, "CSV file to write the results to");
  app.add_flag("--quiet", arguments.quiet, "Omit the description of the machine");
}

// Data that all benchmarks of one size and number of threads share.
struct Place {
  int n = 14, threads = 1;

  KernelBeam& beam(const std::string& material) const {
    set_thread_count(threads);
    return kernel_beam(n, material);
  }
  KernelFacts facts(const KernelWork& work, double items) const { return {n, threads, work, items}; }
};

constexpr char kMaterialOfMatrices[] = "neo_hookean_log";

class Registry {
 public:
  Registry(const Arguments& arguments, Place place) : arguments_(arguments), place_(place) {}

  void add_elements(const std::string& material) const;
  void add_vectors() const;
  void add_matrix() const;
  void add_cholesky() const;
  void add_multigrid() const;

 private:
  // fn(state, beam) runs the loop and returns its work and items.
  using Kernel = std::function<KernelFacts(benchmark::State&, KernelBeam&)>;
  void add(const std::string& name, const std::string& material, const Kernel& fn) const {
    const Place place = place_;
    const std::string unique = name + "@" + std::to_string(place.n) + "x" + std::to_string(place.threads);
    benchmark::RegisterBenchmark(unique.c_str(),
                                 [=](benchmark::State& state) { report(state, fn(state, place.beam(material))); })
        ->MeasureProcessCPUTime()
        ->MinTime(arguments_.seconds)
        ->Repetitions(arguments_.repetitions);
  }

  const Arguments& arguments_;
  Place place_;
};

void Registry::add_elements(const std::string& material) const {
  const Place place = place_;
  add("value/" + material, material, [=](benchmark::State& state, KernelBeam& beam) {
    for (auto _ : state) benchmark::DoNotOptimize(beam.elasticity->value(beam.x));
    return place.facts(kernel_work::value(beam, material), beam.tets());
  });
  add("gradient/" + material, material, [=](benchmark::State& state, KernelBeam& beam) {
    std::vector<double> g(beam.x.size());
    for (auto _ : state) beam.elasticity->add_gradient(beam.x, 1, g);
    return place.facts(kernel_work::gradient(beam, material), beam.tets());
  });
  for (const auto kind : {Definiteness::exact, Definiteness::clamped}) {
    const bool clamped = kind == Definiteness::clamped;
    add((clamped ? "clamped_hessian/" : "hessian/") + material, material,
        [=](benchmark::State& state, KernelBeam& beam) {
          BlockSparse H(beam.pattern);
          for (auto _ : state) beam.elasticity->add_hessian(beam.x, 1e-4, {kind}, H);
          return place.facts(kernel_work::hessian(beam, material, clamped), beam.tets());
        });
  }
}

// Like the minimizer: in chunks, with sums in the order of the chunks.
void Registry::add_vectors() const {
  const Place place = place_;
  add("dot", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    const std::vector<double>& x = beam.x;
    const std::vector<double> y(x.size(), 0.5);
    for (auto _ : state) {
      benchmark::DoNotOptimize(parallel_sum(static_cast<int>(x.size()), [&](int first, int last) {
        double sum = 0;
        for (int i = first; i < last; ++i) sum += x[i] * y[i];
        return sum;
      }));
    }
    const double size = static_cast<double>(x.size());
    return place.facts(kernel_work::dot(size), size);
  });
  add("axpy", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    const std::vector<double>& x = beam.x;
    std::vector<double> y(x.size(), 0.5);
    for (auto _ : state) {
      parallel_chunks(static_cast<int>(x.size()), [&](int first, int last) {
        for (int i = first; i < last; ++i) y[i] += 1e-3 * x[i];
      });
      benchmark::ClobberMemory();
    }
    const double size = static_cast<double>(x.size());
    return place.facts(kernel_work::axpy(size), size);
  });
}

void Registry::add_matrix() const {
  const Place place = place_;
  add("block_product", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    std::vector<double> y(beam.x.size());
    for (auto _ : state) beam.H->multiply(beam.x, y);
    return place.facts(kernel_work::block_product(beam), beam.blocks());
  });
  add("conjugate_gradient/iteration", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    constexpr int kIterations = 20;
    ConjugateGradient solver(kIterations);
    solver.analyze(beam.pattern);
    if (!solver.factorize(*beam.H)) state.SkipWithError("a diagonal block is not positive definite");
    std::vector<double> y(beam.x.size());
    double products = 1;
    for (auto _ : state) products = solver.solve(beam.x, y, 1e-300).products;
    KernelFacts facts = place.facts(kernel_work::preconditioned_iteration(beam), beam.vertices());
    facts.repeats = products;
    return facts;
  });
}

void Registry::add_cholesky() const {
  const Place place = place_;
  constexpr double kMaxFlops = 2e11;  // more than ten seconds, too long for a benchmark
  const auto prepared = [=](benchmark::State& state, KernelBeam& beam, Cholesky& solver) {
    solver.analyze(beam.pattern);
    if (solver.analysis().flops > kMaxFlops) state.SkipWithError("omitted: the factorization takes too long");
    return solver.analysis().flops <= kMaxFlops;
  };
  add("cholesky/analysis", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    for (auto _ : state) Cholesky().analyze(beam.pattern);
    return place.facts({}, beam.vertices());
  });
  add("cholesky/factorization", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    Cholesky solver;
    if (!prepared(state, beam, solver)) return place.facts({}, 1);
    for (auto _ : state)
      if (!solver.factorize(*beam.H)) state.SkipWithError("the matrix is not positive definite");
    const double entries = static_cast<double>(solver.analysis().nnz);
    return place.facts({beam.blocks() * 72 + 2 * 8 * entries, solver.analysis().flops}, beam.vertices());
  });
  add("cholesky/solve", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    Cholesky solver;
    if (!prepared(state, beam, solver)) return place.facts({}, 1);
    if (!solver.factorize(*beam.H)) state.SkipWithError("the matrix is not positive definite");
    std::vector<double> y(beam.x.size());
    for (auto _ : state) solver.solve(beam.x, y, 1e-10);
    const double entries = static_cast<double>(solver.analysis().nnz);  // L is read forward and backward
    return place.facts({2 * 8 * entries, 4 * entries}, beam.vertices());
  });
}

void Registry::add_multigrid() const {
  const Place place = place_;
  const auto made = [](benchmark::State& state, KernelBeam& beam, Multigrid& multigrid) {
    multigrid.analyze(beam.pattern);
    if (!multigrid.factorize(*beam.H)) state.SkipWithError("the matrix is not positive definite");
  };
  add("multigrid/hierarchy and set-up", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    for (auto _ : state) {
      Multigrid multigrid;
      made(state, beam, multigrid);
    }
    return place.facts({}, beam.vertices());
  });
  add("multigrid/set-up", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    Multigrid multigrid;
    made(state, beam, multigrid);
    for (auto _ : state) multigrid.factorize(*beam.H);
    return place.facts({}, beam.vertices());
  });
  add("multigrid/cycle", kMaterialOfMatrices, [=](benchmark::State& state, KernelBeam& beam) {
    Multigrid multigrid;
    made(state, beam, multigrid);
    std::vector<double> y(beam.x.size());
    for (auto _ : state) multigrid.apply(beam.x, y);
    return place.facts(kernel_work::finest_cycle(beam), beam.vertices());
  });
}

std::vector<std::string> names_of_materials() {
  std::vector<std::string> names;
  for (const MaterialInfo& material : materials()) names.push_back(material.name);
  return names;
}

void register_all(const Arguments& arguments) {
  const std::vector<std::string> all_materials = arguments.all_materials ? names_of_materials() : arguments.materials;
  for (const int n : arguments.sizes)
    for (const int threads : arguments.threads) {
      const Registry registry(arguments, {n, threads});
      const bool first = n == arguments.sizes.front() && threads == arguments.threads.front();
      for (const std::string& material : first ? all_materials : arguments.materials) registry.add_elements(material);
      registry.add_vectors();
      registry.add_matrix();
      registry.add_cholesky();
      registry.add_multigrid();
    }
}

int run(const Arguments& arguments) {
  if (!arguments.quiet) print_facts(machine_facts());
  std::printf("\nEach number is a median; in CPU time for one thread, in wall time for more.\n");
  std::map<int, Roofline> rooflines;
  Results results("kernels");
  for (const int threads : arguments.threads) {
    const Roofline& roofline = rooflines[threads] = measure_roofline(threads);
    print(roofline);
    results.begin("machine", threads);
    results.add("peak", 1e-9 * roofline.flops_per_second, "Gflop/s");
    for (const Bandwidth& b : roofline.bandwidth) {
      results.add("triad on " + std::to_string(static_cast<int>(1e-3 * b.footprint)) + " kB", 1e-9 * b.bytes_per_second,
                  "GB/s");
    }
  }
  for (const std::string& material : arguments.materials) material_info(material);  // throws for an unknown name
  register_all(arguments);
  KernelReport report(std::move(rooflines), results);
  benchmark::RunSpecifiedBenchmarks(&report);
  results.write(arguments.csv);
  return 0;
}

}  // namespace
}  // namespace aspic::bench

int main(int argc, char** argv) {
  CLI::App app("Compares the kernels of a step with the limits of the machine.", "bench_kernels");
  app.footer("Options of Google Benchmark are accepted, too: --benchmark_filter=hessian selects kernels by name.");
  aspic::bench::Arguments arguments;
  aspic::bench::declare(app, arguments);
  app.allow_extras();
  return aspic::bench::run_program(app, argc, argv, [&] {
    std::vector<std::string> rest = app.remaining();  // options of Google Benchmark
    std::vector<char*> words = {argv[0]};
    for (std::string& word : rest) words.push_back(word.data());
    int count = static_cast<int>(words.size());
    benchmark::Initialize(&count, words.data());
    if (benchmark::ReportUnrecognizedArguments(count, words.data())) return 2;
    return aspic::bench::run(arguments);
  });
}
