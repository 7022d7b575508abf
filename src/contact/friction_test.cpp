#include "contact/friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kCreep = 1e-2, kStep = 0.1, kWidth = kCreep * kStep;

// A body, and friction with a part below it.
struct Sliding {
  std::vector<double> x, start = x;
  std::unique_ptr<Barrier> barrier;
  std::unique_ptr<Friction> friction;
  std::unique_ptr<Energy::Context> context;
  std::unique_ptr<BlockPattern> pattern =
      std::make_unique<BlockPattern>(make_pattern(static_cast<int>(x.size() / 3), {}));
  BlockSparse H{*pattern};

  Sliding(const std::vector<double>& positions, ContactMesh mesh) : x(positions) {
    barrier = std::make_unique<Barrier>(std::move(mesh), ContactOptions{.reach = 1e-2});
    friction = std::make_unique<Friction>(*barrier, kCreep);
    context = friction->make_context();
    begin_step(*context);
  }
  void begin_step(Energy::Context& own) const {
    friction->begin_step({.start = start, .h = kStep, .time = kStep}, own);
  }
  double value(const std::vector<double>& at) const { return friction->value(at, *context); }
  std::vector<double> gradient(const std::vector<double>& at) const { return gradient(at, *context); }
  std::vector<double> gradient(const std::vector<double>& at, const Energy::Context& own) const {
    std::vector<double> g(at.size());
    friction->add_gradient(at, own, 1, g);
    return g;
  }
  std::vector<double> hessian_times(const std::vector<double>& v) const {
    std::vector<double> Hv(v.size());
    H.multiply(v, Hv);
    return Hv;
  }
};

ContactPart part(const char* name) { return {.name = name, .young = 1e5, .friction = 0.5}; }

// A triangle half a reach above the plane z = 0, moved along it since the start of the step.
Sliding over_plane(double along_x, double along_y) {
  const std::vector<double> x = {0, 0, 5e-3, 1, 0, 5e-3, 0, 1, 5e-3};
  ContactMesh mesh;
  mesh.add(part("body"), std::vector<Vec3d>{point(x, 0), point(x, 1), point(x, 2)}, std::vector<Triangle>{{0, 1, 2}},
           std::vector<int>{0, 1, 2});
  mesh.add_plane(part("floor"), {}, {{0, 0, 1}});
  Sliding at(x, std::move(mesh));
  for (size_t k = 0; k < x.size(); k += 3) at.x[k] += along_x, at.x[k + 1] += along_y;
  return at;
}

// The tip of a triangle within the reach of both faces of a concave crease, moved since the start of the step.
Sliding over_crease(double along_x, double along_y) {
  const std::vector<double> x = {1e-3, 0,  8e-3, -0.5, 0.3, 2, 0.5, 0.3, 2,  // the triangle
                                 0,    -1, 0,    0,    1,   0, -1,  0,   0.5, 1, 0, 0.5};
  std::vector<Vec3d> X;
  for (int i = 0; i < 7; ++i) X.push_back(point(x, i));
  ContactMesh mesh;
  mesh.add(part("tip"), std::span(X).first(3), std::vector<Triangle>{{0, 1, 2}}, std::vector<int>{0, 1, 2});
  mesh.add(part("crease"), std::span(X).last(4), std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}},
           std::vector<int>{3, 4, 5, 6});
  Sliding at(x, std::move(mesh));
  at.x[0] += along_x, at.x[1] += along_y;
  return at;
}

void expect_derivatives(Sliding at) {
  at.friction->add_hessian(at.x, *at.context, 1, {}, at.H);
  std::vector<double> direction(at.x.size()), high = at.x, low = at.x;
  for (size_t i = 0; i < direction.size(); ++i) direction[i] = std::sin(3.0 * static_cast<double>(i + 1));
  const double e = 1e-4 * kWidth;
  add_scaled(e, direction, high);
  add_scaled(-e, direction, low);
  const double slope = dot(at.gradient(at.x), direction), difference = (at.value(high) - at.value(low)) / (2 * e);
  const double size = norm(at.gradient(high));
  EXPECT_GT(size, 0);
  EXPECT_NEAR(slope, difference, 1e-6 * size);
  const std::vector<double> Hv = at.hessian_times(direction), g_high = at.gradient(high), g_low = at.gradient(low);
  for (size_t i = 0; i < Hv.size(); ++i) EXPECT_NEAR(Hv[i], (g_high[i] - g_low[i]) / (2 * e), 1e-3 * max_abs(Hv)) << i;
}

TEST(Friction, DerivativesMatchDifferences) {
  for (const double moved : {0.0, 0.3 * kWidth, 0.9 * kWidth, 20 * kWidth}) {
    SCOPED_TRACE(moved);
    expect_derivatives(over_plane(moved, moved / 3));
    expect_derivatives(over_crease(moved / 3, moved));
  }
}

