#include "io/mesh_file.h"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <bit>
#include <cmath>
#include <limits>

#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "io/mesh_examples_test.h"
#include "mesh/generators.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using MeshFile = FolderTest;

std::vector<uint64_t> bits(const std::vector<Vec3d>& points) {
  std::vector<uint64_t> result;
  for (const Vec3d& point : points)
    for (const double x : point.a) result.push_back(std::bit_cast<uint64_t>(x));
  return result;
}

// Coordinates that are hard to write: no short decimal, denormal, largest, negative zero.
TetMesh awkward_tets() {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
  for (int v = 0; v < mesh.vertex_count(); ++v)
    for (int i = 0; i < 3; ++i) mesh.rest[v][i] = std::sin(1e3 * v + i) * std::pow(10.0, (v * 7 + i) % 40 - 20);
  mesh.rest[0] = {{std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max(), -0.0}};
  mesh.rest[1] = {{0.1, 1.0 / 3, -std::numeric_limits<double>::min()}};
  return mesh;
}

TriMesh awkward_triangles() {
  const TetMesh mesh = awkward_tets();
  return {mesh.rest, boundary_triangles(mesh, 0, mesh.tet_count())};
}

TEST_F(MeshFile, TetsReadBackExactlyInEveryFormat) {
  TetMesh mesh = awkward_tets();
  for (const bool has_region : {false, true}) {
    if (has_region)
      for (int t = 0; t < mesh.tet_count(); ++t) mesh.region.push_back(t % 3 == 0 ? 0 : t % 3 == 1 ? 2147483647 : -4);
    for (const MeshFormat& format : mesh_formats()) {
      if (!format.writes_tets) continue;
      for (const FileEncoding encoding : {FileEncoding::ascii, FileEncoding::binary}) {
        if (encoding == FileEncoding::binary && format.extension != ".msh" && format.extension != ".vtu") continue;
        const fs::path path = folder / ("mesh" + format.extension);
        write_mesh(path, mesh, encoding);
        const TetMesh read = read_tet_mesh(path);
        EXPECT_EQ(bits(read.rest), bits(mesh.rest)) << format.extension;
        EXPECT_EQ(read.tets, mesh.tets) << format.extension;
        EXPECT_EQ(read.region, mesh.region) << format.extension;
      }
    }
  }
}

