// Medit and TetGen: variants of other programs, and rejected files.
#include <gmock/gmock.h>

#include "base/error.h"
#include "io/medit.h"
#include "io/mesh_examples_test.h"
#include "io/tetgen.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string error(auto&& action) {
  try {
    action();
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "no error";
}

std::string medit_error(const std::string& contents) {
  return error([&] { parse_medit("a.mesh", contents); });
}

const std::string kHead = "MeshVersionFormatted 2 Dimension 3\n";
const std::string kVertices = "Vertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";

TEST(Medit, AcceptsSectionsInAnyOrder) {
  const MeshContent mesh = parse_medit("a.mesh", medit_tets_first());
  EXPECT_THAT(mesh.tets, ElementsAre(Tet{0, 1, 2, 3}, Tet{1, 2, 3, 4}));
  EXPECT_THAT(mesh.region, ElementsAre(7, 9));
}

TEST(Medit, ReferenceZeroOnEveryTetIsNoLabel) {
  EXPECT_TRUE(parse_medit("a.mesh", kHead + kVertices + "Tetrahedra 1 1 2 3 4 0 End").region.empty());
}

TEST(Medit, QuotedNamesMayContainBlanksAndKeywords) {
  const MeshContent mesh =
      parse_medit("a", "MeshVersionFormatted 1\nGeometry\n\"my Vertices file.mesh\"\n" + medit_tets_first().substr(23));
  EXPECT_EQ(mesh.tets.size(), 2u);
}

TEST(Medit, ReferencesOfTrianglesAreSurfaces) {
  const MeshGroups groups = parse_medit("a", medit_tets_first()).groups;
  ASSERT_EQ(groups.surfaces.size(), 1u);
  EXPECT_EQ(groups.surfaces[0].label, 1);
  EXPECT_THAT(groups.surfaces[0].triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Medit, QuadrilateralsAreSplit) {
  EXPECT_THAT(parse_medit("a.mesh", kHead + kVertices + "Quadrilaterals 1 1 2 3 4 0").triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Medit, ErrorsNameLine) {
  EXPECT_THAT(medit_error("MeshVersionFormatted 1\nDimension 2\n"),
              HasSubstr("a.mesh:2: the mesh is not three-dimensional"));
  EXPECT_THAT(medit_error(kHead + kVertices + "Tetrahedra 1\n1 2 3 5 0\n"),
              HasSubstr("a.mesh:8: a corner is 5; it must be from 1 to 4"));
  EXPECT_THAT(medit_error(kHead + kVertices + "Tetraedra 1\n1 2 3 4 0\n"),
              HasSubstr("unknown keyword 'Tetraedra' (did you mean 'Tetrahedra'?)"));
  EXPECT_THAT(medit_error(kHead + kVertices + "Hexahedra 1\n1 2 3 4 1 2 3 4 0\n"), HasSubstr("the mesh has hexahedra"));
  EXPECT_THAT(medit_error(kHead + kVertices + kVertices), HasSubstr("a.mesh:7: a second section 'Vertices'"));
  EXPECT_THAT(medit_error(kHead + "Vertices 1\n0 nan 0 0\n"),
              HasSubstr("a.mesh:3: a number is 'nan'; it must be finite"));
  EXPECT_THAT(medit_error(kHead + "Vertices 1000000000\n0 0 0 0\n"), HasSubstr("has room for at most"));
  EXPECT_THAT(medit_error(kHead), HasSubstr("no 'Vertices'"));
  EXPECT_THAT(medit_error("solid"), HasSubstr("is this a Medit .mesh file?"));
}

MeshContent tetgen(const std::string& node, const std::string& ele) {
  return parse_tetgen("a.node", node, "a.ele", ele);
}
std::string tetgen_error(const std::string& node, const std::string& ele) {
  return error([&] { tetgen(node, ele); });
}

const std::string kNode0 =
    "# by hand\n\n4 3 1 1 # four\n0 0 0 0 0.5 1\n1 1 0 0 0.5 1\n2 0 1 0 0.5 1\n3 0 0 1 0.5 1 # last\n";
const std::string kNode1 = "4 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";

TEST(Tetgen, NumbersFrom0OrFrom1) {
  EXPECT_THAT(tetgen(kNode0, "1 4 0\n0 0 1 2 3\n").tets, ElementsAre(Tet{0, 1, 2, 3}));
  EXPECT_THAT(tetgen(kNode1, "1 4 0\n1 1 2 3 4\n").tets, ElementsAre(Tet{0, 1, 2, 3}));
}

TEST(Tetgen, FirstAttributeIsRegion) {
  EXPECT_THAT(tetgen(kNode0, "2 4 2\n0 0 1 2 3 -5 0.5\n1 0 1 2 3 6.0 1\n").region, ElementsAre(-5, 6));
  EXPECT_THAT(tetgen(kNode0, "1\n0 0 1 2 3\n").region, ElementsAre());
}

TEST(Tetgen, ErrorsNameFileAndLine) {
  EXPECT_THAT(tetgen_error(kNode1, "1 4 0\n1 0 1 2 3\n"),
              HasSubstr("a.ele:2: a corner of a tet is 0; it must be from 1 to 4"));
  EXPECT_THAT(tetgen_error(kNode1, "1 4 0\n1 1 2 3\n"), HasSubstr("a.ele:2: the line ends where a corner"));
  EXPECT_THAT(tetgen_error(kNode1, "1 10 0\n1 1 2 3 4 1 2 3 4 1 2\n"), HasSubstr("10-node tets"));
  EXPECT_THAT(tetgen_error(kNode1, "1 4 1\n1 1 2 3 4 0.5\n"), HasSubstr("'0.5'; a region label is a whole number"));
  EXPECT_THAT(tetgen_error("2 3\n1 0 0 0\n3 0 0 0\n", "0 4\n"),
              HasSubstr("a.node:3: the number of a vertex is 3 where 2 should be"));
  EXPECT_THAT(tetgen_error("2 3\n1 0 0\n2 0 0 0\n", "0 4\n"),
              HasSubstr("a.node:2: the line ends where a vertex coordinate"));
  EXPECT_THAT(tetgen_error("2 2\n1 0 0\n2 0 0\n", "0 4\n"), HasSubstr("not three-dimensional"));
}

}  // namespace
}  // namespace aspic