// Both faces share the force on the tip, so four vertices of the crease balance it.
TEST(Friction, CreaseFacesShareForce) {
  const Sliding at = over_crease(0, 20 * kWidth);
  const std::vector<double> g = at.gradient(at.x);
  EXPECT_GT(g[1], 0);
  for (size_t r = 0; r < 3; ++r) {
    double sum = 0;
    for (size_t k = r; k < g.size(); k += 3) sum += g[k];
    EXPECT_NEAR(sum, 0, 1e-12 * g[1]);
  }
  for (const size_t vertex : {3, 4, 5, 6}) EXPECT_NE(g[3 * vertex + 1], 0) << vertex;
}

// The start of BDF2 is extrapolated from two steps, and so are the positions of moving obstacles there.
TEST(Friction, BodyMovesWithObstacleFromExtrapolatedStart) {
  const Vec3d velocity{{0.2, 0.1, 0}};
  ContactPart belt = part("belt");
  belt.motion = [velocity](double t, std::span<const Vec3d> start, std::span<Vec3d> x) {
    for (size_t i = 0; i < x.size(); ++i) x[i] = start[i] + t * velocity;
  };
  const std::vector<double> x = {0, 0, 5e-3, 1, 0, 5e-3, 0, 1, 5e-3};
  ContactMesh mesh;
  mesh.add(part("body"), std::vector<Vec3d>{point(x, 0), point(x, 1), point(x, 2)}, std::vector<Triangle>{{0, 1, 2}},
           std::vector<int>{0, 1, 2});
  mesh.add_plane(belt, {}, {{0, 0, 1}});
  const Sliding at(x, std::move(mesh));
  const auto carried = [&](double t) {
    std::vector<double> moved = x;
    for (size_t i = 0; i < x.size(); ++i) moved[i] += t * velocity[static_cast<int>(i % 3)];
    return moved;
  };
  const std::vector<double> start = carried(4 * kStep / 3), now = carried(kStep);
  StepContext step{.start = start, .h = 2 * kStep / 3, .time = 2 * kStep, .shape = now, .obstacle_time = kStep};
  at.friction->begin_step(step, *at.context);
  EXPECT_GT(max_abs(at.gradient(carried(2 * kStep))), 0);
  step.obstacle_before = 0;
  at.friction->begin_step(step, *at.context);
  const double sliding = max_abs(at.gradient(now));
  EXPECT_LT(max_abs(at.gradient(carried(2 * kStep))), 1e-9 * sliding);
}

// A resumed run starts with a new context and must yield the same result.
TEST(Friction, StepIsIndependentOfPreviousStep) {
  const Sliding at = over_crease(2e-4, 20 * kWidth);
  std::vector<double> aside = at.start;
  aside[0] += 1e-3;
  for (int update = 0; update < 8; ++update) at.friction->update_lagged(aside, false, *at.context);
  at.begin_step(*at.context);
  const auto fresh = at.friction->make_context();
  at.begin_step(*fresh);
  EXPECT_EQ(at.gradient(at.x), at.gradient(at.x, *fresh));
}

TEST(Friction, KeepsDirectionsOfKnownContacts) {
  const Sliding at = over_crease(2e-4, 20 * kWidth);
  const auto direction = [&](bool keeps_directions) {
    at.begin_step(*at.context);
    std::vector<double> aside = at.start;
    aside[0] += 1e-3;
    at.friction->update_lagged(aside, keeps_directions, *at.context);
    const std::vector<double> g = at.gradient(at.x);
    return g[2] / g[1];
  };
  at.begin_step(*at.context);
  const std::vector<double> g = at.gradient(at.x);
  EXPECT_NEAR(direction(true), g[2] / g[1], 1e-12);
  EXPECT_GT(std::abs(direction(false) - g[2] / g[1]), 1e-3);
}

// After a Newton step, updates use the linearized normal force, which differs from that at the next iterate.
TEST(Friction, PredictsNormalForcesOfNewtonStep) {
  constexpr double kAlpha = 0.5;
  const Sliding at = over_plane(20 * kWidth, 0);
  std::vector<double> d(at.x.size());
  for (size_t k = 2; k < d.size(); k += 3) d[k] = 2e-3;
  const auto force = [&](double part) {  // of friction, with normal forces at x + part d
    std::vector<double> lifted = at.x;
    for (size_t i = 0; i < d.size(); ++i) lifted[i] += part * d[i];
    at.friction->update_lagged(lifted, false, *at.context);
    return at.gradient(at.x)[0];
  };
  constexpr double kStepSize = 1e-4;
  const double linear = force(0) + kAlpha * (force(kStepSize) - force(-kStepSize)) / (2 * kStepSize);
  const double next = force(kAlpha);
  at.friction->note_newton_step(at.x, d, kAlpha, *at.context);
  EXPECT_NEAR(force(kAlpha), linear, 1e-6 * linear);
  EXPECT_GT(std::abs(next - linear), 0.05 * next);
  at.friction->note_newton_step({}, {}, 0, *at.context);
  EXPECT_EQ(force(kAlpha), next);
}

