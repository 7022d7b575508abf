// The indenter: touching, pressing, its force and its work.
#include <algorithm>
#include <cmath>

#include "bench/bench_test.h"
#include "bench/indenter_place.h"
#include "math/polar3.h"

namespace aspic::bench {
namespace {

// A slab on a table, without gravity.
const std::string kSlab = R"(
gravity = [0, 0, 0]
[time]
step = 0.01
[[body]]
name = "slab"
shape = { box = { upper = [0.2, 0.2, 0.08], cells = [5, 5, 2] } }
material = { model = "neo_hookean", young = 2e4, poisson = 0.4, density = 1000 }
[[body.pin]]
name = "table"
where = "Z < 1e-6"
)";
const double kYoung = 2e4;

// Returns a triangle near the middle of the upper side.
int middle_triangle(BenchPage& page) {
  const auto& g = page.geometry();
  int best = -1;
  double least = 1;
  for (size_t t = 0; t < g.triangles.size() / 3; ++t) {
    double x = 0, y = 0, z = 1;
    for (int c = 0; c < 3; ++c) {
      const float* X = &g.rest[3 * g.triangles[3 * t + c]];
      x += X[0] / 3, y += X[1] / 3, z = std::min<double>(z, X[2]);
    }
    const double away = std::hypot(x - 0.1, y - 0.1);
    if (z > 0.0799 && away < least) least = away, best = static_cast<int>(t);
  }
  return best;
}

Json touch_message(BenchPage& page, const Json& further = Json::object()) {
  Json message = {{"do", "touch"}, {"side", "a"}, {"triangle", middle_triangle(page)}, {"weights", {0.3, 0.3, 0.4}}};
  message.update(further);
  return message;
}

void expect_balance_of_indenter(BenchPage& page) {
  for (size_t i = 1; i < page.rows().size(); ++i) {
    const Json &row = page.rows()[i], &before = page.rows()[i - 1];
    const double gain =
        number(row["kinetic"]) + sum(row["potential"]) - number(before["kinetic"]) - sum(before["potential"]);
    const double work = number(row["mouse_work"]) + number(row["tool_work"]) + number(row["pin_work"]) -
                        number(row["damping_loss"]) - number(row["numerical_loss"]) + number(row["residual_work"]);
    const double scale = std::abs(number(row["kinetic"])) + std::abs(sum(row["potential"])) +
                         std::abs(number(row["tool_work"])) + std::abs(number(row["numerical_loss"])) +
                         std::abs(sum(before["potential"]));
    EXPECT_NEAR(gain, work, 1e-12 * scale + 1e-13) << "step " << row["step"];
  }
}

TEST(Indenter, IndentsTheBodyAndMeasuresTheForce) {
  BenchPage page(kSlab, {"time.integrator=\"quasi_static\""});
  page.send(touch_message(page, {{"radius", 0.03}}));
  page.steps(1);
  const Json begun = page.side()["tool"];
  EXPECT_EQ(number(begun["depth"]), 0);
  EXPECT_NEAR(vec(begun["center"])[2], 0.08 + 0.03, 1e-6);  // unaffected by the single precision of the weights
  page.send({{"do", "press"}, {"depth", 0.01}});
  page.steps(1);
  const Json tool = page.side()["tool"];
  EXPECT_NEAR(number(tool["depth"]), 0.01, 1e-12);
  EXPECT_NEAR(vec(tool["center"])[2], 0.08 + 0.03 - 0.01, 1e-6);
  // A rigid punch of radius a has F = 2 a E / (1 - nu^2) d. A layer of finite thickness is stiffer.
  EXPECT_GT(number(tool["force"]), kYoung * 0.015 * 0.01);
  EXPECT_LT(number(tool["force"]), 50 * kYoung * 0.03 * 0.01);
  page.send({{"do", "lift"}});
  page.steps(1);
  EXPECT_TRUE(page.side()["tool"].is_null());
  const Picture after = page.picture();
  for (size_t i = 0; i < after.positions.size(); ++i) EXPECT_NEAR(after.positions[i], page.geometry().rest[i], 1e-7);
}

TEST(Indenter, EnergiesBalanceWithItsWork) {
  for (const char* contact : {"bonded", "sliding"})
    for (const char* integrator : {"backward_euler", "tr_bdf2", "midpoint"}) {
      SCOPED_TRACE(std::string(contact) + " " + integrator);
      BenchPage page(kSlab, {std::string("time.integrator=") + integrator});
      page.steps(1);
      page.send(touch_message(page, {{"contact", contact}, {"shape", "disc"}}));
      page.steps(1);
      page.send({{"do", "press"}, {"depth", 0.004}});
      page.steps(2);
      page.send({{"do", "press"}, {"depth", 0.008}});
      page.steps(2);
      page.send({{"do", "lift"}});
      page.steps(2);
      double work = 0, most = 0;
      for (const Json& row : page.rows()) {
        work += number(row["tool_work"]);
        most = std::max(most, work);
        EXPECT_NEAR(number(row["pin_work"]), 0, 1e-12);
      }
      EXPECT_GT(most, 0);
      expect_balance_of_indenter(page);
    }
}

TEST(Indenter, IsBitReproducibleAfterRewinding) {
  BenchPage page(kSlab);
  page.steps(2);
  page.send(touch_message(page));
  page.send({{"do", "press"}, {"depth", 0.005}});
  page.steps(3);
  const Picture then = page.picture();
  page.send({{"do", "press"}, {"depth", 0.01}});
  page.steps(2);
  const Picture deep = page.picture();
  page.send({{"do", "rewind"}, {"step", 5}});
  EXPECT_EQ(page.picture().positions, then.positions);
  EXPECT_NEAR(number(page.side()["tool"]["depth"]), 0.005, 1e-15);
  page.send({{"do", "press"}, {"depth", 0.01}});
  page.steps(2);
  EXPECT_EQ(page.picture().positions, deep.positions);
  page.send({{"do", "rewind"}, {"step", 1}});
  EXPECT_TRUE(page.side()["tool"].is_null());
}

TEST(Indenter, IsRepeatedByARecording) {
  BenchPage page(kSlab);
  page.steps(1);
  page.send(touch_message(page, {{"contact", "sliding"}}));
  for (int k = 1; k <= 4; ++k) {
    page.send({{"do", "press"}, {"depth", 0.002 * k}});
    page.steps(1);
  }
  const Picture end = page.picture();
  const Json recording = page.send({{"ask", "recording"}});
  page.send({{"do", "replay"}, {"recording", recording}});
  page.play_until_it_stops();
  EXPECT_EQ(page.picture().positions, end.positions);
  EXPECT_NEAR(number(page.side()["tool"]["depth"]), 0.008, 1e-15);
}

TEST(Indenter, SurvivesANewSetting) {
  BenchPage page(kSlab, {"time.integrator=\"quasi_static\""});
  page.send(touch_message(page));
  page.send({{"do", "press"}, {"depth", 0.008}});
  page.steps(1);
  const double before = number(page.side()["tool"]["force"]);
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 4e4}});
  page.steps(1);
  EXPECT_NEAR(number(page.side()["tool"]["depth"]), 0.008, 1e-12);
  EXPECT_GT(number(page.side()["tool"]["force"]), 1.8 * before);
}

