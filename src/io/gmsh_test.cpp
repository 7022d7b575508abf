#include "io/gmsh.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "io/mesh_examples_test.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t place = text.find(from);
  EXPECT_NE(place, text.npos) << from;
  return text.replace(place, from.size(), to);
}

std::string gmsh_error(const std::string& contents) {
  try {
    parse_gmsh("a.msh", contents);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "no error";
}

TEST(Gmsh, TagsMayHaveGaps) {
  for (const std::string& contents : {gmsh_22_text(), gmsh_41_text()})
    EXPECT_THAT(parse_gmsh("a.msh", contents).tets, ElementsAre(Tet{0, 1, 2, 3}, Tet{1, 2, 3, 4}));
}

TEST(Gmsh, TextAndBinaryOfBothVersionsAgree) {
  const MeshContent expected = parse_gmsh("a.msh", gmsh_41_text());
  for (const std::string& contents : {gmsh_22_binary(), gmsh_41_binary()}) {
    const MeshContent mesh = parse_gmsh("a.msh", contents);
    EXPECT_EQ(mesh.region, expected.region);
    for (size_t v = 0; v < 5; ++v)
      for (int i = 0; i < 3; ++i) EXPECT_EQ(mesh.vertices.at(v)[i], expected.vertices.at(v)[i]);
  }
}

TEST(Gmsh, LabelsTetsWithoutGroupByEntity) {
  std::string text = replaced(gmsh_41_text(), "1 0 0 0 1 1 1 1 7 1 1", "1 0 0 0 1 1 1 0 1 1");
  EXPECT_THAT(parse_gmsh("a.msh", text).region, ElementsAre(1, 9));
  text = replaced(text, "2 0 0 0 1 1 1 2 9 8 1 1", "2 0 0 0 1 1 1 0 1 1");
  EXPECT_THAT(parse_gmsh("a.msh", text).region, ElementsAre(1, 2));
  text = replaced(text, "3 2 4 1\n9", "3 1 4 1\n9");
  EXPECT_THAT(parse_gmsh("a.msh", text).region, ElementsAre()) << "one entity labels nothing";
}

TEST(Gmsh, SplitsQuadranglesWithoutTets) {
  const MeshContent mesh =
      parse_gmsh("a.msh",
                 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 "
                 "0\n$EndNodes\n$Elements\n1\n1 3 0 1 2 3 4\n$EndElements\n");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Gmsh, RejectsUnsupportedSolidElements) {
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "5 4 4 9", "5 29 4 9")),
              HasSubstr("a.msh:24: the mesh has 20-node tets (third order), which are not read; export it"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_41_text(), "3 2 4 1\n9 20 30 40 50", "3 2 6 1\n9 20 30 40 50 10 20")),
              HasSubstr("6-node prisms"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "5 4 4 9", "5 77 4 9")), HasSubstr("element type 77 is unknown"));
}

TEST(Gmsh, SkipsSecondOrderTrianglesOnlyBesideTets) {
  const std::string text = replaced(gmsh_22_text(), "3 2 2 1 1 1 2 4", "3 9 2 1 1 1 2 4 1 2 4");
  EXPECT_EQ(parse_gmsh("a.msh", text).tets.size(), 2u);
  EXPECT_THAT(gmsh_error("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 1 1 0\n$EndNodes\n"
                         "$Elements\n1\n1 9 0 1 2 3 1 2 3\n$EndElements\n"),
              HasSubstr("6-node triangles (second order)"));
}

TEST(Gmsh, Version1NamesItselfAndRemedy) {
  EXPECT_THAT(gmsh_error("$NOD\n4\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n"),
              HasSubstr("a.msh:1: this is Gmsh 1 ($NOD), which is not read; save it again with 'gmsh IN.msh"));
}

