// Bodies of quadratic tets: iterations of Newton's method and of its linear solves if they are nearly incompressible,
// and inversion between nodes.
#include <gtest/gtest.h>

#include "dynamics/model_builder.h"
#include "dynamics/simulation.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

StepReport bent_beam(double poisson, const std::string& linear) {
  Model model = ModelBuilder(raise_order(make_box({{0, 0, 0}}, {{0.2, 0.1, 0.1}}, {6, 3, 3})))
                    .material("neo_hookean", {.young = 2e4, .poisson = poisson})
                    .density(1000)
                    .gravity({{0, -3, 0}})
                    .pin("wall", [](const Vec3d& X) { return X[0] == 0; })
                    .build();
  SimulationOptions options{.h = 1, .integrator = "quasi_static"};
  options.solver.linear = linear;
  Simulation simulation(std::move(model), options);
  const StepReport report = simulation.step();
  EXPECT_TRUE(is_success(report.status)) << poisson << ' ' << linear;
  return report;
}

TEST(NearlyIncompressible, NewtonNeedsAtMostHalfMoreIterations) {
  const int compressible = bent_beam(0.45, "cholesky").iterations;
  EXPECT_LE(bent_beam(0.499, "cholesky").iterations, 1.5 * compressible);
  EXPECT_LE(bent_beam(0.4999, "cholesky").iterations, 4 * compressible);
}

TEST(NearlyIncompressible, LinearIterationsHardlyDependOnPoissonRatio) {
  for (const double poisson : {0.49, 0.499, 0.4999}) {
    const StepReport report = bent_beam(poisson, "multigrid");
    EXPECT_LE(report.linear_iterations, 50 * report.iterations) << poisson;
    EXPECT_GT(report.cycles, 0);
  }
}

TEST(NearlyIncompressible, SolversAgreeAndStateIsReproducible) {
  const StepReport direct = bent_beam(0.499, "cholesky"), lifted = bent_beam(0.499, "multigrid");
  EXPECT_NEAR(direct.potential_total, lifted.potential_total, 1e-6 * std::abs(direct.potential_total));
  EXPECT_EQ(lifted.state_hash, bent_beam(0.499, "multigrid").state_hash);
}

// The pins move to a map with J = (1 - 5 X) (0.4 - X), positive at all nodes, by which linear tets do not invert.
TEST(QuadraticTets, InversionBetweenNodesIsNoSuccess) {
  const Vec3d corners[] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
  for (const char* material : {"neo_hookean_log", "neo_hookean"}) {
    Model model = ModelBuilder(raise_order({{std::begin(corners), std::end(corners)}, {{0, 1, 2, 3}}, {}}))
                      .material(material, {.young = 1e4, .poisson = 0.3})
                      .density(1000)
                      .pin(
                          "map", [](const Vec3d&) { return true; },
                          [](const Vec3d& X, double t) {
                            return t > 0 ? Vec3d{{X[0] - 2.5 * X[0] * X[0], X[1] * (0.4 - X[0]), X[2]}} : X;
                          })
                      .build();
    Simulation simulation(std::move(model), {.h = 1, .integrator = "quasi_static"});
    const StepReport report = simulation.step();
    EXPECT_LE(report.min_det_F, -0.05);
    EXPECT_EQ(report.status, material == std::string("neo_hookean") ? Status::converged : Status::inverted);
  }
}

}  // namespace
}  // namespace aspic