TEST(Indenter, TouchesBothSidesOfAComparison) {
  BenchPage page(kSlab, {"time.integrator=\"quasi_static\""});
  page.send({{"do", "compare"}, {"overrides", {"material.young=1e4"}}, {"label", "softer"}});
  page.send(touch_message(page));
  page.send({{"do", "press"}, {"depth", 0.008}});
  page.steps(1);
  const Json a = page.side("a")["tool"], b = page.side("b")["tool"];
  EXPECT_EQ(a["depth"], b["depth"]);
  EXPECT_GT(number(a["force"]), 1.5 * number(b["force"]));
}

TEST(Indenter, RefusesInvalidIndenters) {
  BenchPage page(kSlab);
  EXPECT_NE(page.refused({{"do", "press"}, {"depth", 0.01}}).find("no indenter"), std::string::npos);
  page.refused(touch_message(page, {{"radius", 0}}));
  page.refused(touch_message(page, {{"radius", 1e9}}));
  page.refused(touch_message(page, {{"shape", "cone"}}));
  page.refused(touch_message(page, {{"contact", "glued"}}));
  page.refused(touch_message(page, {{"triangle", -1}}));
  page.refused(touch_message(page, {{"stiffness", -2}}));
  EXPECT_TRUE(page.side()["tool"].is_null());
  page.send(touch_message(page));
  page.refused({{"do", "press"}, {"depth", 1e30}});
  page.refused({{"do", "press"}, {"depth", "deep"}});
  EXPECT_EQ(number(page.side()["tool"]["wanted"]), 0);
}

TEST(RotationVector, IsAxisTimesAngle) {
  for (const double angle : {0.0, 1e-12, 0.3, 2.0, 3.0, 3.1415, 3.14159265358979}) {
    const Vec3d a = {{2.0 / 3, -1.0 / 3, 2.0 / 3}};
    const Mat3d turn = {0, a[2], -a[1], -a[2], 0, a[0], a[1], -a[0], 0};
    const Mat3d R = identity3<double>() + std::sin(angle) * turn + (1 - std::cos(angle)) * (turn * turn);
    const Vec3d r = rotation_vector(R);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(r[i], angle * a[i], 1e-7) << angle;
  }
}

}  // namespace
}  // namespace aspic::bench
