// Changes of settings during a simulation.
#include <cmath>

#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

Json setting(const Page& page, const std::string& key, const std::string& side = "a") {
  const Json scene = page.scene(side);
  for (const Json& s : scene["settings"])
    if (s["key"] == key) return s;
  return {};
}

TEST(Settings, HaveTheValuesOfTheSchema) {
  Page page;
  const Json young = setting(page, "material.young");
  EXPECT_EQ(young["value"], 1e5);
  EXPECT_EQ(young["unit"], "Pa");
  EXPECT_EQ(young["kind"], "number");
  EXPECT_TRUE(young["log"].get<bool>());
  EXPECT_EQ(setting(page, "material.model")["kind"], "choice");
  EXPECT_GT(setting(page, "material.model")["choices"].size(), 5u);
  EXPECT_EQ(setting(page, "gravity")["kind"], "vector");
  EXPECT_EQ(setting(page, "gravity")["value"], Json({0, -9.81, 0}));
  EXPECT_EQ(setting(page, "solver.max_iterations")["kind"], "integer");
  EXPECT_EQ(setting(page, "solver.line_search.p")["value"], 0.5);
  const Json scene = page.scene();
  for (const Json& s : scene["settings"]) EXPECT_FALSE(s["meaning"].get<std::string>().empty()) << s["key"];
}

TEST(Settings, AcceptTheirCurrentValues) {
  Page page;
  page.steps(2);
  const Json scene = page.scene();
  for (const Json& s : scene["settings"]) {
    page.send({{"do", "set"}, {"key", s["key"]}, {"value", s["value"]}});
    EXPECT_EQ(setting(page, s["key"])["value"], s["value"]);
  }
  Page untouched;
  untouched.steps(4);
  page.steps(2);
  EXPECT_EQ(page.picture().positions, untouched.picture().positions);
}

TEST(Settings, TakeEffectAndKeepTheState) {
  Page page;
  page.steps(5);
  const Picture before = page.picture();
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 1e7}});
  EXPECT_EQ(page.picture().positions, before.positions);
  EXPECT_EQ(page.side()["step"], 5);
  EXPECT_EQ(setting(page, "material.young")["value"], 1e7);
  EXPECT_EQ(page.scene()["overrides"], Json({"material.young=1e+07"}));
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 2e7}});
  EXPECT_EQ(page.scene()["overrides"].size(), 1u);
  const double bent = page.picture().positions[1];
  page.steps(1);
  EXPECT_TRUE(page.rows()[5]["converged"].get<bool>());
  EXPECT_TRUE(std::isfinite(bent));
}

TEST(Settings, NullDropsTheOverrideAndKeepsTheState) {
  Page page;
  page.steps(3);
  for (const Json& change :
       {Json{{"key", "material.young"}, {"value", 1e7}}, Json{{"key", "solver.tolerance"}, {"value", 1e-9}}}) {
    const Json before = setting(page, change["key"]);
    page.send({{"do", "set"}, {"key", change["key"]}, {"value", change["value"]}});
    const Picture picture = page.picture();
    page.send({{"do", "set"}, {"key", change["key"]}, {"value", nullptr}});
    EXPECT_EQ(setting(page, change["key"]), before);
    EXPECT_EQ(page.scene()["overrides"], page.scene()["loaded_overrides"]);
    EXPECT_EQ(page.picture().positions, picture.positions);
  }
  EXPECT_EQ(page.side()["step"], 3);
  EXPECT_NE(page.refused({{"do", "set"}, {"key", "material.yuong"}, {"value", nullptr}}).find("material.young"),
            std::string::npos);
}

TEST(Settings, KeepAFormulaAsText) {
  Page page;
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", "1e5 * (1 + X)"}});
  EXPECT_EQ(setting(page, "material.young")["value"], "1e5 * (1 + X)");
  EXPECT_EQ(setting(page, "material.young")["kind"], "text");
  page.steps(1);
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", "2e5"}});
  EXPECT_EQ(setting(page, "material.young")["value"], 2e5);
}

