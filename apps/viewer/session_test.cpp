// Steps, iterations and rewinding of a session.
#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

TEST(Session, GreetsAPageWithItsWholeState) {
  Page page;
  EXPECT_EQ(page.scene()["name"].get<std::string>().substr(0, 5), "scene");
  EXPECT_EQ(page.scene()["tets"], 6 * 6 * 2 * 2);
  EXPECT_EQ(page.scene()["up"], Json({0, 1, 0}));
  EXPECT_EQ(page.pins().size(), 9u);
  EXPECT_EQ(page.side()["step"], 0);
  EXPECT_EQ(page.side()["iteration"], -1);
  EXPECT_EQ(page.geometry().rest.size() / 3, page.geometry().vertex.size());
}

TEST(Session, StepsAndPlaysAndPauses) {
  Page page;
  page.steps(2);
  EXPECT_EQ(page.side()["step"], 2);
  EXPECT_EQ(page.rows().size(), 2u);
  page.send({{"do", "play"}});
  EXPECT_TRUE(page.session().is_playing());
  for (int i = 0; i < 3; ++i) page.advance();
  page.send({{"do", "pause"}});
  page.advance();
  EXPECT_EQ(page.side()["step"], 5);
  EXPECT_NEAR(page.side()["time"].get<double>(), 0.05, 1e-12);
  EXPECT_EQ(page.rows().size(), 5u);
  EXPECT_EQ(page.rows()[4]["step"], 5);
}

TEST(Session, IsBitReproducibleAfterSingleIterations) {
  for (const char* integrator : {"backward_euler", "tr_bdf2", "midpoint", "symplectic_euler"}) {
    const std::vector<std::string> overrides = {std::string("time.integrator=") + integrator, "time.step=0.0005"};
    Page whole(kBeam, overrides), iterated(kBeam, overrides);
    whole.grab_end({1, 0.3, 0});
    iterated.grab_end({1, 0.3, 0});
    whole.steps(4);
    ASSERT_EQ(whole.side()["step"], 4);
    iterated.steps(1);
    iterated.send({{"do", "iterate"}});
    iterated.send({{"do", "step"}});  // the rest of step 2, if any
    for (int i = 0; i < 500 && iterated.side()["step"] < 4; ++i) iterated.send({{"do", "iterate"}});
    ASSERT_EQ(iterated.side()["step"], 4);
    if (iterated.side()["iteration"] != -1) iterated.send({{"do", "step"}});
    EXPECT_EQ(iterated.picture().positions, whole.picture().positions) << integrator;
    EXPECT_EQ(iterated.rows()[3]["kinetic"], whole.rows()[3]["kinetic"]) << integrator;
  }
}

TEST(Session, LastIterationCompletesTheStep) {
  Page page, whole;
  whole.steps(1);
  const size_t iterations = whole.rows()[0]["iterations"].size();
  ASSERT_GE(iterations, 2u);
  const Picture before = page.picture();
  for (size_t k = 0; k + 1 < iterations; ++k) {
    page.send({{"do", "iterate"}});
    EXPECT_EQ(page.side()["iteration"], k);
    EXPECT_EQ(page.side()["iterations"].size(), k + 1);
    EXPECT_EQ(page.side()["iterations"][k]["value"], whole.rows()[0]["iterations"][k]["value"]);
    EXPECT_EQ(page.side()["step"], 0);
    EXPECT_EQ(page.picture().iteration, static_cast<int>(k));
    EXPECT_NE(page.picture().positions, before.positions);
  }
  page.send({{"do", "iterate"}});
  EXPECT_EQ(page.side()["iteration"], -1);
  EXPECT_FALSE(page.side().contains("iterations"));
  EXPECT_EQ(page.side()["step"], 1);
  EXPECT_EQ(page.picture().positions, whole.picture().positions);
}

TEST(Session, IsBitReproducibleAfterRewinding) {
  Page page;
  page.grab_end({1.2, 0.3, 0});
  page.steps(3);
  page.send({{"do", "release"}});
  page.steps(7);
  const Picture there = page.picture();
  page.send({{"do", "rewind"}, {"step", 4}});
  EXPECT_EQ(page.side()["step"], 4);
  EXPECT_EQ(page.rows().size(), 4u);
  page.steps(6);
  EXPECT_EQ(page.picture().positions, there.positions);
  page.send({{"do", "reset"}});
  EXPECT_EQ(page.side()["step"], 0);
  EXPECT_TRUE(page.rows().empty());
}

TEST(Session, RewindsViscoelasticBranches) {
  Page page(kBeam + "[[body.viscoelastic]]\nratio = 2\nrelaxation_time = 0.02\n");
  page.steps(7);
  const Json hash = page.rows().back().at("state_hash");
  page.send({{"do", "rewind"}, {"step", 3}});
  page.steps(4);
  EXPECT_EQ(page.rows().back().at("state_hash"), hash);
  EXPECT_GT(number(page.rows().back().at("viscoelastic_loss")), 0);
  const std::string why = page.refused({{"do", "set"}, {"key", "time.integrator"}, {"value", "bdf2"}});
  EXPECT_NE(why.find("choose backward_euler"), std::string::npos) << why;
  page.steps(1);
  EXPECT_EQ(page.side()["step"], 8);
}

TEST(Session, ThinsOutALongHistory) {
  Page page(kBeam, {}, {.timeline_bytes = 200'000});
  page.steps(60);
  page.send({{"do", "rewind"}, {"step", 41}});
  EXPECT_LE(page.side()["step"], 41);
  EXPECT_GT(page.side()["step"], 0);
  EXPECT_EQ(page.rows().size(), page.side()["step"]);
}

}  // namespace
}  // namespace aspic::viewer
