// Obstacles and contact points in the messages of a session and in recordings.
#include <gtest/gtest.h>

#include <algorithm>

#include "contact/barrier.h"
#include "mesh/self_intersection.h"
#include "viewer/recording_test.h"
#include "viewer/session_test.h"
#include "viewer/surface.h"

namespace aspic::viewer {
namespace {

const std::string kRestingCube = R"(
gravity = [0, -9.81, 0]
[time]
step = 0.01
duration = 0.1
[contact]
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [2, 2, 2] } }
translate = [0, 0.0005, 0]
material = { model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }
[[obstacle]]
name = "floor"
plane = {}
[[obstacle]]
name = "step"
shape = { box = { lower = [0.15, 0, 0], upper = [0.25, 0.05, 0.1], cells = [1, 1, 1] } }
)";

TEST(ContactView, SendsObstaclesWithGeometry) {
  Page page(kRestingCube);
  const Json message = page.obstacles();
  EXPECT_EQ(message["generation"], page.scene()["generation"]);
  const Json& list = message["obstacles"];
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0]["name"], "floor");
  EXPECT_EQ(vec(list[0]["plane"]["normal"]), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(list[0]["triangles"].size(), 6U);
  for (size_t k = 1; k < 12; k += 3) EXPECT_NEAR(number(list[0]["points"][k]), 0, 1e-15);
  EXPECT_TRUE(list[1]["plane"].is_null());
  EXPECT_EQ(list[1]["points"].size(), 24U);
  EXPECT_EQ(list[1]["triangles"].size(), 36U);
}

TEST(ContactView, SceneBoxCoversObstacles) {
  Page page(kRestingCube);
  EXPECT_DOUBLE_EQ(vec(page.scene()["upper"])[0], 0.25);
  EXPECT_DOUBLE_EQ(vec(page.scene()["lower"])[1], 0);
}

TEST(ContactView, PicturesHaveContactPoints) {
  Page page(kRestingCube);
  page.steps(20);
  page.send({{"do", "color"}, {"field", "contact_pressure"}});
  const Picture picture = page.picture();
  ASSERT_EQ(picture.contacts.size(), 4U * 9U);
  double largest = 0;
  for (size_t i = 0; i < picture.contacts.size(); i += 4) {
    EXPECT_GT(picture.contacts[i + 1], 0);
    EXPECT_LT(picture.contacts[i + 1], 2e-3);
    largest = std::max<double>(largest, picture.contacts[i + 3]);
  }
  EXPECT_NEAR(largest, number(page.rows().back()["max_pressure"]), 1e-5 * largest);
  EXPECT_GT(largest, 100);
  EXPECT_FLOAT_EQ(picture.max, *std::max_element(picture.values.begin(), picture.values.end()));
  const auto touching = std::count_if(picture.values.begin(), picture.values.end(), [](float p) { return p > 0; });
  EXPECT_EQ(touching, 9);
}

// The left cube is dragged into the right one and beyond: it pushes, and never enters.
TEST(ContactView, DraggedBodiesPushEachOther) {
  Page page(R"(
gravity = [0, 0, 0]
[time]
step = 0.01
duration = 1
[contact]
friction = 0.3
[[body]]
name = "left"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [2, 2, 2] } }
material = { model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }
[[body]]
name = "right"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [2, 2, 2] } }
translate = [0.15, 0, 0]
material = { model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }
)");
  const std::vector<float> start = page.picture().positions;
  const std::vector<uint32_t> triangles = page.geometry().triangles;
  page.send(
      {{"do", "grab"}, {"side", "a"}, {"triangle", 0}, {"weights", {0.4, 0.3, 0.3}}, {"target", {0, 0.05, 0.05}}});
  for (int k = 1; k <= 20; ++k) {
    page.send({{"do", "move"}, {"target", {0.02 * k, 0.05, 0.05}}});
    page.steps(2);
    EXPECT_TRUE(page.rows().back()["converged"].get<bool>()) << k;
    TriMesh surface;
    const std::vector<float> x = page.picture().positions;
    for (size_t i = 0; i < x.size(); i += 3) surface.vertices.push_back({{x[i], x[i + 1], x[i + 2]}});
    for (size_t t = 0; t < triangles.size(); t += 3)
      surface.triangles.push_back({int(triangles[t]), int(triangles[t + 1]), int(triangles[t + 2])});
    EXPECT_TRUE(self_intersections(surface, 1).pairs.empty()) << k;
  }
  float moved = 0;
  const std::vector<float> x = page.picture().positions;
  for (size_t i = 0; i < x.size(); i += 3)
    if (start[i] > 0.12f) moved = std::max(moved, x[i] - start[i]);
  EXPECT_GT(moved, 0.05f);
}