TEST(Gmsh, ReadsParametricNodes) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n5\n1 0 0 0 0 1\n2 1 0 0 1 2 0.25\n"
      "3 0 1 0 2 3 0.5 0.75\n4 0 0 1 3 1\n5 1 1 1 3 1\n$EndParametricNodes\n"
      "$Elements\n2\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 2 3 4 5\n$EndElements\n";
  const MeshContent mesh = parse_gmsh("a.msh", text);
  ASSERT_EQ(mesh.vertices.size(), 5u);
  EXPECT_EQ(mesh.vertices[2][1], 1);
  EXPECT_THAT(mesh.tets, ElementsAre(Tet{0, 1, 2, 3}, Tet{1, 2, 3, 4}));
}

TEST(Gmsh, NamesSurfacesAndRegions) {
  const MeshGroups groups = parse_gmsh("a.msh", gmsh_22_text()).groups;
  ASSERT_EQ(groups.surfaces.size(), 1u);
  EXPECT_EQ(groups.surfaces[0].name, "skin");
  EXPECT_EQ(groups.surfaces[0].label, 1);
  EXPECT_THAT(groups.surfaces[0].triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(groups.region_names, ElementsAre(testing::Pair(7, "muscle tissue")));
}

TEST(Gmsh, SurfacesOfSecondOrderAreGroups) {
  const std::string text = replaced(gmsh_22_text(), "3 2 2 1 1 1 2 4", "3 9 2 1 1 1 2 4 8 9 20");
  const MeshContent mesh = parse_gmsh("a.msh", text);
  ASSERT_EQ(mesh.groups.surfaces.size(), 1u);
  EXPECT_THAT(mesh.groups.surfaces[0].triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Gmsh, TriangleBelongsToEveryGroupOfItsEntity) {
  // $Entities of version 4.1: surface 1 is in the groups -5 (reversed) and 6.
  const std::string text =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 5 \"outlet\"\n$EndPhysicalNames\n"
      "$Entities\n0 0 1 1\n1 0 0 0 1 1 0 2 -5 6 0\n1 0 0 0 1 1 1 0 0\n$EndEntities\n"
      "$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n"
      "$Elements\n2 2 1 2\n2 1 2 1\n1 1 2 3\n3 1 4 1\n2 1 2 3 4\n$EndElements\n";
  const MeshGroups groups = parse_gmsh("a.msh", text).groups;
  ASSERT_EQ(groups.surfaces.size(), 2u);
  EXPECT_EQ(groups.surfaces[0].label, 5);
  EXPECT_EQ(groups.surfaces[0].name, "outlet");
  EXPECT_EQ(groups.surfaces[1].label, 6);
  EXPECT_THAT(groups.surfaces[1].triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Gmsh, ErrorsNameLineOrByte) {
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "4 0 1 0", "4 0 nan 0")),
              HasSubstr("a.msh:13: a node's coordinate is 'nan'"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "\n6\n1 0", "\n7\n1 0")), HasSubstr("a.msh:17: the tag of a node"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "\n6\n1 0", "\n5\n1 0")),
              HasSubstr("'20' where '$EndNodes' should be"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "\n6\n1 0", "\n2000000000\n1 0")), HasSubstr("has room for at most"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "1 1 2 4 8\n", "1 1 2 4 3\n")),
              HasSubstr("a.msh:23: an element names node 3"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "\n8 0 0 1", "\n2 0 0 1")), HasSubstr("two nodes have the tag 2"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_22_text(), "2.2 0 8", "4 0 8")), HasSubstr("a.msh:2: version 4.0 is not read"));
  EXPECT_THAT(gmsh_error(replaced(gmsh_41_text(), "3 1 0 2\n", "3 1 0 1\n")), HasSubstr("a.msh:"));
  EXPECT_THAT(gmsh_error(gmsh_41_binary().substr(0, 300)), HasSubstr("a.msh: byte "));
  EXPECT_THAT(gmsh_error(replaced(gmsh_41_text(), "$Entities", "$PartitionedEntities")), HasSubstr("partitioned"));
  EXPECT_THAT(gmsh_error("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Elements\n0\n$EndElements\n"),
              HasSubstr("before $Nodes"));
}

}  // namespace
}  // namespace aspic