TEST(Settings, RefuseWrongValuesWithoutAnyChange) {
  Page page, untouched;
  page.steps(2);
  const Json before = page.scene();
  const auto refused = [&](const std::string& key, const Json& value) {
    return page.refused({{"do", "set"}, {"key", key}, {"value", value}});
  };
  EXPECT_NE(refused("material.poisson", 0.5).find("< 0.5"), std::string::npos);
  EXPECT_NE(refused("material.young", -1).find("> 0"), std::string::npos);
  EXPECT_NE(refused("material.yuong", 1e5).find("material.young"), std::string::npos);
  refused("material.young", "1e5 * (");
  refused("material.young", Json::array({1, 2, 3}));
  refused("material.young", Json::object());
  refused("material.young", std::string(5000, '1'));
  refused("material.model", "jelly");
  refused("time.step", 0);
  refused("time.step", 1e300);
  refused("gravity", {1, 2});
  refused("gravity", "down");
  refused("gravity", {Json::array(), 1, 2});
  refused("solver.method", "guess");
  refused("solver.max_iterations", 2.5);
  refused("solver.line_search.c", 2);
  refused("solver.definiteness", "");
  refused("body.beam.shape.box.cells", {1000, 1000, 1000});
  refused("", 1);
  EXPECT_EQ(page.scene(), before);
  page.steps(3);
  untouched.steps(5);
  EXPECT_EQ(page.picture().positions, untouched.picture().positions);
}

TEST(Settings, OfTheSolverKeepTheScene) {
  Page page;
  page.steps(2);
  page.send({{"do", "set"}, {"key", "solver.method"}, {"value", "lbfgs"}});
  EXPECT_EQ(setting(page, "solver.method")["value"], "lbfgs");
  EXPECT_NE(page.scene()["solver"].get<std::string>().find("bfgs"), std::string::npos) << page.scene()["solver"];
  page.steps(1);
  EXPECT_TRUE(page.rows()[2]["converged"].get<bool>());
  const Json scene = page.send({{"ask", "scene"}, {"side", "a"}});
  EXPECT_NE(scene["text"].get<std::string>().find("lbfgs"), std::string::npos);
}

TEST(Settings, StepLengthKeepsTheTime) {
  Page page;
  page.steps(3);
  page.send({{"do", "set"}, {"key", "time.step"}, {"value", 0.002}});
  EXPECT_NEAR(page.side()["time"].get<double>(), 0.03, 1e-15);
  page.steps(1);
  EXPECT_EQ(page.side()["step"], 4);
  EXPECT_NEAR(page.side()["time"].get<double>(), 0.032, 1e-15);
  page.send({{"do", "set"}, {"key", "time.integrator"}, {"value", "bdf2"}});
  page.steps(2);
  EXPECT_NEAR(page.side()["time"].get<double>(), 0.036, 1e-15);
  page.send({{"do", "rewind"}, {"step", 3}});
  EXPECT_NEAR(page.side()["time"].get<double>(), 0.03, 1e-15);
  page.steps(1);
  EXPECT_NEAR(page.side()["time"].get<double>(), 0.032, 1e-15);
}

TEST(Settings, GravityTurnsWhileThePinsStay) {
  Page page(R"([[body]]
shape = { box = { upper = [0.2, 1, 0.2], cells = [2, 5, 2] } }
material = { young = 1e5 }
[[body.pin]]
where = { lowest = 0.01 }
)");
  const Json pins = page.pins();
  page.send({{"do", "set"}, {"key", "gravity"}, {"value", {9.81, 0, 0}}});
  EXPECT_EQ(page.pins(), pins);
  EXPECT_EQ(page.scene()["up"], Json({-1, 0, 0}));
  const Picture before = page.picture();
  page.steps(3);
  const int v = pins[0];
  EXPECT_EQ(page.picture().positions[3 * v], before.positions[3 * v]);
}

TEST(Settings, ApplyToAllBodies) {
  Page page(R"([[body]]
name = "one"
shape = { box = { upper = [0.2, 0.2, 0.2], cells = [1, 1, 1] } }
[[body]]
name = "two"
translate = [1, 0, 0]
shape = { box = { upper = [0.2, 0.2, 0.2], cells = [1, 1, 1] } }
)");
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 3e5}});
  EXPECT_NE(setting(page, "material.young")["meaning"].get<std::string>().find("all 2"), std::string::npos);
  page.send({{"do", "color"}, {"field", "young"}});
  EXPECT_EQ(page.picture().min, 3e5F);
  EXPECT_EQ(page.picture().max, 3e5F);
}

}  // namespace
}  // namespace aspic::viewer
