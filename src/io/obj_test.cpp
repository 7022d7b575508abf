#include "io/obj.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "io/mesh_file.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

MeshContent parse(const char* text) { return parse_obj("a.obj", text); }

std::string obj_error(const char* text) {
  try {
    parse(text);
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "";
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, FansPolygonsFromFirstCorner) {
  const MeshContent mesh = parse((kSquare + "f 1 2 3 4\n").c_str());
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Obj, CornersMayCarryTextureAndNormal) {
  const MeshContent mesh =
      parse((kSquare + "vt 0 0\nvn 0 0 1\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 3/1/1 4/1/1").c_str());
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Obj, NegativeIndicesCountBackFromLastVertex) {
  const MeshContent mesh = parse("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4 -2 -1\n");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Obj, CommentsGroupsMaterialsAndContinuedLinesAreAccepted) {
  const MeshContent mesh = parse(
      "\xef\xbb\xbf# made by hand\r\nmtllib a.mtl\r\no box\r\nv 0 0 0 1\r\nv 1 0 0 0.5 0.5 0.5\r\nv 1 \\\r\n 1 0 # "
      "corner\r\n"
      "g side\r\nusemtl red\r\ns off\r\nf 1 2\\\r\n 3\r\n");
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[2][1], 1);
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Obj, FacesMayPrecedeVertices) {
  EXPECT_THAT(parse(("f 1 2 3\n" + kSquare).c_str()).triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST(Obj, ErrorsNameFileLineValueAndRemedy) {
  EXPECT_EQ(obj_error("v 0 0 0\nv 0 x 0\n"), "a.obj:2: a vertex coordinate is 'x'; it must be a finite number");
  EXPECT_EQ(obj_error("v 0 0 0\nv nan 0 0\n"), "a.obj:2: a vertex coordinate is 'nan'; it must be a finite number");
  EXPECT_EQ(obj_error("v 0 0 0\nv 1e999 0 0\n"), "a.obj:2: a vertex coordinate is '1e999'; it must be a finite number");
  EXPECT_THAT(obj_error("v 0 0\nv 1 0 0\n"),
              HasSubstr("a.obj:1: the line ends where a vertex coordinate should follow"));
  EXPECT_THAT(obj_error((kSquare + "f 1 2 5\nf 1 2 3\n").c_str()), HasSubstr("a.obj:5: a corner names vertex 5"));
  EXPECT_THAT(obj_error((kSquare + "f 1 2 -5\n").c_str()), HasSubstr("a.obj:5: a corner names vertex -5 of 4"));
  EXPECT_THAT(obj_error((kSquare + "f 0 1 2\n").c_str()), HasSubstr("vertices count from 1"));
  EXPECT_THAT(obj_error((kSquare + "f 1 2\n").c_str()), HasSubstr("a.obj:5: a face has fewer than three corners"));
  EXPECT_THAT(obj_error("vertex 1 2 3\n"), HasSubstr("a.obj:1: unknown statement 'vertex'"));
}

TEST(Obj, NumbersBelowSmallestDoubleAreZero) { EXPECT_EQ(parse("v 1e-999 +2 -1E-400").vertices[0][0], 0); }

TEST(ObjUv, CornersHaveTheirOwnCoordinates) {
  const std::vector<TriangleCorners> uv = parse_obj_uv("a.obj",
                                                       "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt .5 0 0\nvt .5 "
                                                       "1\nvt 0 1\nf 1/1 2/2/1 3/3 4/4\nvt 2 2\nvt 3 2\nvt 2 3\nf 1/-3 "
                                                       "3/-2 4/7\n");
  ASSERT_EQ(uv.size(), 3);
  EXPECT_EQ(uv[1][0][0], 0);
  EXPECT_EQ(uv[1][1][1], 1);
  EXPECT_EQ(uv[1][2][0], 0);
  EXPECT_EQ(uv[2][1][0], 3);
}

TEST(ObjUv, RejectsFacesWithoutArea) {
  const auto refusal = [](const std::string& faces) {
    try {
      parse_obj_uv("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 2 0\n" + faces);
    } catch (const InvalidInput& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal("f 1 2 3\n"), HasSubstr("a.obj:7: a corner has no texture coordinates"));
  EXPECT_THAT(refusal("f 1//1 2//1 3//1\n"), HasSubstr("no texture coordinates"));
  EXPECT_THAT(refusal("f 1/1 2/2 3/4\n"), HasSubstr("names texture coordinates 4 of 3"));
  EXPECT_THAT(refusal("f 1/1 2/2 3/3\n"), HasSubstr("no area in its texture coordinates (0, 0), (1, 0), (2, 0)"));
  EXPECT_THAT(refusal("vt nan 0\nf 1/1 2/2 3/3\n"), HasSubstr("a.obj:7: "));
}

TEST(ObjTexture, IsReadBackAsWritten) {
  const TestFolder folder;
  const std::string file = folder.write("a.obj",
                                        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt .1 0 0\nvt -2 1e9\nf 1/1 2/2 "
                                        "3/3 4/2\n");
  std::vector<std::string> notes;
  const std::vector<TriangleUv> uv = read_texture(file, 2, notes);
  EXPECT_THAT(uv,
              ElementsAre(TriangleUv{{{0, 0}, {0.1F, 0}, {-2, 1e9F}}}, TriangleUv{{{0, 0}, {-2, 1e9F}, {0.1F, 0}}}));
  write_textured_mesh(folder / "b.obj", read_tri_mesh(file), uv);
  EXPECT_THAT(read_file(folder / "b.obj"), HasSubstr("vt 0 0\nvt 0.1 0\nvt -2 1e+09\nf 1/1 2/2 3/3\nf 1/1 3/3 4/2\n"));
  EXPECT_EQ(read_texture(folder / "b.obj", 2, notes), uv);
  EXPECT_THAT(notes, ElementsAre());
}

TEST(ObjTexture, DefectsAreNoted) {
  const TestFolder folder;
  const auto note = [&](const std::string& faces) {
    std::vector<std::string> notes;
    const auto file = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1e39 0\n" + faces);
    EXPECT_TRUE(read_texture(file, 1, notes).empty());
    return notes.empty() ? "" : notes.front();
  };
  EXPECT_EQ(note("f 1 2 3\n"), "");
  EXPECT_EQ(note("f 1//1 2//2 3//3\n"), "");
  EXPECT_THAT(note("f 1/1 2 3/1\n"), HasSubstr("a.obj:7: a corner has no texture coordinates"));
  EXPECT_THAT(note("f 1/1 2/0 3/1\nvt 0 0\n"), HasSubstr("a.obj:7: a corner has no texture coordinates"));
  EXPECT_THAT(note("f 1/1 2/-9 3/1\n"), HasSubstr("a.obj:7: a corner has no texture coordinates"));
  EXPECT_THAT(note("f 1/1 2/4 3/1\n"), HasSubstr("a.obj:7: a corner names texture coordinates 4 of 3"));
  EXPECT_THAT(note("f 1/1 2/2 3/3\n"), HasSubstr("exceeds single precision"));
  EXPECT_THAT(note("vt nan 0\nf 1/1 2/2 3/4\n"), HasSubstr("a.obj:7: a texture coordinate is 'nan'"));
  EXPECT_THAT(note("f 1/1 2/2 3/1\nf 1/1 2/2 3/1\n"), HasSubstr("changed"));
}

TEST(ObjLines, AreReadBackAsWritten) {
  const TestFolder folder;
  TetMesh rod{.rest = {{{0, 0, 0}}, {{0.1, 0, 1e-17}}, {{1, 1, 0}}}, .tets = {}, .region = {}};
  rod.rods = {{2, 0}, {0, 1}};
  EXPECT_FALSE(has_lines_only(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n")));
  write_line_mesh(folder / "rod.obj", rod);
  EXPECT_TRUE(has_lines_only(folder / "rod.obj"));
  const TetMesh again = read_line_mesh(folder / "rod.obj");
  for (size_t v = 0; v < 3; ++v)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(again.rest[v][k], rod.rest[v][k]);
  EXPECT_EQ(again.rods, rod.rods);
}

TEST(PlyLines, AreEdges) {
  const TestFolder folder;
  TetMesh rod{.rest = {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}, .tets = {}, .region = {}};
  rod.rods = {{2, 0}, {0, 1}};
  write_line_mesh(folder / "rod.ply", rod);
  const std::string bytes = read_file(folder / "rod.ply");
  EXPECT_THAT(bytes, HasSubstr("element vertex 3\n"));
  EXPECT_THAT(bytes, HasSubstr("element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n"));
  EXPECT_THAT(bytes, testing::EndsWith(std::string("\2\0\0\0\0\0\0\0\0\0\0\0\1\0\0\0", 16)));
}

}  // namespace
}  // namespace aspic
