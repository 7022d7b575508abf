// The virtual bench: recording, saving, fitting, and simulating what was fitted.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <mutex>

#include "capture/data_set.h"
#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

// A small block on a table, stiffer on one half.
const std::string kBlock = R"(
gravity = [0, 0, 0]
[time]
step = 0.01
[[body]]
name = "block"
shape = { box = { upper = [0.12, 0.08, 0.06], cells = [6, 4, 3] } }
material = { model = "neo_hookean", young = "X < 0.06 ? 1e4 : 4e4", poisson = 0.4, density = 1000 }
[[body.pin]]
name = "table"
where = "Z < 1e-6"
)";

Json poke(int sites, int depths) {
  return {{"do", "poke_all"}, {"sites", sites}, {"depths", depths}, {"depth", 0.006}, {"radius", 0.02}};
}

int upper_triangle(Page& page) {
  const auto& g = page.geometry();
  for (size_t t = 0; t < g.triangles.size() / 3; ++t) {
    bool upper = true;
    for (int c = 0; c < 3; ++c) {
      const float* X = &g.rest[3 * g.triangles[3 * t + c]];
      upper = upper && X[2] > 0.0599F && X[0] > 0.03F && X[0] < 0.09F;
    }
    if (upper) return static_cast<int>(t);
  }
  return -1;
}

void touch(Page& page) {
  page.send({{"do", "touch"},
             {"side", "a"},
             {"triangle", upper_triangle(page)},
             {"weights", {0.3, 0.3, 0.4}},
             {"radius", 0.02}});
}

FitNews finished(const FitTask& task, Page& page) {
  FitNews last;
  run_fit(task, [&](FitNews news) {
    news.task = task.number;
    page.note_fit(news);
    if (news.has_ended) last = std::move(news);
  });
  return last;
}

TEST(Bench, RecordsPoseAndEquilibriumForceOfIndenter) {
  Page page(kBlock, {"time.integrator=\"quasi_static\""});
  page.send({{"do", "bench"}, {"noise", 0}, {"markers", 30}, {"same_mesh", false}});
  EXPECT_EQ(page.capture()["markers"]["triangles"].size(), 30u);
  EXPECT_FALSE(page.capture()["same_mesh"]);
  touch(page);
  EXPECT_NE(page.refused({{"do", "record"}}).find("press the indenter in"), std::string::npos);
  page.send({{"do", "press"}, {"depth", 0.006}});
  page.steps(1);
  const Json probe = page.side()["probe"];
  page.send({{"do", "record"}, {"depths", 3}});
  const Json cases = page.capture()["cases"];
  ASSERT_EQ(cases.size(), 3u);
  EXPECT_EQ(cases[2]["name"], "poke 1, depth 3");
  EXPECT_NEAR(number(cases[0]["depth"]), 0.002, 1e-12);
  for (int r = 0; r < 3; ++r)  // within the tolerance of the solver
    EXPECT_NEAR(number(cases[2]["force"][r]), number(probe["force"][r]), 1e-3 * number(cases[2]["push"]));
  EXPECT_GT(number(cases[1]["push"]), number(cases[0]["push"]));
  page.send({{"do", "forget"}, {"case", 1}});
  EXPECT_EQ(page.capture()["cases"].size(), 2u);
  EXPECT_EQ(page.capture()["cases"][1]["name"], "poke 1, depth 3");
  page.send({{"do", "forget"}});
  EXPECT_TRUE(page.capture()["cases"].empty());
}

TEST(Bench, NoiseIsSeededAndHasTheWantedSize) {
  std::vector<Json> forces;
  for (const int seed : {1, 1, 2}) {
    Page page(kBlock);
    page.send({{"do", "bench"}, {"noise", 0.05}, {"markers", 30}, {"seed", seed}});
    page.send(poke(1, 1));
    forces.push_back(page.capture()["cases"][0]["force"]);
  }
  EXPECT_EQ(forces[0], forces[1]);
  EXPECT_NE(forces[0], forces[2]);
}

