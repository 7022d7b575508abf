#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "io/folder_test.h"
#include "io/vtu.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Five points and three tets in two pieces that share the points 1, 2 and 3.
class VtuPieces : public FolderTest {
 protected:
  struct Part {
    std::vector<double> vertex;
    std::vector<Tet> corners;
    std::vector<double> tet;
  };

  void write(const std::string& name, const Part& part) const {
    std::vector<double> points, speed, volume;
    for (const double v : part.vertex) {
      points.insert(points.end(), {v, 10 * v, 100 * v});
      speed.insert(speed.end(), {v, -v, 0});
    }
    for (const double t : part.tet) volume.push_back(0.5 + t);
    const Field vertex{"vertex", 1, part.vertex, FieldType::int32}, tet{"tet", 1, part.tet, FieldType::int32};
    const VtuFields fields{.point_fields = {{"velocity", 3, speed}, vertex},
                           .cell_fields = {{"volume", 1, volume}, tet}};
    write_vtu(path(name), points, part.corners, fields);
  }

  void write_both(const Part& first, const Part& second) const {
    write("one.vtu", first);
    write("two.vtu", second);
    write_pvtu(path("frame.pvtu"), {"one.vtu", "two.vtu"}, {});
  }
  void write_valid() const { write_both({{1, 2, 3, 4}, {{0, 1, 2, 3}}, {1}}, kSecond); }

  std::string error() const {
    return message_of<InvalidInput>([&] { read_frame(path("frame.pvtu")); });
  }

  const Part kSecond = {{0, 1, 2, 3}, {{0, 1, 2, 3}, {1, 0, 2, 3}}, {0, 2}};
};

TEST_F(VtuPieces, MakeUpTheWhole) {
  write_valid();
  const Vtu whole = read_frame(path("frame.pvtu"));
  ASSERT_EQ(whole.mesh.vertex_count(), 5);
  for (int v = 0; v < 5; ++v) EXPECT_EQ(whole.mesh.rest[v][2], 100 * v);
  EXPECT_THAT(whole.mesh.tets, ElementsAre(Tet{0, 1, 2, 3}, Tet{1, 2, 3, 4}, Tet{1, 0, 2, 3}));
  ASSERT_EQ(whole.point_fields.size(), 1U);
  EXPECT_THAT(whole.point_fields[0].values, ElementsAre(0, 0, 0, 1, -1, 0, 2, -2, 0, 3, -3, 0, 4, -4, 0));
  ASSERT_EQ(whole.cell_fields.size(), 1U);
  EXPECT_THAT(whole.cell_fields[0].values, ElementsAre(0.5, 1.5, 2.5));
}

TEST_F(VtuPieces, RejectsGapsAndWrongNumbers) {
  write_both({{1, 2, 3, 6}, {{0, 1, 2, 3}}, {1}}, kSecond);
  EXPECT_THAT(error(), HasSubstr("no piece has the vertex 4"));
  write_both({{1, 2, 3, 4}, {{0, 1, 2, 3}}, {0}}, kSecond);
  EXPECT_THAT(error(), HasSubstr("no piece has the tet 1"));
  write_both({{1, 2, 3, 1e9}, {{0, 1, 2, 3}}, {1}}, kSecond);
  EXPECT_THAT(error(), HasSubstr("'vertex' has the value 1000000000"));
  write_both({{1, 2, 3, -1}, {{0, 1, 2, 3}}, {1}}, kSecond);
  EXPECT_THAT(error(), HasSubstr("'vertex' has the value -1"));
}

TEST_F(VtuPieces, RejectsMissingFilesAndFields) {
  write_valid();
  std::filesystem::remove(path("two.vtu"));
  EXPECT_THAT(error(), HasSubstr("two.vtu"));
  const std::vector<Tet> tet = {{0, 1, 2, 3}};
  write_vtu(path("two.vtu"), std::vector<double>(12, 0.0), tet, {});
  EXPECT_THAT(error(), HasSubstr("has no field 'vertex'"));
  write_pvtu(path("frame.pvtu"), {"../one.vtu"}, {});
  EXPECT_THAT(error(), HasSubstr("a piece needs a Source in the same folder"));
  write_pvtu(path("frame.pvtu"), {}, {});
  EXPECT_THAT(error(), HasSubstr("names no pieces"));
}

}  // namespace
}  // namespace aspic
