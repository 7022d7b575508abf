#include "contact/friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kCreep = 1e-2, kStep = 0.1, kWidth = kCreep * kStep;

// A triangle half a reach above the plane z = 0, moved along it since the start of the step.
struct Sliding {
  std::vector<double> x = {0, 0, 5e-3, 1, 0, 5e-3, 0, 1, 5e-3}, start = x;
  std::unique_ptr<Barrier> barrier;
  std::unique_ptr<Friction> friction;
  std::unique_ptr<Energy::Context> context;
  BlockPattern pattern = make_pattern(3, {});
  BlockSparse H{pattern};

  Sliding(double along_x, double along_y) {
    ContactMesh mesh;
    mesh.add({.name = "body", .young = 1e5, .friction = 0.5}, std::vector<Vec3d>{point(x, 0), point(x, 1), point(x, 2)},
             std::vector<Triangle>{{0, 1, 2}}, std::vector<int>{0, 1, 2});
    mesh.add_plane({.name = "floor", .friction = 0.5}, {}, {{0, 0, 1}});
    barrier = std::make_unique<Barrier>(std::move(mesh), ContactOptions{.reach = 1e-2});
    friction = std::make_unique<Friction>(*barrier, kCreep);
    context = friction->make_context();
    friction->begin_step({.start = start, .h = kStep, .time = kStep}, *context);
    for (size_t k = 0; k < x.size(); k += 3) x[k] += along_x, x[k + 1] += along_y;
  }
  double value(const std::vector<double>& at) const { return friction->value(at, *context); }
  std::vector<double> gradient(const std::vector<double>& at) const {
    std::vector<double> g(at.size());
    friction->add_gradient(at, *context, 1, g);
    return g;
  }
  std::vector<double> hessian_times(const std::vector<double>& v) const {
    std::vector<double> Hv(v.size());
    H.multiply(v, Hv);
    return Hv;
  }
};

const std::vector<double> kDirection = {0.3, -0.7, 0.2, 0.5, 0.1, -0.4, -0.6, 0.9, 0.8};

TEST(Friction, DerivativesMatchDifferences) {
  for (const double moved : {0.0, 0.3 * kWidth, 0.9 * kWidth, 20 * kWidth}) {
    Sliding at(moved, moved / 3);
    at.friction->add_hessian(at.x, *at.context, 1, {}, at.H);
    const double e = 1e-4 * kWidth;
    std::vector<double> high = at.x, low = at.x;
    add_scaled(e, kDirection, high);
    add_scaled(-e, kDirection, low);
    const double slope = dot(at.gradient(at.x), kDirection), difference = (at.value(high) - at.value(low)) / (2 * e);
    const double size = norm(at.gradient({high}));
    EXPECT_NEAR(slope, difference, 1e-6 * size) << moved;
    const std::vector<double> Hv = at.hessian_times(kDirection), g_high = at.gradient(high), g_low = at.gradient(low);
    for (size_t i = 0; i < Hv.size(); ++i)
      EXPECT_NEAR(Hv[i], (g_high[i] - g_low[i]) / (2 * e), 1e-3 * max_abs(Hv)) << moved << ' ' << i;
  }
}

// Coulomb's law: while everything slides, the force is mu times the normal force.
TEST(Friction, SlidingForceIsThatOfCoulomb) {
  const Sliding at(0.1, 0);
  std::vector<double> normal(9);
  at.barrier->add_gradient(at.start, {}, 1, normal);
  const std::vector<double> g = at.gradient(at.x);
  for (size_t k = 0; k < 9; k += 3) {
    EXPECT_LT(normal[k + 2], 0);
    EXPECT_NEAR(g[k], -0.5 * normal[k + 2], 1e-12 * std::abs(normal[k + 2]));
  }
}

// The model with stops is that of stuck surfaces, whose force is zero where the step began.
TEST(Friction, DirectionsBackwardStick) {
  const double moved = 20 * kWidth;
  Sliding at(moved, 0);
  at.friction->add_hessian(at.x, *at.context, 1, {}, at.H);
  std::vector<double> g = at.gradient(at.x), forward(9), backward(9), home(9);
  for (size_t k = 0; k < 9; k += 3) forward[k] = moved, backward[k] = -3 * moved, home[k] = -moved;
  EXPECT_EQ(at.friction->add_stops(at.x, *at.context, forward, 1, g, at.H), 0);
  EXPECT_EQ(at.friction->add_stops(at.x, *at.context, home, 1, g, at.H), 0);
  const double size = max_abs(g);
  EXPECT_EQ(at.friction->add_stops(at.x, *at.context, backward, 1, g, at.H), 3);
  std::vector<double> model = at.hessian_times(home);
  add_scaled(1, g, model);
  EXPECT_LT(max_abs(model), 1e-12 * size);
}

}  // namespace
}  // namespace aspic
