#include <gmock/gmock.h>

#include "io/folder_test.h"
#include "io/number_text.h"
#include "io/ply.h"

namespace aspic {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kPaintedHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty double stiff\nproperty float y\n"
    "property float z\nproperty list uchar int tags\nproperty uchar pin\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";
constexpr const char* kFace = "3 0 1 2\n";

std::string text(const std::string& first_value) {
  return kPaintedHead + ("0 " + first_value) + " 0 0 0 1\n1 -2 0 0 2 7 8 0\n0 1e3 1 0 0 255\n" + kFace;
}

TEST(PaintedPly, ReadsAttributeBesideCoordinates) {
  const PaintedSurface painted = parse_painted_ply("a.ply", text("0.25"), "stiff");
  EXPECT_THAT(painted.value, ElementsAre(0.25, -2, 1000));
  EXPECT_EQ(painted.surface.vertices[2][1], 1);
  EXPECT_EQ(painted.surface.triangle_count(), 1);
  EXPECT_THAT(parse_painted_ply("a.ply", text("0"), "pin").value, ElementsAre(1, 0, 255));
}

TEST(PaintedPly, ReadsBinaryAttribute) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float w\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const float x : {0.f, 0.f, 0.f, 0.5f, 1.f, 0.f, 0.f, 0.25f, 0.f, 1.f, 0.f, 1.f}) append_bytes(bytes, x);
  append_bytes(bytes, uint8_t{3});
  for (const int32_t v : {0, 1, 2}) append_bytes(bytes, v);
  EXPECT_THAT(parse_painted_ply("a.ply", bytes, "w").value, ElementsAre(0.5, 0.25, 1));
  EXPECT_THAT(message_of([&] { parse_painted_ply("a.ply", bytes.substr(0, bytes.size() - 14), "w"); }),
              HasSubstr("a.ply"));
}

TEST(PaintedPly, RefusesMissingAndBadAttributes) {
  const auto refused = [](const std::string& contents, const std::string& name) {
    return message_of([&] { parse_painted_ply("a.ply", contents, name); });
  };
  EXPECT_THAT(refused(text("0"), "stif"), AllOf(HasSubstr("a.ply"), HasSubstr("did you mean 'stiff'?")));
  EXPECT_THAT(refused(text("0"), "mass"), HasSubstr("known: stiff, pin"));
  EXPECT_THAT(refused(text("0"), "tags"), HasSubstr("no number 'tags'"));
  EXPECT_THAT(refused(text("0"), "x"), HasSubstr("no number 'x'"));
  EXPECT_THAT(refused(text("nan"), "stiff"), AllOf(HasSubstr("a.ply:13"), HasSubstr("'stiff'"), HasSubstr("nan")));
  EXPECT_THAT(refused(text("inf"), "stiff"), HasSubstr("'stiff'"));
  std::string huge = text("0");
  huge.replace(huge.find("vertex 3"), 8, "vertex 2000000000");
  EXPECT_THAT(refused(huge, "stiff"), HasSubstr("2000000000"));
  std::string twice = text("0");
  twice.replace(twice.find("uchar pin"), 9, "uchar stiff");
  EXPECT_THAT(refused(twice, "stiff"), HasSubstr("several properties 'stiff'"));
  EXPECT_THAT(refused("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
                      "property float w\nend_header\n",
                      "w"),
              HasSubstr("no faces"));
}

}  // namespace
}  // namespace aspic
