// Questions of a page, and the contents of pictures.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dynamics/mesh_error_text.h"
#include "scene/scene.h"
#include "viewer/replies.h"
#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

// The same scene without a page: the reference for pictures.
struct Twin {
  Scene scene;
  explicit Twin(const std::string& toml, int steps) : scene(load_scene(Page::scene_file(toml))) {
    for (int i = 0; i < steps; ++i) scene.simulation.step();
  }
  const Model& model() const { return scene.simulation.model(); }
};

TEST(Pictures, AgreeWithTheModelInUserNumbers) {
  Page page;
  const Twin twin(kBeam, 5);
  page.steps(5);
  const std::vector<double> q = twin.model().numbering.vertex.to_user(twin.scene.simulation.state().q, 3);
  const Picture picture = page.picture();
  const Geometry& geometry = page.geometry();
  ASSERT_EQ(picture.positions.size(), geometry.rest.size());
  EXPECT_EQ(picture.generation, geometry.generation);
  EXPECT_EQ(picture.step, 5);
  EXPECT_EQ(picture.time, twin.scene.simulation.state().time);
  // The term of an idle mouse changes only the order of sums.
  for (size_t v = 0; v < geometry.vertex.size(); ++v)
    for (int r = 0; r < 3; ++r)
      EXPECT_NEAR(picture.positions[3 * v + r], q[3 * geometry.vertex[v] + r], 1e-6) << "vertex " << v;
  EXPECT_EQ(geometry.edges.size() / 2, geometry.triangles.size() / 3 * 3 / 2);  // a closed surface
}

TEST(Pictures, HaveUnitNormalsThatPointOutwards) {
  Page page;
  const Picture picture = page.picture();
  const Geometry& geometry = page.geometry();
  for (size_t v = 0; v < geometry.vertex.size(); ++v) {
    const int8_t* n = &picture.normals[4 * v];
    EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 127, 1.5);
    EXPECT_EQ(n[3], 0);
    if (geometry.rest[3 * v] == 0) {
      EXPECT_LT(n[0], 0);
    }
    if (geometry.rest[3 * v] == 1) {
      EXPECT_GT(n[0], 0);
    }
  }
}

TEST(Pictures, CarryEveryField) {
  Page page;
  page.steps(3);
  const Json fields = page.scene()["fields"];
  ASSERT_GE(fields.size(), 10u);
  for (const Json& field : fields) {
    page.send({{"do", "color"}, {"field", field["name"]}});
    EXPECT_EQ(page.scene()["field"], field["name"]);
    const Picture picture = page.picture();
    ASSERT_EQ(picture.values.size(), picture.positions.size() / 3) << field;
    EXPECT_EQ(*std::min_element(picture.values.begin(), picture.values.end()), picture.min);
    EXPECT_EQ(*std::max_element(picture.values.begin(), picture.values.end()), picture.max);
  }
  page.send({{"do", "color"}, {"field", ""}});
  EXPECT_TRUE(page.picture().values.empty());
  EXPECT_NE(page.refused({{"do", "color"}, {"field", "von_misses"}}).find("von_mises"), std::string::npos);
}

TEST(Pictures, OfDisplacementAndStressAgreeWithTheState) {
  Page page;
  page.steps(4);
  page.send({{"do", "color"}, {"field", "displacement"}});
  const Picture picture = page.picture();
  for (size_t v = 0; v < picture.values.size(); ++v) {
    double squared = 0;
    for (int r = 0; r < 3; ++r) squared += std::pow(picture.positions[3 * v + r] - page.geometry().rest[3 * v + r], 2);
    EXPECT_NEAR(picture.values[v], std::sqrt(squared), 1e-6);
  }
  page.send({{"do", "color"}, {"field", "det_F"}});
  EXPECT_NEAR(page.picture().min, 1, 0.2);
  EXPECT_GE(page.picture().min, page.rows().back()["min_det_F"].get<double>() - 1e-6);
}

const std::string kSkinned = R"(
[[body]]
mesh = "cage.mesh"
skin = "skin.obj"
material = { young = 1e5 }
[[body.pin]]
where = "x < 0.01"
)";

