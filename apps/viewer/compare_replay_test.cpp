// Comparisons of two sides, and replays of sessions.
#include <cmath>

#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

TEST(Comparison, StepsTheSideThatIsBehind) {
  Page page;
  page.send({{"do", "compare"}, {"overrides", {"time.step=0.005"}}, {"label", "h/2"}});
  EXPECT_EQ(page.scene("b")["h"], 0.005);
  EXPECT_EQ(page.scene("b")["label"], "h/2");
  page.send({{"do", "play"}});
  for (int i = 0; i < 30; ++i) {
    page.advance();
    const double a = page.side("a")["time"], b = page.side("b")["time"];
    EXPECT_LE(std::abs(a - b), 0.01 + 1e-12);
  }
  EXPECT_EQ(page.side("a")["step"], 10);
  EXPECT_EQ(page.side("b")["step"], 20);
  page.send({{"do", "step"}});
  EXPECT_EQ(page.side("a")["step"], 11);
  EXPECT_EQ(page.side("b")["step"], 22);
  EXPECT_EQ(page.session().pictures().size(), 2u);
}

TEST(Comparison, IsGrabbedPinnedAndSetOnBothSides) {
  Page page;
  page.send({{"do", "compare"}, {"overrides", {"material.young=1e6"}}, {"label", "stiff"}});
  page.send({{"do", "grab"},
             {"side", "b"},
             {"triangle", page.end_triangle()},
             {"weights", {0.2, 0.3, 0.5}},
             {"target", {1, 0.5, 0}}});
  EXPECT_FALSE(page.side("a")["grab"].is_null());
  EXPECT_EQ(page.side("a")["grab"]["point"], page.side("b")["grab"]["point"]);
  EXPECT_EQ(page.side("a")["grab"]["force"], page.side("b")["grab"]["force"]);  // one spring
  page.send({{"do", "pin"}, {"side", "b"}, {"vertices", {30}}, {"pinned", true}});
  EXPECT_EQ(page.pins("a"), page.pins("b"));
  page.send({{"do", "set"}, {"key", "material.density"}, {"value", 900}});
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 2e5}});  // compared keys keep their values
  page.send({{"do", "color"}, {"field", "density"}});
  for (const int side : {0, 1}) EXPECT_EQ(page.picture(side).max, 900);
  page.send({{"do", "color"}, {"field", "young"}});
  EXPECT_EQ(page.picture(0).max, 2e5F);
  EXPECT_EQ(page.picture(1).max, 1e6F);
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 3e6}, {"side", "b"}});
  EXPECT_EQ(page.picture(1).max, 3e6F);
  page.send({{"do", "end_compare"}});
  EXPECT_TRUE(page.state()["b"].is_null());
  page.refused({{"do", "end_compare"}});
  page.refused({{"ask", "worst"}, {"side", "b"}});
}

TEST(Comparison, GrabsOtherMeshesAtTheNearestPoint) {
  Page page;
  page.send({{"do", "compare"}, {"overrides", {"body.beam.shape.box.cells=[12, 4, 4]"}}, {"label", "fine"}});
  page.grab_end({1, 0.5, 0});
  const auto a = page.side("a")["grab"]["point"].get<std::vector<double>>();
  const auto b = page.side("b")["grab"]["point"].get<std::vector<double>>();
  for (int r = 0; r < 3; ++r) EXPECT_NEAR(a[r], b[r], 1e-12);
  page.steps(2);
}

TEST(Comparison, ThatFailsToLoadChangesNothing) {
  Page page;
  page.steps(2);
  page.refused({{"do", "compare"}, {"overrides", {"time.stpe=0.005"}}, {"label", ""}});
  EXPECT_TRUE(page.state()["b"].is_null());
  EXPECT_EQ(page.side()["step"], 2);
}

// Sends all recorded commands at several steps, with rewinding.
void play_with(Page& page) {
  page.steps(2);
  page.grab_end({1, 0.4, 0.1});
  page.steps(2);
  page.send({{"do", "move"}, {"target", {1.1, 0.5, 0.2}}});
  page.send({{"do", "move"}, {"target", {1.2, 0.5, 0.2}}});
  page.send({{"do", "iterate"}});
  page.send({{"do", "step"}});
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 3e5}});
  page.steps(2);
  page.send({{"do", "stiffness"}, {"value", 5000}});
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", {7, 8}}, {"pinned", true}});
  page.steps(2);
  page.send({{"do", "release"}});
  page.send({{"do", "set"}, {"key", "time.step"}, {"value", 0.004}});
  page.steps(6);
  page.send({{"do", "rewind"}, {"step", 8}});
  page.grab_end({0.9, 0.1, 0.3});
  page.steps(3);
  page.send({{"do", "set"}, {"key", "solver.definiteness"}, {"value", "clamped"}});
  page.steps(2);
}

