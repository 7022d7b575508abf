#include "indenter/held_indenter.h"

#include <gtest/gtest.h>

#include <memory>

#include "base/error.h"
#include "energy/tet_elasticity.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

const TetMesh& mesh() {
  static const TetMesh box = make_box({{0, 0, 0}}, {{1, 0.8, 0.6}}, {4, 3, 3});
  return box;
}

BlockPattern pattern() {
  const std::vector<MaterialParameters> parameters(mesh().tet_count(), {lame_from_young_poisson(1, 0.3), {}});
  Couplings couplings;
  make_tet_elasticity("neo_hookean", mesh(), 0, parameters)->add_couplings(couplings);
  return make_pattern(mesh().vertex_count(), couplings);
}

std::vector<double> rest() {
  std::vector<double> x;
  for (const Vec3d& X : mesh().rest) x.insert(x.end(), {X[0], X[1], X[2]});
  return x;
}

std::shared_ptr<const FirstContact> touch(IndenterContact contact = IndenterContact::bonded) {
  const IndenterPose pose{.center = {{0.5, 0.4, 0.8}}, .axis = {{0, 0, -1}}, .rotation = {}};
  return std::make_shared<const FirstContact>(FirstContact{{IndenterShape::sphere, contact, 0.2, 50}, pose, pose});
}

IndenterMotion pressed(double depth, IndenterContact contact = IndenterContact::bonded) {
  IndenterMotion poke{.touch = touch(contact), .from = {}, .to = {}};
  poke.from = poke.to = poke.touch->begun;
  poke.to.center[2] -= depth;
  poke.from_time = 1, poke.to_time = 3;
  return poke;
}

TEST(HeldIndenter, PoseMovesLinearlyWithinTheStep) {
  const IndenterMotion poke = pressed(0.1);
  EXPECT_EQ(poke.pose(0).center[2], 0.8);
  EXPECT_NEAR(poke.pose(1.5).center[2], 0.775, 1e-15);
  EXPECT_NEAR(poke.pose(9).center[2], 0.7, 1e-15);
}

TEST(HeldIndenter, IsZeroWithoutTouch) {
  HeldIndenter V(mesh());
  const std::vector<double> x = rest();
  std::vector<double> g(x.size());
  ActiveTerm(V).add_gradient(x, 1, g);
  EXPECT_EQ(V.value(x), 0);
  EXPECT_EQ(g, std::vector<double>(x.size(), 0.0));
  EXPECT_EQ(V.touched_points(x), 0);
}

// Bound before the indenter is set.
TEST(HeldIndenter, EqualsItsProbe) {
  const BlockPattern blocks = pattern();
  const std::vector<double> x = rest();
  for (const IndenterContact contact : {IndenterContact::bonded, IndenterContact::sliding}) {
    const IndenterMotion poke = pressed(0.1, contact);
    HeldIndenter V(mesh());
    V.bind(blocks);
    V.set(poke);
    ActiveTerm term(V, {.start = x, .h = 1, .time = 9});
    const auto probe =
        make_probe(mesh(), boundary_triangles(mesh(), 0, mesh().tet_count()), poke.touch->indenter, poke.touch->rest);
    probe->bind(blocks);
    probe->set_pose(poke.to);
    EXPECT_GT(V.value(x), 0);
    EXPECT_EQ(V.value(x), probe->value(x));
    EXPECT_EQ(term.value(x), probe->value(x));
    std::vector<double> g(x.size()), expected(x.size());
    term.add_gradient(x, 2, g);
    probe->add_gradient(x, 2, expected);
    EXPECT_EQ(g, expected);
    BlockSparse H(blocks), K(blocks);
    term.add_hessian(x, 1, {Definiteness::exact}, H);
    probe->add_hessian(x, 1, {Definiteness::exact}, K);
    for (size_t b = 0; b < H.block.size(); ++b) EXPECT_EQ(squared_norm(H.block[b] - K.block[b]), 0);
    for (int r = 0; r < 3; ++r) EXPECT_EQ(V.wrench(x).force[r], probe->wrench(x).force[r]);

    term.begin_step({.start = x, .h = 1, .time = 2});  // halfway
    probe->set_pose(poke.pose(2));
    EXPECT_EQ(term.value(x), probe->value(x));
    V.set({});
    EXPECT_EQ(term.value(x), 0);
  }
}

TEST(HeldIndenter, InvalidTouchChangesNothing) {
  HeldIndenter V(mesh());
  const IndenterMotion good = pressed(0.1);
  V.set(good);
  const std::vector<double> x = rest();
  const double before = V.value(x);
  IndenterMotion bad = good;
  FirstContact away = *good.touch;
  away.rest.center[2] += 5;  // the glue reaches no surface point
  bad.touch = std::make_shared<const FirstContact>(away);
  EXPECT_THROW(V.set(bad), InvalidInput);
  EXPECT_EQ(V.value(x), before);
  EXPECT_EQ(V.poke().touch, good.touch);
}

}  // namespace
}  // namespace aspic