TEST_F(MeshFile, GlbKeepsTrianglesInSinglePrecision) {
  TriMesh mesh = boundary_surface(make_box({{0, 0, 0}}, {{0.1, 1, 2}}, {2, 2, 2})).surface;
  write_mesh(folder / "box.glb", mesh);
  const TriMesh read = read_tri_mesh(folder / "box.glb");
  EXPECT_EQ(read.triangles, mesh.triangles);
  ASSERT_EQ(read.vertex_count(), mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_LT(norm(read.vertices[v] - mesh.vertices[v]), 1e-7) << v;
  mesh.vertices[0][0] = 1e40;
  EXPECT_THROW(write_mesh(folder / "far.glb", mesh), InvalidInput);
}

TEST_F(MeshFile, TrianglesReadBackExactlyInDoublePrecision) {
  const TriMesh mesh = awkward_triangles();
  for (const MeshFormat& format : mesh_formats()) {
    if (!format.writes_triangles || format.extension == ".stl" || format.extension == ".glb") continue;
    for (const FileEncoding encoding : {FileEncoding::ascii, FileEncoding::binary}) {
      if (encoding == FileEncoding::binary && format.extension != ".msh" && format.extension != ".ply") continue;
      const fs::path path = folder / ("mesh" + format.extension);
      write_mesh(path, mesh, encoding);
      const TriMesh read = read_tri_mesh(path);
      EXPECT_EQ(bits(read.vertices), bits(mesh.vertices)) << format.extension;
      EXPECT_EQ(read.triangles, mesh.triangles) << format.extension;
    }
  }
}

// STL does not number vertices, so the corners of each triangle are compared.
TEST_F(MeshFile, TextStlKeepsCornersExactlyAndJoinsTriangles) {
  const TetMesh tets = make_box({{-0.1, 0, 0}}, {{1.0 / 3, 1, 1}}, {2, 2, 2});
  const TriMesh mesh = boundary_surface(tets).surface;
  write_mesh(folder / "a.stl", mesh);
  const TriMesh read = read_tri_mesh(folder / "a.stl");
  EXPECT_EQ(read.vertex_count(), mesh.vertex_count());
  ASSERT_EQ(read.triangle_count(), mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(bits({read.vertices[read.triangles[t][i]]}), bits({mesh.vertices[mesh.triangles[t][i]]}));
}

TEST_F(MeshFile, BinaryStlRoundsToSinglePrecision) {
  const TriMesh mesh{{{{0.1, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}, {{0, 1, 2}}};
  write_mesh(folder / "a.stl", mesh, FileEncoding::binary);
  EXPECT_EQ(fs::file_size(folder / "a.stl"), 84u + 50);
  EXPECT_EQ(read_tri_mesh(folder / "a.stl").vertices[0][0], double(0.1f));
  EXPECT_THAT(message_of([&] { write_mesh(folder / "b.stl", awkward_triangles(), FileEncoding::binary); }),
              HasSubstr("single precision"));
}

TEST_F(MeshFile, ExamplesHaveTheStatedSizeAndLabels) {
  for (const MeshExample& example : mesh_examples()) {
    const fs::path path = folder / ("example" + example.extension);
    write_file(path, example.contents);
    const auto mesh = read_mesh(path);
    if (const auto* tets = std::get_if<TetMesh>(&mesh)) {
      EXPECT_EQ(tets->vertex_count(), example.vertices) << example.name;
      EXPECT_EQ(tets->tet_count(), example.tets) << example.name;
      EXPECT_EQ(tets->region, example.region) << example.name;
      for (int t = 0; t < tets->tet_count(); ++t) EXPECT_GT(std::abs(volume(*tets, t)), 0.1) << example.name;
    } else {
      EXPECT_EQ(std::get<TriMesh>(mesh).vertex_count(), example.vertices) << example.name;
      EXPECT_EQ(std::get<TriMesh>(mesh).triangle_count(), example.triangles) << example.name;
      EXPECT_EQ(example.tets, 0) << example.name;
    }
  }
}

TEST_F(MeshFile, SurfaceOfTetMeshIsItsBoundary) {
  write_mesh(folder / "a.msh", make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}));
  EXPECT_EQ(read_tri_mesh(folder / "a.msh").triangle_count(), 12);
}

TEST_F(MeshFile, ExtensionsMatchInAnyCase) {
  write_mesh(folder / "A.OBJ", awkward_triangles());
  EXPECT_EQ(read_tri_mesh(folder / "A.OBJ").triangles, awkward_triangles().triangles);
  write_mesh(folder / "A.ELE", awkward_tets());
  EXPECT_EQ(read_tet_mesh(folder / "A.NODE").tets, awkward_tets().tets);
}

TEST_F(MeshFile, WritingIgnoresLocaleAndLeavesNoTemporaries) {
  write_mesh(folder / "a.obj", TriMesh{{{{0.5, 0, 0}}, {{1, 0, 0}}, {{0, 1e-300, 0}}}, {{0, 1, 2}}});
  EXPECT_EQ(read_file(folder / "a.obj"), "# Aspic\nv 0.5 0 0\nv 1 0 0\nv 0 1e-300 0\nf 1 2 3\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(MeshFile, UnreadableFilesAreNamedWithRemedy) {
  const auto read = [&](const fs::path& name, const char* contents) {
    write_file(folder / name, contents);
    return message_of([&] { read_mesh(folder / name); });
  };
  EXPECT_THAT(read("a.objj", ""), HasSubstr("no mesh format has the extension '.objj' (did you mean '.obj'?)"));
  EXPECT_THAT(
      read("a.inp", "*NODE"),
      HasSubstr("a.inp: this is an Abaqus or CalculiX input file, which is not read; convert its tets by meshio"));
  EXPECT_THAT(read("a.STEP", ""), HasSubstr("this is STEP geometry, which is not read; mesh it by Gmsh: gmsh"));
  for (const char* name : {"a.feb", "a.fbx", "a.dae", "a.3mf", "a.bdf", "a.vtp", "a.nii"})
    EXPECT_THAT(read(name, ""), HasSubstr(", which is not read; ")) << name;
  EXPECT_THAT(read("a", ""), HasSubstr("no mesh format has the extension ''"));
  EXPECT_THAT(read("a.obj", ""), HasSubstr("a.obj: holds no faces"));
  EXPECT_THAT(read("b.obj", "v 0 0 0\n"), HasSubstr("b.obj: holds no faces"));
  EXPECT_THAT(read("a.node", "0 3 0 0\n"), HasSubstr("a.ele: does not exist; a TetGen mesh is a pair"));
  for (const char* name : {"a.msh", "a.mesh", "a.ply", "a.stl", "a.off", "a.vtu", "a.glb", "a.gltf"})
    EXPECT_THAT(read(name, ""), HasSubstr(name)) << name;
  EXPECT_THAT(message_of([&] { read_mesh(folder / "none.msh"); }), HasSubstr("none.msh: cannot be read"));
  fs::create_directory(folder / "folder.msh");
  EXPECT_THAT(message_of([&] { read_mesh(folder / "folder.msh"); }), HasSubstr("is a folder"));
  write_mesh(folder / "skin.off", awkward_triangles());
  EXPECT_THAT(message_of([&] { read_tet_mesh(folder / "skin.off"); }),
              HasSubstr("holds a surface, no tets; fill it with"));
}

TEST_F(MeshFile, UnsupportedContentIsRefusedBeforeWriting) {
  TetMesh tets = awkward_tets();
  EXPECT_THAT(message_of([&] { write_mesh(folder / "a.obj", tets); }),
              HasSubstr("is not written for tets; write .msh"));
  EXPECT_THAT(message_of([&] { write_mesh(folder / "a.ele", awkward_triangles()); }),
              HasSubstr("not written for triangles"));
  EXPECT_THAT(message_of([&] { write_mesh(folder / "a.off", awkward_triangles(), FileEncoding::binary); }),
              HasSubstr("text only"));
  tets.rest[5][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of([&] { write_mesh(folder / "a.msh", tets); }),
              HasSubstr("vertex 5 has a coordinate that is not finite"));
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace aspic
