// Friction of indenters: derivatives of its forces, and its limits.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "dynamics/step_derivatives.h"
#include "indenter/probe_friction.h"
#include "math/vectors.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "mesh/vertices.h"
#include "model/load_case.h"
#include "model/misfit.h"

namespace aspic {
namespace {

constexpr double kPlateSide = 0.04, kPlateHeight = 0.03, kPlateYoung = 2e4;

// A block on z = 0 under a plate that covers it and moves down and along x.
Experiment covered_block(IndenterContact contact, double friction) {
  Experiment e;
  e.mesh = make_box({{0, 0, 0}}, {{kPlateSide, kPlateSide, kPlateHeight}}, {3, 3, 3});
  e.density.assign(e.mesh.tets.size(), 1000);
  for (int v = 0; v < e.mesh.vertex_count(); ++v)
    if (e.mesh.rest[v][2] < 1e-9) e.fixed.push_back(v);
  LoadCase load{.name = "slide", .group = "slide"};
  load.indenter = Indenter{IndenterShape::disc, contact, kPlateSide, 1e9, friction};
  load.touch = {.center = {{kPlateSide / 2, kPlateSide / 2, kPlateHeight}}};
  load.pose = load.touch;
  load.pose.center = load.pose.center + Vec3d{{1e-3, 0, -1.5e-3}};
  load.force = Vec3d{};
  load.force_sigma = {{1, 1, 1}};
  e.cases.push_back(std::move(load));
  return e;
}

CasePrediction covered_prediction(const Experiment& e) {
  const std::vector<MaterialParameters> material(e.mesh.tets.size(), {lame_from_young_poisson(kPlateYoung, 0.45), {}});
  LoadedBody body(e, e.cases[0], "neo_hookean", material, {});
  EXPECT_TRUE(body.solve(material, {})) << body.failure();
  return body.prediction();
}

TEST(IndenterFriction, DerivativesOfForcesMatchDifferences) {
  for (const IndenterShape shape : {IndenterShape::disc, IndenterShape::sphere}) {
    Experiment e = covered_block(IndenterContact::sliding, 0.4);
    LoadCase& load = e.cases[0];
    load.indenter->shape = shape;
    if (shape == IndenterShape::sphere) load.touch.center[2] += kPlateSide, load.pose.center[2] += kPlateSide;
    load.pose.rotation = {{0, 0, 0.02}};
    const auto probe = make_probe_of(e, load);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1e-5, 1e-5);  // some points stick
    std::vector<double> x = rest_positions(e.mesh), dx(x.size()), product(x.size());
    for (double& d : dx) d = uniform(random);
    for (double& xi : x) xi += uniform(random);
    Couplings couplings;
    probe->add_couplings(couplings);
    const BlockPattern pattern = make_pattern(e.mesh.vertex_count(), std::move(couplings));
    ProbeFriction friction(e.mesh, *probe, *load.indenter, load.touch);
    friction.bind(pattern);
    const ActiveTerm term(friction, {.start = x});
    const DerivativeReport report = check_derivatives(differentiable(term, pattern), x, {.length = 1e-6});
    EXPECT_TRUE(report.gradient.passed && report.hessian.passed) << report.gradient.smallest_error;

    // The derivative of the friction is the Hessian with lagged coefficients and the derivative by these.
    BlockSparse H(pattern);
    H.set_zero();
    term.add_hessian(x, 1, {Definiteness::exact}, H);
    H.multiply(dx, product);
    friction.add_lagged_product(x, dx, 1, product);
    const auto forces = [&](double eps) {
      std::vector<double> at = x, q(x.size());
      add_scaled(eps, dx, at);
      friction.add_friction(at, 1, q);
      return q;
    };
    const double step = 1e-4;
    std::vector<double> slope = forces(step), gradient(x.size());
    add_scaled(-1, forces(-step), slope);
    for (double& s : slope) s /= 2 * step;
    const double size = norm(slope);
    add_scaled(-1, product, slope);
    EXPECT_LT(norm(slope), 1e-4 * size);
    term.add_gradient(x, 1, gradient);
    add_scaled(-1, forces(0), gradient);
    EXPECT_LT(norm(gradient), 1e-12 * norm(forces(0))) << "lagged coefficients of the same x";
  }
}

TEST(IndenterFriction, ForcesObeyCoulombsLaw) {
  Experiment e = covered_block(IndenterContact::sliding, 0.1);
  e.cases[0].pose.center = e.cases[0].touch.center + Vec3d{{5e-3, 0, -5e-4}};
  const Vec3d force = covered_prediction(e).wrench.force;
  EXPECT_NEAR(force[0], -0.1 * force[2], 0.02 * force[0]) << "the whole face slides along x";
}

TEST(IndenterFriction, LimitsAreFrictionlessAndBonded) {
  const Vec3d smooth = covered_prediction(covered_block(IndenterContact::sliding, 0)).wrench.force;
  const Vec3d little = covered_prediction(covered_block(IndenterContact::sliding, 1e-4)).wrench.force;
  EXPECT_LT(norm(little - smooth), 3e-4 * norm(smooth));
  const Vec3d bonded = covered_prediction(covered_block(IndenterContact::bonded, 0)).wrench.force;
  EXPECT_GT(norm(bonded - smooth), 0.1 * norm(bonded));
  const Vec3d rough = covered_prediction(covered_block(IndenterContact::sliding, 10)).wrench.force;
  EXPECT_LT(norm(rough - bonded), 0.05 * norm(bonded));
}

}  // namespace
}  // namespace aspic
