// Pulling and pinning.
#include <cmath>

#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

TEST(Mouse, PullsWithStiffnessTimesDistance) {
  Page page;
  page.grab_end({1, 0.5, 0.1});
  page.steps(30);
  const Json grab = page.side()["grab"];
  const std::vector<double> point = vec(grab["point"]), target = vec(grab["target"]), force = vec(grab["force"]);
  EXPECT_EQ(target, (std::vector<double>{1, 0.5, 0.1}));
  const double k = number(page.scene()["stiffness"]);
  for (int r = 0; r < 3; ++r) EXPECT_NEAR(force[r], k * (target[r] - point[r]), 1e-9 * k);
  EXPECT_GT(point[1], 0.15);  // starts at 0.1 and would sag
}

TEST(Mouse, IsReleased) {
  Page page;
  page.grab_end({1, 0.5, 0.1});
  page.steps(3);
  page.send({{"do", "release"}});
  EXPECT_TRUE(page.side()["grab"].is_null());
  EXPECT_NE(page.refused({{"do", "move"}, {"target", {0, 0, 0}}}), "");
  page.steps(1);
  EXPECT_EQ(number(page.rows()[3]["potential"].back()), 0);
}

// Checks that kinetic + potential energy changes from row to row by the work and losses of the row.
void expect_balance(Page& page, size_t first) {
  ASSERT_EQ(page.scene()["potentials"].back(), "mouse");
  for (size_t i = first; i < page.rows().size(); ++i) {
    const Json &row = page.rows()[i], &before = page.rows()[i - 1];
    const double gain =
        number(row["kinetic"]) + sum(row["potential"]) - number(before["kinetic"]) - sum(before["potential"]);
    const double work = number(row["mouse_work"]) + number(row["pin_work"]) - number(row["damping_loss"]) -
                        number(row["numerical_loss"]) + number(row["residual_work"]);
    const double size = std::abs(number(row["kinetic"])) + std::abs(sum(row["potential"])) +
                        std::abs(number(row["mouse_work"])) + std::abs(number(row["pin_work"])) +
                        std::abs(number(row["numerical_loss"])) + std::abs(sum(before["potential"]));
    EXPECT_NEAR(gain, work, 1e-12 * size + 1e-12) << "step " << row["step"];
    EXPECT_LE(std::abs(number(row["ledger_error"])), 1e-12 * size + 1e-12);
  }
}