// The second of two opposite updates is halved, also where contacts vanish.
TEST(Friction, RelaxesAlternatingForces) {
  for (const double lift : {1e-3, 1.0}) {
    SCOPED_TRACE(lift);
    const Sliding at = over_plane(20 * kWidth, 0);
    std::vector<double> lifted = at.start;
    for (size_t k = 2; k < lifted.size(); k += 3) lifted[k] += lift;
    at.friction->update_lagged(lifted, false, *at.context);
    const std::vector<double> low = at.gradient(at.x);
    EXPECT_FALSE(at.friction->relax_lagged(*at.context));
    at.friction->update_lagged(at.start, false, *at.context);
    const std::vector<double> high = at.gradient(at.x);
    at.friction->update_lagged(lifted, false, *at.context);
    EXPECT_TRUE(at.friction->relax_lagged(*at.context));
    const std::vector<double> relaxed = at.gradient(at.x);
    std::vector<double> change(at.x.size());
    at.friction->add_change(at.x, *at.context, change);
    for (size_t i = 0; i < relaxed.size(); ++i) {
      EXPECT_NEAR(relaxed[i], (low[i] + high[i]) / 2, 1e-12 * max_abs(high)) << i;
      EXPECT_NEAR(change[i], low[i] - high[i], 1e-12 * max_abs(high)) << i;
    }
  }
}

// The second of two updates in one direction is extended to the limit of the geometric series.
TEST(Friction, ExtrapolatesRepeatingForces) {
  const Sliding at = over_plane(20 * kWidth, 0);
  std::vector<std::vector<double>> force = {at.gradient(at.x)};
  for (const double lift : {1e-4, 1.9e-4}) {
    std::vector<double> lifted = at.start;
    for (size_t k = 2; k < lifted.size(); k += 3) lifted[k] += lift;
    at.friction->update_lagged(lifted, false, *at.context);
    force.push_back(at.gradient(at.x));
  }
  EXPECT_TRUE(at.friction->relax_lagged(*at.context));
  const std::vector<double> extrapolated = at.gradient(at.x);
  const double first = force[1][0] - force[0][0], second = force[2][0] - force[1][0];
  const double limit = force[1][0] + second / (1 - second / first);
  EXPECT_NEAR(extrapolated[0], std::max(limit, 0.0), 1e-9 * force[0][0]);
  EXPECT_LT(extrapolated[0], 0.9 * force[2][0]);
}

// Coulomb friction: while all contacts slide, the force is mu times the normal force.
TEST(Friction, SlidingForceMatchesCoulomb) {
  const Sliding at = over_plane(0.1, 0);
  std::vector<double> normal(9);
  at.barrier->add_gradient(at.start, {}, 1, normal);
  const std::vector<double> g = at.gradient(at.x);
  for (size_t k = 0; k < 9; k += 3) {
    EXPECT_LT(normal[k + 2], 0);
    EXPECT_NEAR(g[k], -0.5 * normal[k + 2], 1e-12 * std::abs(normal[k + 2]));
  }
}

// The model with stops is that of sticking surfaces, whose force is zero at the start of the step.
TEST(Friction, BackwardDirectionsStick) {
  const double moved = 20 * kWidth;
  Sliding at = over_plane(moved, 0);
  at.friction->add_hessian(at.x, *at.context, 1, {}, at.H);
  std::vector<double> g = at.gradient(at.x), forward(9), backward(9), home(9);
  for (size_t k = 0; k < 9; k += 3) forward[k] = moved, backward[k] = -3 * moved, home[k] = -moved;
  EXPECT_EQ(at.friction->add_stops(at.x, *at.context, forward, {1, g, at.H}), 0);
  EXPECT_EQ(at.friction->add_stops(at.x, *at.context, home, {1, g, at.H}), 0);
  const double size = max_abs(g);
  EXPECT_EQ(at.friction->add_stops(at.x, *at.context, backward, {1, g, at.H}), 3);
  std::vector<double> model = at.hessian_times(home);
  add_scaled(1, g, model);
  EXPECT_LT(max_abs(model), 1e-12 * size);
}

}  // namespace
}  // namespace aspic
