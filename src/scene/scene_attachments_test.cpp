#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/parallel.h"
#include "contact/barrier.h"
#include "energy/attachment.h"
#include "scene/scene.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string attached_sheet(const std::string& name, const Vec3d& at, const std::string& more = "") {
  return "[[body]]\nname = \"" + name + "\"\nshape = { rectangle = { width = 0.3, height = 0.4, size = 0.05 } }\n" +
         "translate = [" + number_text(at[0]) + ", " + number_text(at[1]) + ", " + number_text(at[2]) + "]\n" +
         "shell = { thickness = 1e-3 }\nmaterial = { density = 300 }\n" + more;
}
std::string sheet_box(const std::string& more = "") {
  return "[[body]]\nname = \"box\"\nshape = { box = { upper = [0.4, 0.4, 0.4], cells = [3, 3, 3] } }\n" + more;
}

const std::string kHangs = "pin = { where = { highest = 0 } }\n";
const std::string kSeam =
    "[[attach]]\npoints = { body = \"front\", where = \"abs(x) > 0.1499\" }\n"
    "to = { body = \"back\", where = \"abs(x) > 0.1499\" }\n";
// Two sheets 2 cm apart that are sewn along their sides. One hangs, the other has no pins.
const std::string kTube = attached_sheet("front", {}, kHangs) + attached_sheet("back", {{0, 0.01, -0.02}}) + kSeam;
const std::string kSheetOnBox = "[[attach]]\npoints = { body = \"front\", where = \"all\" }\nto = { body = \"box\" }\n";

const Attachment& attachment_of(const Scene& scene) {
  for (const auto& load : scene.simulation.model().loads)
    if (const auto* attachment = dynamic_cast<const Attachment*>(load.get())) return *attachment;
  throw InvalidInput("no attachment");
}

double lowest_of(const Scene& scene, const std::string& body) {
  double lowest = INFINITY;
  for (const BodyRange& range : scene.simulation.model().bodies)
    for (int v = range.first_vertex; v < range.first_vertex + range.vertex_count; ++v)
      if (range.name == body) lowest = std::min(lowest, scene.simulation.state().q[3 * v + 1]);
  return lowest;
}

TEST(SceneAttachments, SewnSheetsHangTogether) {
  Scene scene = load(kTube + "[time]\nduration = 0.3\n");
  EXPECT_NEAR(scene.simulation.start_report().attachment_gap, 0.022, 1e-3);
  StepReport report;
  for (int i = 0; i < scene.steps; ++i) report = scene.simulation.step();
  EXPECT_TRUE(is_success(report.status));
  EXPECT_LT(report.attachment_gap, 0.002);  // the sheet that hangs from the seam weighs 0.35 N; k = 100 N/m
  EXPECT_NEAR(lowest_of(scene, "back"), lowest_of(scene, "front"), 0.01);
  EXPECT_GT(lowest_of(scene, "back"), -0.22);  // -0.63 in free fall
}

TEST(SceneAttachments, SheetFollowsSolid) {
  Scene scene = load("gravity = [0, 0, 0]\n" +
                     sheet_box("pin = { where = { lowest = 0 }, motion = { displacement = [\"t\", 0, 0] } }\n") +
                     attached_sheet("front", {{0.2, 0.2, 0.41}}) + kSheetOnBox + "gap = \"keep\"\n");
  for (int i = 0; i < 20; ++i) scene.simulation.step();
  double mean = 0;
  const BodyRange& sheet = scene.simulation.model().bodies[1];
  for (int v = sheet.first_vertex; v < sheet.first_vertex + sheet.vertex_count; ++v)
    mean += (scene.simulation.state().q[3 * v] - scene.simulation.model().mesh.rest[v][0]) / sheet.vertex_count;
  EXPECT_NEAR(mean, scene.simulation.state().time, 0.05);
}

TEST(SceneAttachments, TargetIsNearestPoint) {
  for (const char* order : {"order = 1\n", "order = 2\n"})
    for (const double height : {0.45, 0.123}) {  // above the box, and inside
      const Scene scene = load(sheet_box(order) + attached_sheet("front", {{0.2, 0.2, height}}) + kSheetOnBox);
      for (const AttachedVertex& a : attachment_of(scene).attached()) {
        const Vec3d d = a.separation(scene.simulation.state().q);
        EXPECT_LT(norm(d - Vec3d{{0, 0, std::max(0.0, height - 0.4)}}), 1e-14);
        EXPECT_NEAR(a.weight[0] + a.weight[1] + a.weight[2] + a.weight[3], 1, 1e-15);
        EXPECT_GE(*std::min_element(a.weight.begin(), a.weight.end()), 0);
      }
    }
}

// The other border has edges of another length.
TEST(SceneAttachments, SeamUsesSelectedBorder) {
  const Scene scene = load(attached_sheet("front", {}) + attached_sheet("back", {{0.31, 0.013, 0}}) +
                           "[[attach]]\npoints = { body = \"front\", where = \"x > 0.1499 && abs(y) < 0.18\" }\n"
                           "to = { body = \"back\", where = \"x < 0.1601\" }\n");
  for (const AttachedVertex& a : attachment_of(scene).attached()) {
    EXPECT_EQ(a.count, 2);
    EXPECT_LT(norm(a.separation(scene.simulation.state().q) - Vec3d{{-0.01, 0, 0}}), 1e-15);
    EXPECT_DOUBLE_EQ(a.stiffness, 100);
  }
}

TEST(SceneAttachments, SeamClosesToContactDistance) {
  const Scene scene = load(kTube + "[contact]\nreach = 2e-3\n");
  for (const AttachedVertex& a : attachment_of(scene).attached()) EXPECT_DOUBLE_EQ(a.rest_length, 3e-3);
  const Scene without = load(kTube);
  for (const AttachedVertex& a : attachment_of(without).attached()) EXPECT_EQ(a.rest_length, 0);
}

