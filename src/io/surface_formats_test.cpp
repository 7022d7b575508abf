// OFF, PLY and STL: variants of other programs, and rejected files.
#include <gmock/gmock.h>

#include <bit>

#include "base/error.h"
#include "io/mesh_examples_test.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

template <MeshContent (*parse)(const std::string&, std::string_view)>
std::string surface_error(const std::string& contents) {
  try {
    parse("a", contents);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "no error";
}

TEST(Off, PolygonsAreFannedAndColorsSkipped) {
  const MeshContent mesh =
      parse_off("a", "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0 255 0 0\n0 1 0\n0 2 0\n5 0 1 2 3 4 1 1 1\n3 0 1 2\n");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4}, Triangle{0, 1, 2}));
}

TEST(Off, ErrorsNameLine) {
  EXPECT_THAT(surface_error<parse_off>("OFF\n3 1 0\n0 0 0\n1 0 0\n1 1\n3 0 1 2\n"),
              HasSubstr("a:5: the line ends where"));
  EXPECT_THAT(surface_error<parse_off>("OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 3\n"),
              HasSubstr("a:6: a corner of a face is 3; it must be from 0 to 2"));
  EXPECT_THAT(surface_error<parse_off>("OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n2 0 1\n"),
              HasSubstr("a:6: a face has fewer than three"));
  EXPECT_THAT(surface_error<parse_off>("OFF BINARY\n"), HasSubstr("binary OFF is not read"));
  EXPECT_THAT(surface_error<parse_off>("4OFF\n"), HasSubstr("not three-dimensional"));
  EXPECT_THAT(surface_error<parse_off>("ply\n"), HasSubstr("a:1: found 'ply' where 'OFF' should be"));
}

TEST(Ply, TextAndBothByteOrdersGiveSameMesh) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const MeshContent mesh = parse_ply("a", binary_ply(order));
    EXPECT_EQ(mesh.vertices.at(3)[0], 1.5);
    EXPECT_EQ(mesh.vertices.at(3)[1], 0.75);
    EXPECT_EQ(mesh.vertices.at(3)[2], -3);
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{3, 1, 0}));
  }
  EXPECT_THAT(parse_ply("a", ascii_ply()).triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 2}));
}

std::string small_ply(const std::string& header, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

TEST(Ply, ErrorsNameLine) {
  const std::string vertices = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_THAT(surface_error<parse_ply>(small_ply(vertices, "0 inf 0\n")),
              HasSubstr("a:8: a vertex coordinate is 'inf'"));
  EXPECT_THAT(surface_error<parse_ply>(small_ply(vertices + faces, "0 0 0\n3 0 0 1\n")),
              HasSubstr("a:11: a corner of a face is 1, but there are 1"));
  EXPECT_THAT(surface_error<parse_ply>(small_ply(vertices + faces, "0 0 0\n-3 0 0 0\n")),
              HasSubstr("the length of a list is -3"));
  EXPECT_THAT(surface_error<parse_ply>(small_ply("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n")),
              HasSubstr("no property 'z'"));
  EXPECT_THAT(surface_error<parse_ply>(small_ply(
                  "element vertex 9000000000\nproperty float x\nproperty float y\nproperty float z\n", "0 0 0\n")),
              HasSubstr("has room for at most"));
  EXPECT_THAT(surface_error<parse_ply>(small_ply("element vertex 1\nproperty flaot x\n", "")),
              HasSubstr("a:4: the type of a property is 'flaot' (did you mean 'float'?)"));
  EXPECT_THAT(surface_error<parse_ply>(
                  small_ply(vertices + "element tristrips 1\nproperty list int int vertex_indices\n", "0 0 0\n")),
              HasSubstr("triangle strips"));
  EXPECT_THAT(surface_error<parse_ply>(small_ply(vertices + faces + vertices, "0 0 0\n3 0 0 0\n0 0 0\n")),
              HasSubstr("a second element 'vertex'"));
  EXPECT_THAT(surface_error<parse_ply>(small_ply("element b\001d 9\nproperty float x\n", "")),
              HasSubstr("a:6: the number of elements 'b\\x01d' is 9"));
}

TEST(Ply, ElementWithoutPropertiesNeedsNoTime) {
  EXPECT_EQ(parse_ply("a", small_ply("element nothing 9223372036854775807\n", "")).vertices.size(), 0u);
}

TEST(Stl, MergesCornersAtSamePosition) {
  for (const std::string head : {"exported", "solid exported"}) {
    const MeshContent mesh = parse_stl("a", binary_stl(head));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 3}));
  }
}

TEST(Stl, MayEndWithEndSolid) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_EQ(
      parse_stl("a", "solid part\n" + facet + "end solid part\nsolid b\n" + facet + "END SOLID\n").triangles.size(),
      2u);
  EXPECT_THAT(surface_error<parse_stl>("solid part\n" + facet + "end\n"), HasSubstr("'endsolid' should follow"));
}

TEST(Stl, ErrorsNameLineOrSize) {
  EXPECT_THAT(surface_error<parse_stl>("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nvertex 1 0 0\n"),
              HasSubstr("a:5: a vertex coordinate is 'vertex'"));
  EXPECT_THAT(
      surface_error<parse_stl>("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"),
      HasSubstr("a:6: found 'endloop' where 'vertex' should be"));
  EXPECT_THAT(surface_error<parse_stl>(binary_stl("exported") + "x"),
              HasSubstr("states 2 triangles, that is 184 bytes, but the file has 185"));
  EXPECT_THAT(surface_error<parse_stl>("v 0 0 0"), HasSubstr("is this an STL file?"));
  std::string infinite = binary_stl("exported");
  infinite.replace(84 + 12, 4, raw(std::numeric_limits<float>::infinity()));
  EXPECT_THAT(surface_error<parse_stl>(infinite), HasSubstr("a: byte 100: a vertex coordinate is infinite"));
}

}  // namespace
}  // namespace aspic