TEST(ContactView, FrictionCanBeChangedWhileTheCubeSlides) {
  const auto distance = [](const Json& friction) {  // of the first vertex after ten steps
    std::string scene = kRestingCube;
    scene.replace(scene.find("[[obstacle]]"), 0, "velocity = [0.5, 0, 0]\n");
    Page page(scene);
    page.send({{"do", "set"}, {"key", "contact.friction"}, {"value", friction}});
    const float start = page.picture().positions[0];
    page.steps(10);
    return page.picture().positions[0] - start;
  };
  EXPECT_LT(distance(1), 0.7f * distance(0));
  Page page;
  EXPECT_NE(page.refused({{"do", "set"}, {"key", "contact.friction"}, {"value", 1}}).find("cannot be changed"),
            std::string::npos);
}

TEST(ContactView, ScenesWithoutContactHaveNoContactPoints) {
  Page page;
  page.steps(1);
  EXPECT_TRUE(page.picture().contacts.empty());
  EXPECT_TRUE(page.obstacles().is_null());
}

// A plate that sinks onto the beam: contact points depend on the time of the obstacle.
TEST_F(RunRecording, HasTheContactPointsOfTheRun) {
  const std::filesystem::path directory = run("run", R"([[obstacle]]
name = "floor"
plane = { origin = [0, -0.001, 0] }
[[obstacle]]
name = "plate"
shape = { box = { lower = [0.5, 0.205, 0], upper = [0.9, 0.3, 0.2], cells = [2, 2, 2] } }
motion = { displacement = [0, "-0.1 * t", 0] }
)");
  const Decoded recorded(recording(directory).text);
  ASSERT_EQ(recorded.head["obstacles"].size(), 2U);
  EXPECT_EQ(recorded.head["obstacles"][0]["name"], "floor");
  const std::vector<float> at = recorded.array<float>("contact.at");
  const std::vector<uint32_t> point = recorded.array<uint32_t>("contact.point");
  Scene scene = load_scene(scene_of_run(directory));
  size_t next = 0;
  int of_bodies = 0;
  for (int frame = 0; frame < recorded.frame_count(); ++frame) {
    if (frame > 0) scene.simulation.step();
    const std::vector<ContactPoint> live =
        scene.simulation.model().contact->contact_points(scene.simulation.state().q, scene.simulation.obstacle_time());
    ASSERT_EQ(recorded.head["frames"]["contacts"][frame], live.size()) << frame;
    for (const ContactPoint& contact : live) {
      EXPECT_NEAR(at[4 * next + 1], contact.position[1], 1e-6);
      EXPECT_NEAR(at[4 * next + 3], contact.pressure, 1e-3 * contact.pressure + 1e-3);
      EXPECT_EQ(point[next] == kNoVertex, contact.row < 0);
      if (contact.row >= 0) {
        ++of_bodies;
        EXPECT_NEAR(recorded.positions(frame)[3 * point[next] + 1], contact.position[1], 1e-4);
      }
      ++next;
    }
  }
  EXPECT_EQ(point.size(), next);
  EXPECT_GT(of_bodies, 20);
  EXPECT_TRUE(Decoded(recording(run("free")).text).head["obstacles"].empty());
}

}  // namespace
}  // namespace aspic::viewer