TEST(Bench, SavesAReadableDataSet) {
  const TestFolder folder;
  const std::string path = (folder.path() / "poked").string();
  Page page(kBlock);
  EXPECT_NE(page.refused({{"do", "save_capture"}, {"folder", path}}).find("no case is recorded"), std::string::npos);
  page.send({{"do", "bench"}, {"markers", 30}});
  page.send(poke(2, 2));
  page.send({{"do", "save_capture"}, {"folder", path}});
  const DataSet data = read_data_set(path);
  ASSERT_EQ(data.experiment.cases.size(), 4u);
  EXPECT_EQ(data.experiment.cases[3].name, "poke 2, depth 2");
  EXPECT_EQ(data.experiment.markers.size(), 30u);
  for (const DataFinding& finding : diagnose(data)) EXPECT_NE(finding.severity, Severity::error) << finding.what;
  EXPECT_NE(page.refused({{"do", "save_capture"}, {"folder", path}}).find("exists already"), std::string::npos);
}

TEST(Bench, FindsAndSimulatesTheStifferHalf) {
  Page page(kBlock);
  EXPECT_NE(page.refused({{"do", "fit"}}).find("no case is recorded"), std::string::npos);
  page.send({{"do", "bench"}, {"markers", 60}, {"noise", 0.002}, {"same_mesh", true}});
  EXPECT_TRUE(page.capture()["same_mesh"]);
  page.send(poke(6, 1));
  EXPECT_NE(page.refused({{"do", "bench"}, {"same_mesh", false}}).find("forget them first"), std::string::npos);
  page.send({{"do", "fit"}});
  EXPECT_TRUE(page.capture()["fit"]["running"]);
  page.refused({{"do", "fit"}});
  const std::optional<FitTask> task = page.session().take_fit();
  ASSERT_TRUE(task);
  EXPECT_FALSE(page.session().take_fit());
  finished(*task, page);
  const Json fit = page.capture()["fit"];
  EXPECT_FALSE(fit["running"]);
  EXPECT_EQ(fit["failure"], "");
  ASSERT_TRUE(fit["has_material"]);
  EXPECT_LT(number(fit["error"]), 0.5);  // log 4 = 1.4 apart
  EXPECT_GT(number(fit["stiffest"]) / number(fit["softest"]), 2);
  EXPECT_FALSE(fit["iterations"].empty());

  // The colors show it.
  EXPECT_EQ(page.scene()["field"], "fitted_young");
  const Picture picture = page.picture();
  double soft = 0, stiff = 0;
  int softs = 0, stiffs = 0;
  for (size_t v = 0; v < picture.values.size(); ++v) {
    const float X = page.geometry().rest[3 * v];
    if (X < 0.04F) soft += picture.values[v], ++softs;
    if (X > 0.08F) stiff += picture.values[v], ++stiffs;
  }
  EXPECT_GT(stiff / stiffs, 1.7 * soft / softs);
  for (const char* name : {"fit_error", "young_deviation", "young"}) page.send({{"do", "color"}, {"field", name}});

  page.send({{"do", "simulate_fit"}});
  EXPECT_EQ(page.scene("b")["label"], "fitted material");
  EXPECT_EQ(page.scene("b")["field"], "young");
  EXPECT_EQ(page.capture()["cases"].size(), 6u);  // the bench remains

  // A recording refers to no temporary file.
  EXPECT_NE(page.refused({{"ask", "recording"}}).find("save the data set"), std::string::npos);
  const TestFolder folder;
  page.send({{"do", "save_capture"}, {"folder", (folder.path() / "poked").string()}});
  const Json recording = page.send({{"ask", "recording"}});
  const std::string material = (folder.path() / "poked" / "material.vtu").string();
  EXPECT_TRUE(std::filesystem::exists(material));
  EXPECT_NE(recording["compare"]["overrides"].dump().find(material), std::string::npos);
  read_data_set(folder.path() / "poked");
  touch(page);
  page.send({{"do", "press"}, {"depth", 0.004}});
  page.steps(20);
  EXPECT_GT(number(page.side("b")["probe"]["depth"]), 0.0039);
  page.send({{"do", "end_compare"}});
  EXPECT_EQ(page.capture()["cases"].size(), 6u);
}

TEST(Bench, EstimatesTheErrorOfACoarserMesh) {
  for (const bool same_mesh : {false, true}) {
    Page page(kBlock);
    page.send({{"do", "bench"}, {"markers", 30}, {"noise", 0.02}, {"same_mesh", same_mesh}});
    page.send(poke(2, 1));
    page.send({{"do", "fit"}});
    const std::optional<FitTask> task = page.session().take_fit();
    ASSERT_TRUE(task);
    EXPECT_EQ(task->plan.mesh_errors, !same_mesh);
    for (const LoadCase& load : task->data.experiment.cases) {  // only the sigma of the instruments
      const Vec3d& f = *load.force;
      EXPECT_NEAR(load.force_sigma[0], 0.02 * std::hypot(f[0], f[1], f[2]), 0.2 * load.force_sigma[0]);
    }
    std::vector<std::string> stages;
    run_fit(*task, [&](const FitNews& news) {
      if (!news.stage.empty()) stages.push_back(news.stage);
    });
    EXPECT_EQ(std::ranges::count(stages, "discretization error, by a finer mesh") > 0, !same_mesh);
    EXPECT_GT(std::ranges::count(stages, "a value for every tet"), 0);
  }
}

