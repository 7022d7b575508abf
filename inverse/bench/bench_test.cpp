// The bench: keeping readings, and the fit of their data set by the program aspic.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "bench/bench_test.h"
#include "data/data_set.h"
#include "io/external_program.h"

namespace aspic::bench {
namespace {

namespace fs = std::filesystem;

// A small block on a table, stiffer on one half.
const std::string kBlock = R"(
gravity = [0, 0, -9.81]
[time]
step = 0.01
integrator = "quasi_static"
[[body]]
name = "block"
shape = { box = { upper = [0.12, 0.08, 0.06], cells = [6, 4, 3] } }
material = { model = "neo_hookean", young = "X < 0.06 ? 1e4 : 4e4", poisson = 0.4, density = 1000 }
[[body.pin]]
name = "table"
where = "Z < 1e-6"
)";

// Returns a triangle of the upper side with x between two bounds.
int upper_triangle(BenchPage& page, float least, float most) {
  const auto& g = page.geometry();
  for (size_t t = 0; t < g.triangles.size() / 3; ++t) {
    bool is_inside = true;
    for (int c = 0; c < 3; ++c) {
      const float* X = &g.rest[3 * g.triangles[3 * t + c]];
      is_inside = is_inside && X[2] > 0.0599F && X[0] > least && X[0] < most && X[1] > 0.019F && X[1] < 0.061F;
    }
    if (is_inside) return static_cast<int>(t);
  }
  return -1;
}

void press(BenchPage& page, float least, float most, double depth) {
  page.send({{"do", "lift"}});
  page.steps(1);
  page.send({{"do", "touch"},
             {"side", "a"},
             {"triangle", upper_triangle(page, least, most)},
             {"weights", {0.3, 0.3, 0.4}},
             {"radius", 0.02}});
  page.send({{"do", "press"}, {"depth", depth}});
  page.steps(1);
}

Json readings(const BenchPage& page) { return page.heard("bench")["readings"]; }

Json fitted(BenchPage& page) {
  for (int tries = 0; tries < 3000; ++tries) {
    const Json state = page.send({{"ask", "fit_state"}});
    if (!state["running"]) return state;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  ADD_FAILURE() << "the fit does not end";
  return {};
}

// The readings of the test's own folder, as the bench writes to out/bench of the current one.
class InFolder {
 public:
  InFolder() { fs::current_path(folder_.path()); }
  ~InFolder() { fs::current_path(before_); }

 private:
  fs::path before_ = fs::current_path();
  TemporaryFolder folder_;  // TestFolder is that of the scenes
};

TEST(Bench, KeepsWhatTheGaugeShows) {
  BenchPage page(kBlock);
  press(page, 0.03F, 0.09F, 0.006);
  const Json tool = page.side()["tool"];
  page.send({{"do", "keep"}});
  ASSERT_EQ(readings(page).size(), 1u);
  EXPECT_EQ(readings(page)[0]["force"], tool["force"]);
  EXPECT_EQ(readings(page)[0]["depth"], tool["depth"]);
  EXPECT_EQ(readings(page)[0]["radius"], 0.02);
  EXPECT_NE(page.refused({{"do", "keep"}}).find("kept already"), std::string::npos);
  page.send({{"do", "press"}, {"depth", 0.003}});
  page.steps(1);
  page.send({{"do", "keep"}});
  ASSERT_EQ(readings(page).size(), 2u);  // sorted by depth
  EXPECT_NEAR(number(readings(page)[0]["depth"]), 0.003, 1e-12);
  EXPECT_EQ(readings(page)[0]["name"], "poke 1");
  press(page, 0.05F, 0.12F, 0.003);
  page.send({{"do", "keep"}});
  EXPECT_EQ(readings(page)[2]["name"], "poke 2");
  page.send({{"do", "forget"}, {"reading", 1}});
  EXPECT_EQ(readings(page).size(), 2u);
  page.send({{"do", "forget"}});
  EXPECT_TRUE(readings(page).empty());
}

TEST(Bench, KeepsOnlyReadingsAtRest) {
  BenchPage page(kBlock, {"time.integrator=\"backward_euler\""});
  EXPECT_NE(page.refused({{"do", "keep"}}).find("no indenter"), std::string::npos);
  page.steps(100);  // sags
  press(page, 0.03F, 0.09F, 0);
  EXPECT_NE(page.refused({{"do", "keep"}}).find("the depth is 0"), std::string::npos);
  page.send({{"do", "press"}, {"depth", 0.006}});
  EXPECT_NE(page.refused({{"do", "keep"}}).find("still moves"), std::string::npos);
  page.steps(1);
  EXPECT_NE(page.refused({{"do", "keep"}}).find("still moves"), std::string::npos);
  page.steps(100);
  page.send({{"do", "keep"}});

  BenchPage resting(kBlock);
  press(resting, 0.03F, 0.09F, 0.006);
  resting.send({{"do", "keep"}});
  EXPECT_NEAR(number(readings(page)[0]["force"]), number(readings(resting)[0]["force"]),
              0.01 * number(readings(resting)[0]["force"]));
}

TEST(Bench, AnotherBodyDropsTheReadings) {
  BenchPage page(kBlock);
  press(page, 0.03F, 0.09F, 0.006);
  page.send({{"do", "keep"}});
  page.send({{"do", "set"}, {"key", "solver.tolerance"}, {"value", 1e-8}});
  EXPECT_EQ(readings(page).size(), 1u);
  page.send({{"do", "set"}, {"key", "material.poisson"}, {"value", 0.3}});
  EXPECT_TRUE(readings(page).empty());
}

TEST(Bench, RefusesWhatItCannotMeasure) {
  BenchPage page(kBlock);
  page.refused({{"do", "forget"}, {"reading", 0}});
  EXPECT_NE(page.refused({{"do", "fit"}}).find("no reading is kept"), std::string::npos);
  EXPECT_NE(page.refused({{"ask", "fit_report"}}).find("no report"), std::string::npos);
  EXPECT_TRUE(page.send({{"ask", "fit_state"}}).is_null());
  page.send({{"do", "stop_fit"}});  // without a fit
  press(page, 0.03F, 0.09F, 0.006);
  EXPECT_NE(page.refused({{"do", "touch"}, {"side", "a"}, {"triangle", 0}, {"weights", {1, 0, 0}}}).find("lift it"),
            std::string::npos);
  page.send({{"do", "grab"},
             {"side", "a"},
             {"triangle", upper_triangle(page, 0, 0.065F)},
             {"weights", {1, 0, 0}},
             {"target", {0.1, 0.1, 0.1}}});
  EXPECT_NE(page.refused({{"do", "keep"}}).find("release it"), std::string::npos);
  page.send({{"do", "release"}});

  std::string pulled = kBlock;
  pulled.replace(pulled.find("[[body.pin]]"), 12,
                 "[[body.traction]]\nwhere = \"X < 1e-6\"\nvalue = [100, 0, 0]\n[[body.pin]]");
  BenchPage other(pulled);
  press(other, 0.03F, 0.09F, 0.006);
  EXPECT_NE(other.refused({{"do", "keep"}}).find("which a data set cannot have"), std::string::npos);
}

TEST(Bench, FitsTheReadingsInAnotherProgram) {
  const InFolder folder;
  BenchPage page(kBlock);
  for (const float x : {0.0F, 0.055F}) {
    press(page, x, x + 0.065F, 0.006);
    page.send({{"do", "keep"}});
  }
  const std::vector<double> gauge = {number(readings(page)[0]["force"]), number(readings(page)[1]["force"])};
  page.send({{"do", "fit"}});
  EXPECT_NE(page.refused({{"do", "fit"}}).find("a fit is running"), std::string::npos);
  const fs::path data_folder = page.send({{"ask", "fit_state"}})["folder"].get<std::string>();
  const DataSet data = read_data_set(data_folder);
  ASSERT_EQ(data.experiment.cases.size(), 2u);
  for (int c = 0; c < 2; ++c) {  // the equilibrium that the gauge showed, with noise of 1 %
    const Vec3d force = *data.experiment.cases[c].force;
    EXPECT_NEAR(std::hypot(force[0], force[1], force[2]), gauge[c], 0.05 * gauge[c]);
  }
  for (const DataFinding& finding : diagnose(data)) EXPECT_NE(finding.severity, Severity::error) << finding.what;
  const Json state = fitted(page);
  EXPECT_TRUE(state["has_report"]) << state;
  EXPECT_TRUE(fs::exists(data_folder / "material.vtu"));
  EXPECT_GT(page.send({{"ask", "fit_report"}})["base64"].get<std::string>().size(), 100'000u);
  page.send({{"do", "fit"}});  // into another folder
  EXPECT_NE(page.send({{"ask", "fit_state"}})["folder"], data_folder.string());
}

TEST(Bench, AStoppedFitEnds) {
  const InFolder folder;
  BenchPage page(kBlock);
  press(page, 0.03F, 0.09F, 0.006);
  page.send({{"do", "keep"}});
  page.send({{"do", "fit"}});
  page.send({{"do", "stop_fit"}});
  EXPECT_FALSE(fitted(page)["running"]);
}

}  // namespace
}  // namespace aspic::bench