TEST(SceneAttachments, ResolvedSceneHasEqualBitsForThreads) {
  const int before = thread_count();
  std::vector<std::uint64_t> hashes;
  std::string text = kTube;
  for (const int threads : {1, 4}) {
    set_thread_count(threads);
    Scene scene = load(text);
    for (int i = 0; i < 3; ++i) scene.simulation.step();
    hashes.push_back(scene.simulation.state_hash());
    text = scene.resolved;
  }
  set_thread_count(before);
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(SceneAttachments, RefusesUnknownBodiesAndEmptySelections) {
  const std::string seam = "[[attach]]\npoints = { body = \"front\", where = \"x > 9\" }\nto = { body = \"backk\" }\n";
  const std::string bodies = attached_sheet("front", {}) + attached_sheet("back", {{0, 0, 0.01}});
  EXPECT_THAT(refusal(bodies + seam), AllOf(HasSubstr("beam.toml:15:15: body = \"backk\"; there is no such body"),
                                            HasSubstr("did you mean 'back'?")));
  EXPECT_THAT(refusal(bodies + seam, {"attach.to.body=back"}), HasSubstr("selects no vertex of body 'front'"));
}

TEST(SceneAttachments, RefusesDistantVertices) {
  EXPECT_THAT(
      refusal(kTube + "distance = 0.02\n"),
      AllOf(HasSubstr("beam.toml:17:12: vertex 0 of body 'front' at "), HasSubstr("is 0.0224 m from body 'back'"),
            HasSubstr("beyond distance = 0.02, as "), HasSubstr("set distance = 0.0226)")));
  EXPECT_THAT(refusal(attached_sheet("front", {}) + attached_sheet("back", {{0, 0, 0.2}}) + kSeam),
              HasSubstr(", its mean edge, as 20 of 20 vertices are"));
}

TEST(SceneAttachments, RefusesBodyAttachedToItself) {
  const std::string points =
      attached_sheet("front", {}) + "[[attach]]\npoints = { body = \"front\", where = \"x > 0\" }\n";
  EXPECT_THAT(refusal(points + "to = { body = \"front\" }\n"), HasSubstr("'front' is attached to itself"));
  EXPECT_THAT(refusal(points + "to = { body = \"front\", where = \"x > 0.14\" }\n"),
              HasSubstr("is selected in `points` and in `to`; exclude it from one of them"));
  EXPECT_EQ(refusal(points + "to = { body = \"front\", where = \"x < -0.14\" }\ndistance = 1\n"), "");
}

TEST(SceneAttachments, InelasticBodiesNeedStiffness) {
  const std::string cubes =
      kCube + "elastic = false\n[[body]]\nname = \"other\"\nelastic = false\n" +
      "shape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\ntranslate = [1, 0, 0]\n" +
      "[[attach]]\npoints = { body = \"cube\", where = \"x > 0.99\" }\nto = { body = \"other\" }\n";
  EXPECT_THAT(refusal(cubes), HasSubstr("has no default stiffness; set stiffness [N/m]"));
  EXPECT_EQ(refusal(cubes + "stiffness = 5\n"), "");
}

const std::string kSpin = "motion = { rotate = { axis = [0, 1, 0], rate_deg = 90, center = [0, 0, 0] } }\n";
const std::string kFlagOnArm =
    "[contact]\n[[obstacle]]\nname = \"arm\"\nshape = { box = { lower = [-0.1, 0, -0.1], upper = [0.1, 0.1, 0.1], "
    "cells = [2, 1, 2] } "
    "}\n" +
    kSpin + attached_sheet("flag", {{0.26, 0, 0}});
const std::string kToArm =
    "[[attach]]\npoints = { body = \"flag\", where = \"x < 0.12\" }\nto = { obstacle = \"arm\" }\n";

TEST(SceneAttachments, VerticesOnObstacleArePinsWithItsMotion) {
  Scene attached = load(kFlagOnArm + kToArm),
        pinned = load(kFlagOnArm + "[[body.pin]]\nwhere = \"x < 0.12\"\n" + kSpin);
  Scene resolved = load(attached.resolved);
  for (Scene* scene : {&attached, &pinned, &resolved})
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(is_success(scene->simulation.step().status));
  EXPECT_EQ(attached.simulation.state().q, pinned.simulation.state().q);
  EXPECT_EQ(attached.simulation.state().q, resolved.simulation.state().q);
}

TEST(SceneAttachments, RefusesWhatObstaclesCannotDo) {
  EXPECT_THAT(refusal(kFlagOnArm + kToArm, {"attach.to.obstacle=armm"}), HasSubstr("did you mean 'arm'?"));
  EXPECT_THAT(refusal(kFlagOnArm + kToArm, {"attach.points.body=flags"}), HasSubstr("did you mean 'flag'?"));
  EXPECT_THAT(refusal(kFlagOnArm + kToArm + "gap = \"keep\"\n"), HasSubstr("gap is for springs between bodies"));
  EXPECT_THAT(refusal(kFlagOnArm + kToArm, {"obstacle.arm.motion={ rotate = { axis = [0, 1, 0], rate_deg = 90 } }"}),
              HasSubstr("rotate has no center, which body 'flag' needs"));
  EXPECT_THAT(refusal(kFlagOnArm + "[[attach]]\npoints = { body = \"flag\", where = \"all\" }\nto = { obstacle = "
                                   "\"arm\", where = \"all\" }\n"),
              HasSubstr("excludes where"));
}

}  // namespace
}  // namespace aspic