void expect_same_replayed(Page& page) {
  const Json recording = page.send({{"ask", "recording"}});
  const Picture a = page.picture(0);
  const bool compares = !page.state()["b"].is_null();
  const Picture b = compares ? page.picture(1) : a;
  Page other;
  other.send({{"do", "replay"}, {"recording", recording}});
  EXPECT_TRUE(other.state()["replaying"].get<bool>());
  other.play_until_it_stops();
  EXPECT_FALSE(other.state()["replaying"].get<bool>());
  EXPECT_EQ(other.side()["step"], recording["steps"]);
  EXPECT_EQ(other.picture(0).positions, a.positions);
  EXPECT_EQ(other.picture(0).time, a.time);
  if (compares) {
    EXPECT_EQ(other.picture(1).positions, b.positions);
    EXPECT_EQ(other.picture(1).time, b.time);
  }
  EXPECT_EQ(other.send({{"ask", "recording"}}), recording);
}

TEST(Recording, RepeatsASessionBitForBit) {
  Page page;
  play_with(page);
  expect_same_replayed(page);
}

TEST(Recording, RepeatsAComparisonBitForBit) {
  Page page;
  page.send({{"do", "compare"}, {"overrides", {"time.step=0.005"}}, {"label", "h/2"}});
  play_with(page);
  page.send({{"do", "play"}});
  for (int i = 0; i < 4; ++i) page.advance();
  page.send({{"do", "move"}, {"target", {1.1, 0.2, 0.2}}});
  for (int i = 0; i < 5; ++i) page.advance();
  page.send({{"do", "pause"}});
  page.steps(1);
  expect_same_replayed(page);
}

TEST(Recording, BeginsWithTheSettingsAfterAReset) {
  Page page;
  play_with(page);
  page.send({{"do", "reset"}});
  page.steps(3);
  page.grab_end({1, 0.3, 0});
  page.steps(3);
  expect_same_replayed(page);
}

TEST(Recording, EndsReplayAtACommand) {
  Page page;
  play_with(page);
  const Json recording = page.send({{"ask", "recording"}});
  page.send({{"do", "replay"}, {"recording", recording}});
  for (int i = 0; i < 3; ++i) page.advance();
  EXPECT_TRUE(page.state()["replaying"].get<bool>());
  page.send({{"do", "color"}, {"field", "speed"}});
  EXPECT_TRUE(page.state()["replaying"].get<bool>());
  page.grab_end({1, 1, 0});
  EXPECT_FALSE(page.state()["replaying"].get<bool>());
  EXPECT_TRUE(page.session().is_playing());
  page.advance();
  EXPECT_EQ(page.side()["step"], 4);
}

TEST(Recording, RefusesMalformedRecordings) {
  Page page;
  page.steps(1);
  Json good = page.send({{"ask", "recording"}});
  const auto refused = [&](const std::function<void(Json&)>& spoil) {
    Json bad = good;
    spoil(bad);
    return page.refused({{"do", "replay"}, {"recording", bad}});
  };
  refused([](Json& r) { r = 3; });
  refused([](Json& r) { r.erase("events"); });
  refused([](Json& r) { r["scene"] = "/nowhere/at_all.toml"; });
  refused([](Json& r) { r["events"] = {{{"step", 0}, {"command", {{"do", "release"}}}}}; });
  refused([](Json& r) { r["events"] = {{{"step", 1}, {"command", {{"do", "load"}, {"scene", "x"}}}}}; });
  refused([](Json& r) { r["events"] = {{{"step", 1}, {"command", {{"do", 7}}}}}; });
  refused([](Json& r) { r["steps"] = -1; });
  EXPECT_EQ(page.side()["step"], 1);
  Json late = good;  // refused during the replay
  late["events"] = {{{"step", 1}, {"command", {{"do", "stiffness"}}}}};
  page.send({{"do", "replay"}, {"recording", late}});
  page.advance();
  EXPECT_FALSE(page.session().is_playing());
  EXPECT_FALSE(page.state()["replaying"].get<bool>());
}

}  // namespace
}  // namespace aspic::viewer