TEST(Bench, StiffnessHasALogarithmicScale) {
  Page page(kBlock);
  const Json scene = page.scene();
  for (const Json& field : scene["fields"]) EXPECT_EQ(field["log"], field["name"] == "young") << field;
}

TEST(Bench, AStoppedFitKeepsItsResult) {
  Page page(kBlock);
  page.send({{"do", "bench"}, {"markers", 30}});
  page.send(poke(2, 1));
  page.send({{"do", "fit"}});
  const std::optional<FitTask> task = page.session().take_fit();
  int iterations = 0;
  const auto publish = [&](FitNews news) {
    news.task = task->number;
    page.note_fit(news);
    if (++iterations == 3) page.send({{"do", "stop_fit"}});
  };
  run_fit(*task, publish, StopToken([&] { return !page.session().wants_fit(); }));
  EXPECT_FALSE(page.capture()["fit"]["running"]);
  EXPECT_LE(iterations, 5);
  page.send({{"do", "fit"}});  // may start again
}

TEST(Bench, IgnoresNewsOfADroppedFit) {
  Page page(kBlock);
  page.send(poke(1, 1));
  page.send({{"do", "fit"}});
  FitNews late;
  late.task = page.session().take_fit()->number;
  late.failure = "late";
  page.send({{"do", "forget"}});
  page.send({{"do", "bench"}, {"same_mesh", false}});
  page.note_fit(late);
  EXPECT_TRUE(page.capture()["fit"].is_null());
}

TEST(Bench, AnotherBodyDropsTheCases) {
  Page page(kBlock);
  page.send({{"do", "bench"}, {"markers", 30}});
  page.send(poke(1, 1));
  page.send({{"do", "set"}, {"key", "solver.tolerance"}, {"value", 1e-8}});
  EXPECT_EQ(page.capture()["cases"].size(), 1u);
  page.send({{"do", "set"}, {"key", "material.poisson"}, {"value", 0.3}});
  EXPECT_TRUE(page.capture()["cases"].empty());
  EXPECT_NE(page.capture()["words"].get<std::string>().find("has changed"), std::string::npos);
}

TEST(Bench, RefusesImpossibleMeasurements) {
  Page page(kBlock);
  page.refused({{"do", "record"}});
  page.refused({{"do", "forget"}, {"case", 0}});
  page.refused({{"do", "bench"}, {"markers", 0}});
  page.refused({{"do", "bench"}, {"noise", 2}});
  page.refused(poke(0, 1));
  page.refused({{"do", "poke_all"}, {"sites", 3}, {"depths", 1}, {"depth", -1}});
  page.refused({{"do", "simulate_fit"}});
  page.send({{"do", "stop_fit"}});  // without a fit
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", page.pins()}, {"pinned", false}});
  EXPECT_NE(page.refused({{"do", "bench"}}).find("no pin holds"), std::string::npos);
}

TEST(FitJob, RunsInItsOwnThreadAndStops) {
  Page page(kBlock);
  page.send({{"do", "bench"}, {"markers", 30}});
  page.send(poke(2, 1));
  page.send({{"do", "fit"}});
  std::mutex mutex;
  std::condition_variable changed;
  bool woken = false;
  FitJob job(*page.session().take_fit(), [&] {
    const std::lock_guard lock(mutex);
    woken = true;
    changed.notify_one();
  });
  bool has_ended = false;
  for (int news = 0; !has_ended && news < 1000; ++news) {
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(120), [&] { return woken; }));
    woken = false;
    lock.unlock();
    if (const std::optional<FitNews> update = job.news()) {
      page.note_fit(*update);
      has_ended = update->has_ended;
    }
    if (news == 1) job.stop();
  }
  EXPECT_TRUE(has_ended);
  const Json fit = page.capture()["fit"];  // null if the fit was stopped before its first iteration
  EXPECT_FALSE(fit.is_object() && fit["running"]);
}

}  // namespace
}  // namespace aspic::viewer
