#include "io/usd.h"

#include <gmock/gmock.h>

#include <limits>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using UsdScene = FolderTest;

TEST_F(UsdScene, WritesOneMeshWithSampledPoints) {
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const UsdMesh mesh{"bunny", triangles, [](int sample) {
                       return std::vector<float>{0, 0, 0.1f, 1, static_cast<float>(-sample), 0, 0, 1, 0};
                     }};
  write_usd(path("a.usda"), {mesh}, {0, 0.03}, 1 / 0.03);
  EXPECT_EQ(read_file(path("a.usda")), R"(#usda 1.0
(
    defaultPrim = "simulation"
    metersPerUnit = 1
    upAxis = "Y"
    timeCodesPerSecond = 33.333333333333336
    framesPerSecond = 33.333333333333336
    startTimeCode = 0
    endTimeCode = 1
)

def Xform "simulation"
{
    def Mesh "bunny"
    {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        uniform token subdivisionScheme = "none"
        float3[] extent.timeSamples = {
            0: [(0, 0, 0), (1, 1, 0.1)],
            1: [(0, -1, 0), (1, 1, 0.1)],
        }
        point3f[] points.timeSamples = {
            0: [(0, 0, 0.1), (1, 0, 0), (0, 1, 0)],
            1: [(0, 0, 0.1), (1, -1, 0), (0, 1, 0)],
        }
    }
}
)");
  EXPECT_FALSE(std::filesystem::exists(path("a.usda.unfinished")));
}

TEST_F(UsdScene, NamesBecomeDistinctIdentifiers) {
  const auto none = [](int) { return std::vector<float>{}; };
  write_usd(path("a.usda"), {{"left leg", {}, none}, {"left-leg", {}, none}, {"2nd", {}, none}, {"", {}, none}}, {},
            25);
  const std::string text = read_file(path("a.usda"));
  for (const char* name : {"\"left_leg\"", "\"left_leg_2\"", "\"_2nd\"", "\"_\""}) EXPECT_THAT(text, HasSubstr(name));
}

TEST_F(UsdScene, WritesNonFiniteNumbersInUsdSyntax) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  write_usd(path("a.usda"), {{"x", {}, [&](int) { return std::vector<float>{-kNan, kInfinity, -kInfinity}; }}}, {0}, 1);
  EXPECT_THAT(read_file(path("a.usda")), HasSubstr("0: [(nan, inf, -inf)],"));
}

TEST_F(UsdScene, UpAxisFollowsGravity) {
  EXPECT_EQ(up_axis({{0, 0, -9.81}}), UpAxis::z);
  EXPECT_EQ(up_axis({{0, -9.81, 0}}), UpAxis::y);
  EXPECT_EQ(up_axis({{0, 0, 0}}), UpAxis::y);
  write_usd(path("a.usda"), {}, {0}, 1, {UpAxis::z});
  EXPECT_THAT(read_file(path("a.usda")), HasSubstr("upAxis = \"Z\""));
}

TEST_F(UsdScene, FailureKeepsOldFile) {
  put(path("a.usda"), "old");
  const auto fail = [](int) -> std::vector<float> { throw InvalidInput("no points"); };
  EXPECT_THROW(write_usd(path("a.usda"), {{"x", {}, fail}}, {0}, 1), InvalidInput);
  EXPECT_EQ(read_file(path("a.usda")), "old");
  EXPECT_FALSE(std::filesystem::exists(path("a.usda.unfinished")));
  EXPECT_THROW(write_usd(path("no/folder.usda"), {}, {0}, 1), InvalidInput);
}

TEST_F(UsdScene, RodsAreCurvesAndSheetsTwoSided) {
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const std::vector<Segment> segments = {{2, 0}, {3, 4}, {4, 1}, {1, 3}};  // a line and a ring
  const auto points = [](int) { return std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 2, 2, 0}; };
  write_usd(path("a.usda"),
            {{.name = "rope", .triangles = {}, .points = points, .segments = segments, .radius = 0.25},
             {.name = "cloth", .triangles = triangles, .points = points, .is_two_sided = true}},
            {0}, 1);
  const std::string text = read_file(path("a.usda"));
  EXPECT_THAT(text, HasSubstr(R"(    def BasisCurves "rope"
    {
        uniform token type = "linear"
        int[] curveVertexCounts = [2, 4]
        float[] widths = [0.5] (
            interpolation = "constant"
        )
        float3[] extent.timeSamples = {
            0: [(-0.25, -0.25, -0.25), (2.25, 2.25, 0.25)],
        }
        point3f[] points.timeSamples = {
            0: [(0, 1, 0), (0, 0, 0), (2, 0, 0), (2, 2, 0), (1, 0, 0), (2, 0, 0)],
        }
)"));
  EXPECT_THAT(text, HasSubstr("uniform bool doubleSided = 1\n"));
}

TEST_F(UsdScene, FixedMeshHasOneSample) {
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const auto points = [](int) { return std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}; };
  write_usd(path("a.usda"), {{"floor", triangles, points, true}}, {0, 1}, 1);
  const std::string text = read_file(path("a.usda"));
  EXPECT_THAT(text, HasSubstr("point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]"));
  EXPECT_THAT(text, testing::Not(HasSubstr("timeSamples")));
}

}  // namespace
}  // namespace aspic