TEST(Mouse, EnergiesBalanceWithItsWork) {
  for (const char* integrator : {"backward_euler", "tr_bdf2", "midpoint", "bdf2", "linearly_implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Page page(kBeam, {std::string("time.integrator=") + integrator, "damping.stiffness=0.001"});
    page.steps(2);
    page.grab_end({1, 0.4, 0.1});
    page.steps(2);
    page.send({{"do", "move"}, {"target", {1.1, 0.5, 0.2}}});
    page.steps(2);
    page.send({{"do", "stiffness"}, {"value", 3000}});
    page.steps(2);
    page.send({{"do", "release"}});
    page.steps(3);
    expect_balance(page, 1);
    double work = 0;
    for (const Json& row : page.rows()) work += number(row["mouse_work"]);
    EXPECT_GT(work, 0);
    for (const Json& row : page.rows()) EXPECT_NEAR(number(row["pin_work"]), 0, 1e-12);  // no other motion
  }
}

TEST(Mouse, EnergiesBalanceWithSingleIterations) {
  Page page(kBeam, {"time.adaptive.tolerance=1e-4"});
  page.steps(1);
  page.grab_end({1, 0.4, 0.1});
  page.steps(4);
  expect_balance(page, 1);
}

TEST(Mouse, ReachesTheCursorWithinAStep) {
  Page page;
  page.grab_end({1, 0.1, 0.1});
  page.send({{"do", "move"}, {"target", {1, 0.2, 0.1}}});
  page.steps(1);
  const Json grab = page.side()["grab"];
  const double k = number(page.scene()["stiffness"]);
  EXPECT_NEAR(vec(grab["force"])[1], k * (0.2 - vec(grab["point"])[1]), 1e-9 * k);
}

TEST(Mouse, RefusesNonpositiveStiffness) {
  Page page;
  const double before = number(page.scene()["stiffness"]);
  for (const Json& value : {Json(-1), Json(0), Json("stiff"), Json(1e300), Json()})
    page.refused({{"do", "stiffness"}, {"value", value}});
  EXPECT_EQ(number(page.scene()["stiffness"]), before);
  page.send({{"do", "stiffness"}, {"value", 5.5}});
  EXPECT_EQ(number(page.scene()["stiffness"]), 5.5);
}

TEST(Mouse, RefusesInvalidPointsAndTargets) {
  Page page;
  const int triangles = static_cast<int>(page.geometry().triangles.size() / 3);
  const auto grab = [&](const Json& triangle, const Json& weights, const Json& target) {
    return page.refused(
        {{"do", "grab"}, {"side", "a"}, {"triangle", triangle}, {"weights", weights}, {"target", target}});
  };
  const Json third = {0.3, 0.3, 0.4}, there = {1, 0, 0};
  EXPECT_NE(grab(triangles, third, there).find("a whole number from 0 to"), std::string::npos);
  grab(-1, third, there);
  grab(0.5, third, there);
  grab(0, {1, 1, 1}, there);
  grab(0, {2, -1, 0}, there);
  grab(0, {0.5, 0.5}, there);
  grab(0, third, {1e30, 0, 0});
  grab(0, third, {"x", 0, 0});
  EXPECT_TRUE(page.side()["grab"].is_null());
}

TEST(Pins, HoldBrushedVerticesUntilFreed) {
  Page page;
  page.steps(5);
  const Picture then = page.picture();
  std::vector<int> end;
  for (size_t v = 0; v < page.geometry().vertex.size(); ++v)
    if (page.geometry().rest[3 * v] > 0.999F) end.push_back(static_cast<int>(v));
  ASSERT_EQ(end.size(), 9u);
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", end}, {"pinned", true}});
  EXPECT_EQ(page.pins().size(), 18u);
  page.steps(10);
  for (const int v : end)
    for (int r = 0; r < 3; ++r)
      EXPECT_EQ(page.picture().positions[3 * v + r], then.positions[3 * v + r]) << "vertex " << v;
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 2e5}});  // reloads the scene
  page.steps(3);
  EXPECT_EQ(page.picture().positions[3 * end[0] + 1], then.positions[3 * end[0] + 1]);
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", end}, {"pinned", false}});
  page.steps(5);
  EXPECT_LT(page.picture().positions[3 * end[0] + 1], then.positions[3 * end[0] + 1] - 1e-3F);
}

TEST(Pins, OfTheSceneCanBeRemoved) {
  Page page;
  const Json clamp = page.pins();
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", clamp}, {"pinned", false}});
  EXPECT_TRUE(page.pins().empty());
  const Picture before = page.picture();
  page.steps(10);
  const int v = clamp[0];
  EXPECT_NEAR(page.picture().positions[3 * v + 1] - before.positions[3 * v + 1], -9.81 * 0.01 * 0.01 * 55, 1e-4);
  page.send({{"do", "reset"}});
  EXPECT_TRUE(page.pins().empty());  // removed at the start
}

TEST(Pins, AreRewoundWithTheTimeline) {
  Page page;
  page.steps(3);
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", {page.geometry().vertex.size() - 1}}, {"pinned", true}});
  page.steps(3);
  EXPECT_EQ(page.pins().size(), 10u);
  page.send({{"do", "rewind"}, {"step", 2}});
  EXPECT_EQ(page.pins().size(), 9u);
}

}  // namespace
}  // namespace aspic::viewer
