#include "io/quadratic_content.h"

#include <gmock/gmock.h>

#include <sstream>

#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "io/mesh_file.h"
#include "io/vtu.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

using QuadraticFile = FolderTest;

TetMesh linear_box() { return make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 1, 1}); }

// One edge of length 0.5 along x has its node at a distance of 0.01.
TetMesh curved_box() {
  TetMesh mesh = raise_order(linear_box());
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int k = 0; k < 6; ++k) {
      const Vec3d edge = mesh.rest[mesh.tets[t][kTetEdges[k][1]]] - mesh.rest[mesh.tets[t][kTetEdges[k][0]]];
      if (edge[1] != 0 || edge[2] != 0) continue;
      mesh.rest[mesh.mids[t][k]][1] += 0.01;
      return mesh;
    }
  return mesh;
}

std::string points(const TetMesh& mesh, bool with_number, const std::string& after) {
  std::ostringstream text;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (with_number) text << v + 1 << ' ';
    text << mesh.rest[v][0] << ' ' << mesh.rest[v][1] << ' ' << mesh.rest[v][2] << after << '\n';
  }
  return text.str();
}

std::string gmsh_text(const TetMesh& mesh) {
  std::ostringstream text;
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"
       << mesh.vertex_count() << '\n'
       << points(mesh, true, "") << "$EndNodes\n$Elements\n"
       << mesh.tet_count() << '\n';
  constexpr int kGmshOrder[10] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  for (int t = 0; t < mesh.tet_count(); ++t) {
    text << t + 1 << " 11 2 0 1";
    const TetNodes nodes = nodes_of(mesh, t);
    for (const int n : kGmshOrder) text << ' ' << nodes[n] + 1;
    text << '\n';
  }
  return text.str() + "$EndElements\n";
}

std::string medit_text(const TetMesh& mesh) {
  std::ostringstream text;
  text << "MeshVersionFormatted 2\nDimension 3\nVertices " << mesh.vertex_count() << '\n'
       << points(mesh, false, " 0") << "TetrahedraP2 " << mesh.tet_count() << '\n';
  for (int t = 0; t < mesh.tet_count(); ++t) {
    for (const int v : nodes_of(mesh, t)) text << v + 1 << ' ';
    text << "0\n";
  }
  return text.str() + "End\n";
}

void expect_linear_box(const std::filesystem::path& path, std::vector<std::string>& notes) {
  const TetMesh expected = linear_box(), mesh = read_tet_mesh(path, &notes);
  EXPECT_EQ(mesh.tets, expected.tets) << path;
  ASSERT_EQ(mesh.vertex_count(), expected.vertex_count()) << path;
  for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(norm(mesh.rest[v] - expected.rest[v]), 0) << path;
}

TEST_F(QuadraticFile, IsStraightenedWithANote) {
  const TetMesh mesh = curved_box();
  write_file(folder / "a.msh", gmsh_text(mesh));
  write_file(folder / "a.mesh", medit_text(mesh));
  write_vtu(folder / "a.vtu", {mesh.rest[0].a, 3 * mesh.rest.size()}, mesh);
  for (const std::string name : {"a.msh", "a.mesh", "a.vtu"}) {
    std::vector<std::string> notes;
    expect_linear_box(folder / name, notes);
    EXPECT_THAT(notes, ElementsAre(AllOf(HasSubstr(name + ": quadratic tets"), HasSubstr("order = 2"),
                                         HasSubstr("1 of 33 edges are curved"), HasSubstr("0.01 m, 2 % of the edge"))));
  }
}

TEST_F(QuadraticFile, StraightEdgesAreNotReported) {
  write_file(folder / "a.msh", gmsh_text(raise_order(linear_box())));
  std::vector<std::string> notes;
  expect_linear_box(folder / "a.msh", notes);
  EXPECT_THAT(notes, ElementsAre(AllOf(HasSubstr("quadratic tets"), Not(HasSubstr("curved")))));
}

TEST(QuadraticContent, KeepsVerticesOfTriangles) {
  const TetMesh mesh = raise_order(linear_box());
  MeshContent content{mesh.rest, mesh.tets, {}, {{mesh.mids[0][0], mesh.mids[0][1], mesh.mids[0][2]}}, mesh.mids};
  remove_mid_nodes(content);
  EXPECT_EQ(static_cast<int>(content.vertices.size()), linear_box().vertex_count() + 3);
  EXPECT_EQ(norm(content.vertices[content.triangles[0][0]] - mesh.rest[mesh.mids[0][0]]), 0);
}

}  // namespace
}  // namespace aspic
