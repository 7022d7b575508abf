// Aspic and the obvious program on the same beam: one line each, their ratio, and whether the displacement of the tip
// is the known one. usage: bench_beam [n...]
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "bench/beam_problem.h"
#include "bench/stopwatch.h"
#include "dynamics/simulation.h"
#include "energy/linear_load.h"

namespace aspic::bench {
namespace {

constexpr int kLargestNaive = 7;  // n = 14 takes the obvious program minutes

struct Reference {
  int n;
  double displacement;  // [m]
};
constexpr std::array<Reference, 2> kReferences = {{{7, -0.0539775432}, {14, -0.0539697485}}};
constexpr double kAllowed = 1e-8;  // [m]

Model make_model(int n) {
  Model model;
  model.mesh = make_beam(n);
  const TetMesh& mesh = model.mesh;
  model.bodies = {{"beam", 0, mesh.vertex_count(), 0, mesh.tet_count()}};
  model.density.assign(mesh.tet_count(), kDensity);
  model.mass = std::make_unique<MassMatrix>(mesh, model.density, MassKind::consistent);

  const MaterialParameters parameters{.lame = lame_from_young_poisson(kYoung, kPoisson)};
  model.elasticity.push_back(
      make_tet_elasticity("neo_hookean_log", mesh, 0, std::vector<MaterialParameters>(mesh.tet_count(), parameters)));

  std::vector<double> weight(3 * mesh.vertex_count());
  for (int t = 0; t < mesh.tet_count(); ++t) add_body_force(mesh, t, {0, kDensity * kGravity, 0}, weight);
  model.loads.push_back(make_linear_load("gravity", std::move(weight)));

  Pin& clamp = model.pins.emplace_back();
  clamp.name = "clamp";
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    if (is_clamped(mesh, i)) clamp.vertices.push_back(i);
  }
  return model;
}

State at_rest(const TetMesh& mesh) {
  State state;
  for (const Vec3d& X : mesh.rest) state.q.insert(state.q.end(), {X[0], X[1], X[2]});
  state.qdot.assign(state.q.size(), 0.0);
  return state;
}

void print(const char* program, int n, const TetMesh& mesh, const BeamResult& result) {
  std::printf("%-8s %3d %9d %9d %10.3f %10.3f %11d   %.10f\n", program, n, mesh.vertex_count(), mesh.tet_count(),
              result.seconds, result.cpu_seconds, result.iterations, result.displacement);
  std::fflush(stdout);
}

bool is_expected(const char* program, int n, double displacement) {
  for (const Reference& reference : kReferences) {
    if (reference.n != n || std::abs(displacement - reference.displacement) <= kAllowed) continue;
    std::printf("%s is wrong for n = %d: the displacement is %.10f\n", program, n, reference.displacement);
    return false;
  }
  return true;
}

bool compare(int n) {
  const TetMesh mesh = make_beam(n);
  const BeamResult aspic = run_aspic(n);
  print("aspic", n, mesh, aspic);
  bool expected = is_expected("aspic", n, aspic.displacement);
  if (n > kLargestNaive) return expected;
  const BeamResult naive = run_naive(n);
  print("naive", n, mesh, naive);
  std::printf("aspic is %.1f times faster (%.1f times by processor time)\n", naive.seconds / aspic.seconds,
              naive.cpu_seconds / aspic.cpu_seconds);
  return is_expected("naive", n, naive.displacement) && expected;
}

}  // namespace

BeamResult run_aspic(int n) {
  Model model = make_model(n);
  State state = at_rest(model.mesh);
  SimulationOptions options;
  options.h = kTimeStep;
  options.solver.minimize.criterion = Criterion::first_gradient;
  options.solver.minimize.tolerance = kTolerance;

  BeamResult result;
  const Stopwatch stopwatch;
  Simulation simulation(std::move(model), std::move(state), options);
  for (int i = 0; i < kSteps; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status)) {
      std::printf("aspic: step %d ended with status %s\n", report.step, std::string(to_string(report.status)).c_str());
    }
    result.iterations += report.iterations;
  }
  result.seconds = stopwatch.seconds();
  result.cpu_seconds = stopwatch.cpu_seconds();
  result.displacement = simulation.state().q[3 * tip_vertex(n) + 1];  // y = 0 at rest
  return result;
}

}  // namespace aspic::bench

int main(int argc, char** argv) {
  std::vector<int> sizes;
  for (int i = 1; i < argc; ++i) {
    char* end = nullptr;
    const long n = std::strtol(argv[i], &end, 10);
    if (*end != '\0' || n < 1 || n > 40) {
      std::fprintf(stderr, "'%s' is not a size; usage: bench_beam [n...] with n from 1 to 40\n", argv[i]);
      return 2;
    }
    sizes.push_back(static_cast<int>(n));
  }
  if (sizes.empty()) sizes = {7};

  std::printf("%d threads for aspic, one for naive\n", aspic::thread_count());
  std::printf("%-8s %3s %9s %9s %10s %10s %11s   %s\n", "program", "n", "vertices", "tets", "wall [s]", "cpu [s]",
              "iterations", "tip y [m]");
  bool right = true;
  for (const int n : sizes) right = aspic::bench::compare(n) && right;
  return right ? 0 : 1;
}
