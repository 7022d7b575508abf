#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "dynamics/step_derivatives.h"
#include "energy/surface_box_test.h"
#include "indenter/indenter_depth.h"
#include "indenter/probe.h"

namespace aspic {
namespace {

// Points up at the top face z = 0.6 from inside the rest shape, 0.05 deep.
const IndenterPose kTouch = {.center = {{0.45, 0.35, 0.6 + 0.2}}, .axis = {{0, 0, -1}}, .rotation = {}};
const IndenterPose kFlatTouch = {.center = {{0.45, 0.35, 0.6}}, .axis = {{0, 0, -2}}, .rotation = {}};
const IndenterPose kPose = {.center = {{0.47, 0.34, 0.74}}, .axis = {{0.1, -0.2, -1}}, .rotation = {{0.2, -0.1, 0.3}}};
const IndenterPose kFlatPose = {
    .center = {{0.47, 0.34, 0.57}}, .axis = {{0.1, -0.05, -1}}, .rotation = {{0.2, -0.1, 0.3}}};

struct Case {
  const char* name;
  Indenter indenter;
  IndenterPose touch, pose;
};
const Case kCases[] = {
    {"bonded sphere", {IndenterShape::sphere, IndenterContact::bonded, 0.2, 50}, kTouch, kPose},
    {"bonded disc", {IndenterShape::disc, IndenterContact::bonded, 0.2, 50}, kFlatTouch, kFlatPose},
    {"sliding sphere", {IndenterShape::sphere, IndenterContact::sliding, 0.2, 50}, kTouch, kPose},
    {"sliding disc", {IndenterShape::disc, IndenterContact::sliding, 0.2, 50}, kFlatTouch, kFlatPose},
};
std::unique_ptr<Probe> probe(const Case& c) {
  auto V = make_probe(box_mesh(), box_surface(), c.indenter, c.touch);
  V->set_pose(c.pose);
  V->bind(box_pattern());
  return V;
}

TEST(Probe, DerivativesMatchDifferences) {
  for (const Case& c : kCases) {
    const auto V = probe(c);
    const std::vector<double> x = shaken_box(0.02);
    ASSERT_GT(V->touched_points(x), 10) << c.name;
    const DerivativeReport report =
        check_derivatives(differentiable(ActiveTerm(*V), box_pattern()), x, {.length = 0.02});
    EXPECT_TRUE(report.gradient.passed) << c.name << ": " << report.gradient.smallest_error;
    EXPECT_TRUE(report.hessian.passed) << c.name << ": " << report.hessian.smallest_error;
  }
}

TEST(Probe, WrenchBalancesForcesOnBody) {
  for (const Case& c : kCases) {
    const auto V = probe(c);
    const std::vector<double> x = shaken_box(0.02);
    std::vector<double> g(x.size());
    V->add_gradient(x, 1, g);
    Vec3d force{}, torque{};
    for (int v = 0; v < box_mesh().vertex_count(); ++v) {
      const Vec3d f = {{-g[3 * v], -g[3 * v + 1], -g[3 * v + 2]}};
      const Vec3d arm = Vec3d{{x[3 * v], x[3 * v + 1], x[3 * v + 2]}} - c.pose.center;
      force = force + f;
      torque = torque + cross(arm, f);
    }
    const Wrench w = V->wrench(x);
    EXPECT_GT(norm(w.force), 1e-3) << c.name;
    EXPECT_LT(norm(w.force - force), 1e-13 * norm(w.force)) << c.name;
    EXPECT_LT(norm(w.torque - torque), 1e-13 * norm(w.force)) << c.name;
  }
}

TEST(Probe, WrenchProductsAreDerivativesAndTransposes) {
  for (const Case& c : kCases) {
    const auto V = probe(c);
    const std::vector<double> x = shaken_box(0.02), dx = shaken_box(0.1, 5);
    const Wrench product = V->wrench_product(x, dx);
    const double h = 1e-6;
    std::vector<double> forth = x, back = x;
    for (size_t i = 0; i < x.size(); ++i) forth[i] += h * dx[i], back[i] -= h * dx[i];
    const Wrench a = V->wrench(forth), b = V->wrench(back);
    EXPECT_LT(norm(product.force - (0.5 / h) * (a.force - b.force)), 1e-6 * norm(product.force)) << c.name;
    EXPECT_LT(norm(product.torque - (0.5 / h) * (a.torque - b.torque)), 1e-6 * norm(product.force)) << c.name;

    const Wrench wbar = {{{0.3, -0.7, 0.2}}, {{1.1, 0.4, -0.9}}};
    std::vector<double> xbar(x.size());
    V->add_wrench_transposed(x, wbar, 3, xbar);
    const double forward = dot(wbar.force, product.force) + dot(wbar.torque, product.torque);
    const double backward = std::inner_product(xbar.begin(), xbar.end(), dx.begin(), 0.0);
    EXPECT_NEAR(backward, 3 * forward, 1e-12 * norm(product.force)) << c.name;
  }
}

TEST(Probe, BondedIndenterMovingWithBodyHasNoForce) {
  const Mat3d quarter_turn = {0, 1, 0, -1, 0, 0, 0, 0, 1};  // about z
  for (const Case& c : {kCases[0], kCases[1]}) {
    const auto V = probe(c);
    IndenterPose moved = c.touch;
    moved.center = quarter_turn * c.touch.center + Vec3d{{3, -2, 1}};
    moved.rotation = {{0, 0, std::acos(0.0)}};
    V->set_pose(moved);
    std::vector<double> x;
    for (const Vec3d& X : box_mesh().rest) {
      const Vec3d y = quarter_turn * X + Vec3d{{3, -2, 1}};
      x.insert(x.end(), {y[0], y[1], y[2]});
    }
    EXPECT_LT(V->value(x), 1e-25) << c.name;
    EXPECT_LT(norm(V->wrench(x).force), 1e-12) << c.name;
  }
}

TEST(Probe, IsInvariantUnderRigidMotions) {
  const Mat3d quarter_turn = {0, 1, 0, -1, 0, 0, 0, 0, 1};
  for (const Case& c : {kCases[2], kCases[3]}) {
    const auto V = probe(c);
    const std::vector<double> x = shaken_box(0.02);
    std::vector<double> turned(x.size());
    for (size_t i = 0; i < x.size(); i += 3)
      turned[i] = 4 - x[i + 1], turned[i + 1] = x[i], turned[i + 2] = x[i + 2] - 1;
    const double energy = V->value(x);
    const Wrench before = V->wrench(x);
    IndenterPose moved = c.pose;
    moved.center = quarter_turn * c.pose.center + Vec3d{{4, 0, -1}};
    moved.axis = quarter_turn * c.pose.axis;
    V->set_pose(moved);
    EXPECT_NEAR(V->value(turned), energy, 1e-12 * energy) << c.name;
    EXPECT_LT(norm(V->wrench(turned).force - quarter_turn * before.force), 1e-12 * norm(before.force)) << c.name;
  }
}

// On a flat face, the resultant of a small translation t is k t times the area of the footprint: pi R^2 for a disc, and
// pi a^2 with R^2 + a^2 = (R + g)^2 for a sphere, where g is halfway through the fading part of the glue.
TEST(Probe, FootprintHasAreaOfIndenter) {
  constexpr double kR = 0.2, kGap = 0.75 * kGlue * kR, kPi = 3.14159265358979;
  const double areas[] = {kPi * (2 * kR * kGap + kGap * kGap), kPi * kR * kR};
  for (int i = 0; i < 2; ++i) {
    const auto V = probe(kCases[i]);
    IndenterPose moved = kCases[i].touch;
    moved.center[0] += 0.01;
    V->set_pose(moved);
    EXPECT_NEAR(V->wrench(box_at_rest()).force[0], 50 * 0.01 * areas[i], 0.02 * 50 * 0.01 * areas[i]) << kCases[i].name;
  }
}

// On a flat face, the force is the integral over rings of k phi'(d) dd/dz, with phi' = d - e / 2 for d > e.
TEST(Probe, SlidingDiscForceGrowsWithDepth) {
  const Case& c = kCases[3];
  const auto V = probe(c);
  IndenterPose pressed = {kFlatTouch.center - Vec3d{{0, 0, 0.03}}, {{0, 0, -1}}, {}};
  V->set_pose(pressed);
  double expected = 0;
  constexpr int kRings = 2000;
  for (int i = 0; i < kRings; ++i) {
    const double r = 0.25 * (i + 0.5) / kRings, e = 0.02 * c.indenter.radius;
    const auto [d, slope, unused] = depth(c.indenter, pressed, kFlatTouch.center + Vec3d{{r, 0, 0}});
    const double stress = c.indenter.stiffness * (d < 0 ? 0 : d < e ? d * d / (2 * e) : d - e / 2);
    expected -= 2 * 3.14159265358979 * r * 0.25 / kRings * stress * slope[2];
  }
  const Wrench w = V->wrench(box_at_rest());
  EXPECT_NEAR(w.force[2], expected, 0.03 * std::abs(expected));  // points are a quarter of the radius apart
  EXPECT_NEAR(w.force[0], 0, 0.03 * std::abs(expected));
  EXPECT_GT(expected, -50 * 0.03 * 3.14159265358979 * 0.04);  // a rounded rim presses less
}

// From the air to beyond the depth e of the soft start of phi.
TEST(Probe, EnergyIsWorkOfIndentation) {
  for (const Case& c : {kCases[2], kCases[3]}) {
    const auto V = probe(c);
    const std::vector<double> x = box_at_rest();
    constexpr int kSteps = 400;
    const Vec3d down = {{0, 0, -0.02 / kSteps}};
    IndenterPose pose = {
        c.touch.center + Vec3d{{0, 0, c.indenter.shape == IndenterShape::sphere ? 0.001 : 0.0}}, {{0, 0, -1}}, {}};
    double work = 0;
    for (int i = 0; i < kSteps; ++i) {
      pose.center = pose.center + 0.5 * down;
      V->set_pose(pose);
      work += dot(V->wrench(x).force, down);
      pose.center = pose.center + 0.5 * down;
    }
    V->set_pose(pose);
    EXPECT_GT(V->value(x), 0) << c.name;
    EXPECT_NEAR(V->value(x), work, 1e-3 * work) << c.name;
  }
}

TEST(Probe, ModifiedHessiansArePositiveSemidefinite) {
  const std::vector<double> x = shaken_box(0.02);
  for (const Case& c : {kCases[2], kCases[3]}) {
    const auto V = probe(c);
    for (const Definiteness kind : {Definiteness::exact, Definiteness::clamped, Definiteness::absolute}) {
      BlockSparse H(box_pattern());
      const int projected = V->add_hessian(x, 1, {kind}, H);
      EXPECT_EQ(projected > 0, kind != Definiteness::exact) << c.name;
      double least = 0;
      std::mt19937 random(1);
      std::normal_distribution<double> normal;
      for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> d(x.size()), Hd(x.size());
        for (size_t i = 0; i < d.size(); ++i) d[i] = i % 3 == 2 ? 0 : normal(random);  // along the surface
        H.multiply(d, Hd);
        least = std::min(least, std::inner_product(d.begin(), d.end(), Hd.begin(), 0.0));
      }
      if (kind == Definiteness::exact) {
        EXPECT_LT(least, -1e-6) << c.name;
      } else {
        EXPECT_GT(least, -1e-12) << c.name;
      }
    }
  }
}

TEST(Probe, IndenterInAirHasNoForce) {
  for (const Case& c : {kCases[2], kCases[3]}) {
    const auto V = probe(c);
    IndenterPose away = c.pose;
    away.center[2] += 0.5;
    V->set_pose(away);
    EXPECT_EQ(V->touched_points(box_at_rest()), 0);
    EXPECT_EQ(V->value(box_at_rest()), 0);
  }
}

TEST(Probe, RejectsInvalidIndenters) {
  Case c = kCases[0];
  c.touch.center[2] += 1;
  EXPECT_THROW(probe(c), InvalidInput);
  for (Indenter bad : {Indenter{.radius = 0, .stiffness = 1}, Indenter{.radius = 0.1, .stiffness = 0},
                       Indenter{.radius = NAN, .stiffness = 1}, Indenter{.radius = 1e-3, .stiffness = 1}})
    EXPECT_THROW(make_probe(box_mesh(), box_surface(), bad, kTouch), InvalidInput);
  IndenterPose without_axis = kTouch;
  without_axis.axis = {};
  EXPECT_THROW(make_probe(box_mesh(), box_surface(), kCases[0].indenter, without_axis), InvalidInput);
}

TEST(Probe, RimGradientMatchesDifferences) {
  const std::vector<double> x = shaken_box(0.02);
  for (const double rim : {0.01, 0.05}) {
    std::vector<double> g(x.size()), difference(x.size());
    Wrench wrench;
    const double h = 1e-4;
    for (const double sign : {1.0, -1.0}) {
      Case c = kCases[3];
      c.indenter.rim = rim * std::exp(sign * h);
      const auto V = probe(c);
      V->add_gradient(x, sign / (2 * h), difference);
      const Wrench w = V->wrench(x);
      wrench.force = wrench.force + (sign / (2 * h)) * w.force;
      wrench.torque = wrench.torque + (sign / (2 * h)) * w.torque;
    }
    Case c = kCases[3];
    c.indenter.rim = rim;
    const Wrench change = probe(c)->add_rim_gradient(x, 1, g);
    double error = 0, size = 0;
    for (size_t i = 0; i < x.size(); ++i)
      error = std::max(error, std::abs(g[i] - difference[i])), size = std::max(size, std::abs(g[i]));
    EXPECT_GT(size, 0) << rim;
    EXPECT_LT(error, 1e-5 * size) << rim;
    EXPECT_LT(norm(change.force - wrench.force), 1e-5 * norm(change.force)) << rim;
    EXPECT_LT(norm(change.torque - wrench.torque), 1e-5 * norm(change.force)) << rim;
  }
}

TEST(IndenterDepth, RimOfDiscIsCloseToAnArc) {
  for (const double rim : {0.013, 0.04, 0.12}) {
    const Indenter disc = {
        .shape = IndenterShape::disc, .contact = IndenterContact::sliding, .radius = 0.2, .rim = rim};
    const IndenterPose pose = {.center = {}, .axis = {{0, 0, -1}}, .rotation = {}};
    for (int i = 0; i <= 20; ++i) {
      const double angle = 0.5 * 3.14159265358979 * i / 20;
      const Vec3d x = {{0.2 - rim * (1 - std::sin(angle)), 0, rim * (1 - std::cos(angle))}};
      EXPECT_NEAR(depth(disc, pose, x).value, 0, (i == 10 ? 1e-3 : 0.03) * rim) << rim << " " << angle;
    }
  }
}

TEST(IndenterDepth, IsTwiceDifferentiableAcrossRimOfDisc) {
  const Indenter indenter = {IndenterShape::disc, IndenterContact::sliding, 0.2, 1};
  const IndenterPose pose = {.center = {}, .axis = {{0, 0, -1}}, .rotation = {}};
  Mat3d last{};
  for (int i = 0; i <= 2000; ++i) {  // along an arc through the flat, the rim and the side
    const double angle = -0.3 + 2.0 * i / 2000;
    const Vec3d x = {{0.18 + 0.03 * std::sin(angle), 0, 0.02 - 0.03 * std::cos(angle)}};
    const Depth d = depth(indenter, pose, x);
    EXPECT_LE(norm(d.gradient), 1 + 1e-14);
    const double jump = i > 0 ? std::sqrt(squared_norm(d.hessian - last)) : 0;
    EXPECT_LT(jump, 0.5);  // values up to 75
    last = d.hessian;
  }
}

}  // namespace
}  // namespace aspic