TEST(Pictures, ShowAFineSkinOrItsCage) {
  const TestFolder folder;
  Page source;  // provides a deformed beam as cage and its surface as skin
  const auto save = [&](const char* format, const std::string& name) {
    folder.write(name, source.send({{"ask", "mesh"}, {"side", "a"}, {"format", format}})["text"].get<std::string>());
  };
  save("mesh", "cage.mesh");
  // A smaller surface inside.
  folder.write("skin.obj",
               "v 0.1 0.05 0.05\nv 0.9 0.05 0.05\nv 0.5 0.15 0.05\nv 0.5 0.1 0.15\n"
               "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  folder.write("scene.toml", kSkinned);
  Session session(folder / "scene.toml", {});
  const Messages greeting = session.greeting(Role::steers);
  EXPECT_EQ(last(greeting, "scene")["surface"], "skin");
  EXPECT_TRUE(last(greeting, "scene")["has_skin"].get<bool>());
  EXPECT_EQ(decoded(session.pictures()[0].bytes).positions.size(), 12u);
  const auto send = [&](const Json& message) { return session.handle(message.dump(), Role::steers); };
  send({{"do", "grab"}, {"side", "a"}, {"triangle", 2}, {"weights", {0.3, 0.3, 0.4}}, {"target", {0.8, 0.4, 0.1}}});
  Answer answer;
  for (int i = 0; i < 10; ++i) answer = send({{"do", "step"}});
  const Json grab = last(answer.to_all, "state")["a"]["grab"];
  EXPECT_GT(vec(grab["point"])[1], 0.12);
  const Json vertex =
      Json::parse(send({{"id", 1}, {"ask", "vertex"}, {"side", "a"}, {"vertex", 1}}).to_sender[0].bytes)["reply"];
  EXPECT_EQ(vertex["vertex"], -1);
  answer = send({{"do", "pin"}, {"side", "a"}, {"vertices", {1}}, {"pinned", true}});
  EXPECT_FALSE(last(answer.to_all, "pins")["vertices"].empty());
  answer = send({{"do", "surface"}, {"which", "cage"}});
  EXPECT_EQ(last(answer.to_all, "scene")["surface"], "cage");
  EXPECT_GT(decoded(session.pictures()[0].bytes).positions.size(), 12u);
}

TEST(Questions, DescribeAVertexAndATet) {
  Page page;
  page.steps(3);
  const Json vertex = page.send({{"ask", "vertex"}, {"side", "a"}, {"vertex", 20}});
  EXPECT_EQ(vertex["vertex"], page.geometry().vertex[20]);
  EXPECT_EQ(vertex["first_entry"], 3 * page.geometry().vertex[20]);
  for (int r = 0; r < 3; ++r)
    EXPECT_EQ(static_cast<float>(vec(vertex["position"])[r]), page.picture().positions[3 * 20 + r]);
  EXPECT_GT(vertex["mass"].get<double>(), 0);
  EXPECT_EQ(vertex["values"].size(), page.scene()["fields"].size());

  const int triangle = page.end_triangle();
  const Json tet = page.send({{"ask", "tet"}, {"side", "a"}, {"triangle", triangle}});
  EXPECT_EQ(tet["tet"], page.geometry().tet[triangle]);
  const Twin twin(kBeam, 0);
  const TetMesh user = to_user(twin.model().numbering, twin.model().mesh);
  EXPECT_EQ(tet["corners"], Json(user.tets[tet["tet"].get<int>()]));
  const std::vector<double> stretches = vec(tet["stretches"]);
  EXPECT_NEAR(stretches[0] * stretches[1] * stretches[2], tet["J"].get<double>(), 1e-12);
  EXPECT_EQ(tet["young"].get<double>(), twin.model().tet_fields[0].second[0]);
  EXPECT_NEAR(tet["energy"].get<double>(), tet["volume"].get<double>() * tet["energy_density"].get<double>(), 1e-15);
  for (const char* what : {"vertex", "triangle"}) {
    for (const Json& wrong : {Json(-1), Json(1'000'000), Json("3"), Json(1.5), Json()})
      page.refused({{"ask", what == std::string("vertex") ? "vertex" : "tet"}, {"side", "a"}, {what, wrong}});
  }
}

TEST(Questions, FindTheWorstPlaces) {
  Page page;
  page.steps(3);
  const Json items = page.send({{"ask", "worst"}, {"side", "a"}})["items"];
  ASSERT_EQ(items.size(), 5u);
  EXPECT_EQ(items[0]["value"], page.rows()[2]["min_det_F"]);
  EXPECT_EQ(items[0]["positions"].size(), 4u);
  EXPECT_GE(items[4]["vertex"].get<int>(), 0);
}

TEST(Questions, AboutIterationsOfStoredStepsChangeNothing) {
  Page page, untouched;
  for (Page* p : {&page, &untouched}) {
    p->steps(2);
    p->grab_end({1, 0.4, 0.2});
    p->steps(4);
  }
  for (const int step : {1, 3, 6, 7}) {
    const Json reply = page.send({{"ask", "iteration"}, {"side", "a"}, {"step", step}, {"iteration", 1}});
    EXPECT_EQ(reply["curve"]["alpha"].size(), 101u);
    EXPECT_EQ(reply["slice"]["value"].size(),
              reply["slice"]["columns"].get<size_t>() * reply["slice"]["rows"].get<size_t>());
    EXPECT_NEAR(reply["path"][1]["s"].get<double>(), 0, 1e-12);
    EXPECT_NEAR(reply["path"][2]["s"].get<double>(), reply["alpha"].get<double>(), 1e-9);
    EXPECT_NEAR(reply["path"][2]["t"].get<double>(), 0, 1e-9);
    if (step > 6) continue;
    const Json& row = page.rows()[step - 1];
    EXPECT_EQ(reply["value"], row["iterations"][1]["value"]);  // the same minimization
    EXPECT_EQ(reply["alpha"], row["iterations"][1]["alpha"]);
    EXPECT_EQ(reply["path"].size(), row["iterations"].size() + 1);
  }
  EXPECT_NE(page.refused({{"ask", "iteration"}, {"side", "a"}, {"step", 3}, {"iteration", 99}}).find("iterations 0 to"),
            std::string::npos);
  page.refused({{"ask", "iteration"}, {"side", "a"}, {"step", 9}, {"iteration", 0}});
  for (Page* p : {&page, &untouched}) p->steps(2);
  EXPECT_EQ(page.picture().positions, untouched.picture().positions);
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 2e5}});
  EXPECT_NE(page.refused({{"ask", "iteration"}, {"side", "a"}, {"step", 3}, {"iteration", 0}}).find("other settings"),
            std::string::npos);
}

TEST(Questions, EstimateTheErrorOfTheMesh) {
  Page page, untouched;
  Twin twin(kBeam, 2);
  const Json question = {{"ask", "mesh_error"}, {"side", "a"}};
  EXPECT_NE(page.refused(question).find("take one first"), std::string::npos);
  const auto offers = [&] { return page.scene()["fields"].dump().find("mesh_error") != std::string::npos; };
  page.steps(3);
  EXPECT_FALSE(offers());
  const std::string text = page.send(question);
  StepReport report = twin.scene.simulation.step();
  add_mesh_error(twin.scene.simulation, {}, report);
  EXPECT_EQ(text, report.mesh_error);  // without an idle mouse
  ASSERT_EQ(page.rows().size(), 3u);
  EXPECT_EQ(page.rows()[2]["mesh_error"], text);
  EXPECT_EQ(page.rows()[2]["mesh_worst_tet"], report.mesh_worst_tet);
  EXPECT_EQ(page.rows()[1]["mesh_error"], "");
  EXPECT_TRUE(offers());
  page.send({{"do", "color"}, {"field", "mesh_error"}});
  std::vector<float> values(page.geometry().vertex.size());
  const Surface surface = boundary_of(twin.model());
  FieldValues().evaluate("mesh_error", {twin.scene.simulation, twin.scene.simulation.state().q, report.mesh_density},
                         surface, values);
  const Picture picture = page.picture();
  EXPECT_GT(picture.max, 0);
  for (size_t v = 0; v < values.size(); ++v) EXPECT_NEAR(picture.values[v], values[v], 1e-4 * picture.max);

  untouched.steps(5);
  page.steps(2);
  EXPECT_FALSE(offers());  // it was the error of another state
  EXPECT_EQ(page.scene()["field"], "");
  EXPECT_EQ(page.picture().positions, untouched.picture().positions);
  page.send({{"do", "rewind"}, {"step", 3}});
  EXPECT_TRUE(offers());
  EXPECT_EQ(page.send(question), text);
  EXPECT_EQ(page.rows()[2]["mesh_energy"].get<double>(), report.mesh_energy);
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 2e5}});
  EXPECT_NE(page.refused(question).find("other settings"), std::string::npos);
}

TEST(Questions, AboutTheErrorOfTheMeshStopOnRequest) {
  Side side(load_steered(Page::scene_file(kBeam), {}, {}, SessionOptions()), size_t{1} << 20);
  side.step(StopToken());
  const std::vector<double> q = side.simulation().state().q;
  side.estimate_mesh_error(StopToken([] { return true; }));
  EXPECT_TRUE(side.mesh_error().empty());
  EXPECT_EQ(side.simulation().state().q, q);
}

TEST(Questions, SampleTheCurrentStep) {
  Page page;
  page.steps(1);
  page.send({{"do", "iterate"}});
  const Json reply = page.send({{"ask", "iteration"}, {"side", "a"}, {"step", 2}, {"iteration", 0}});
  EXPECT_EQ(reply["step"], 2);
  EXPECT_EQ(page.side()["iteration"], 0);
  page.send({{"do", "step"}});
  EXPECT_EQ(reply["value"], page.rows()[1]["iterations"][0]["value"]);
}

TEST(Questions, AboutAnIterationStopOnRequest) {
  Side side(load_steered(Page::scene_file(kBeam), {}, {}, SessionOptions()), size_t{1} << 20);
  side.step(StopToken());
  const std::vector<double> q = side.simulation().state().q;
  for (const int patience : {0, 1, 50, 500}) {  // before, within the curve, and within the slice
    int asked = 0;
    try {
      iteration_reply(side, 1, 1, StopToken([&] { return asked++ >= patience; }));
      FAIL() << "was answered";
    } catch (const Interrupted&) {
    }
    EXPECT_LE(asked, patience + 5) << "continued after the request to stop";
  }
  EXPECT_EQ(side.simulation().state().q, q);
  EXPECT_EQ(iteration_reply(side, 1, 1, StopToken())["step"], 1);
}

TEST(Questions, AnExplicitStepHasNoIterations) {
  Page page(kBeam, {"time.integrator=symplectic_euler", "time.step=1e-4"});
  page.steps(2);
  EXPECT_NE(
      page.refused({{"ask", "iteration"}, {"side", "a"}, {"step", 1}, {"iteration", 0}}).find("minimizes nothing"),
      std::string::npos);
}

TEST(Questions, ReturnTheMeshAndTheScene) {
  Page page;
  page.steps(2);
  for (const char* format : {"obj", "ply", "vtu", "msh", "mesh"}) {
    const Json reply = page.send({{"ask", "mesh"}, {"side", "a"}, {"format", format}});
    EXPECT_GT(reply["text"].get<std::string>().size(), 500u);
    EXPECT_NE(reply["name"].get<std::string>().find(std::string("_000002.") + format), std::string::npos);
  }
  page.refused({{"ask", "mesh"}, {"side", "a"}, {"format", "../../x.obj"}});
  const Json scene = page.send({{"ask", "scene"}, {"side", "a"}});
  EXPECT_NE(scene["text"].get<std::string>().find("[[body]]"), std::string::npos);
}

TEST(Questions, MinimizeAFunction) {
  Page page;
  const auto ask = [&](const Json& changes) {
    Json question = {{"ask", "function"},          {"name", "rosenbrock"}, {"start", {-1.2, 1}},
                     {"settings", Json::object()}, {"iteration", 2},       {"samples", 21}};
    question.update(changes);
    return question;
  };
  Json reply = page.send(ask(Json::object()));
  EXPECT_EQ(reply["status"], "converged");
  EXPECT_EQ(reply["value"].size(), 21u * 21u);
  EXPECT_EQ(reply["path"].size(), reply["iterations"].size() + 1);
  EXPECT_NEAR(reply["path"].back()["x"].get<double>(), 1, 1e-5);
  EXPECT_EQ(reply["model"]["center"][0], reply["path"][2]["x"]);
  EXPECT_EQ(reply["curve"]["alpha"].size(), 101u);
  reply = page.send(
      ask({{"settings", {{"method", "gradient_descent"}, {"line_search.p", 0.8}, {"max_iterations", 100000}}}}));
  EXPECT_EQ(reply["status"], "iteration_limit");
  EXPECT_EQ(reply["iterations"].size(), 500u);
  reply = page.send(ask({{"name", "cosh(x) + (y - x)^2"}, {"samples", 5000}}));
  EXPECT_EQ(reply["samples"], 101);
  EXPECT_NEAR(reply["path"].back()["x"].get<double>(), 0, 1e-4);
  page.refused(ask({{"name", "cosh(x"}}));
  page.refused(ask({{"name", "log(x)"}, {"start", {-1, 0}}}));
  page.refused(ask({{"name", ""}}));
  page.refused(ask({{"start", {1}}}));
  page.refused(ask({{"start", {1, 1e300}}}));
  page.refused(ask({{"settings", {{"method", "guess"}}}}));
  page.refused(ask({{"settings", {{"young", 3}}}}));
  page.refused(ask({{"settings", 3}}));
  page.refused(ask({{"iteration", -1}}));
  page.refused(ask({{"more", 1}}));
}

}  // namespace
}  // namespace aspic::viewer
