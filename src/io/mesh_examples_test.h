// Small mesh files of every format and variant, as other programs write them.
#pragma once
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "io/base64.h"

namespace aspic {

struct MeshExample {
  std::string name, extension, contents;
  int vertices, tets, triangles;
  std::vector<int> region = {};
};

inline std::string raw(auto value, std::endian order = std::endian::little) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
  return order == std::endian::native ? bytes : std::string(bytes.rbegin(), bytes.rend());
}

template <class... Values>
std::string raws(Values... values) {
  return (raw(values) + ...);
}

inline std::string gmsh_22_text() {
  return R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "skin"
3 7 "muscle tissue"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
4 0 1 0
8 0 0 1
9 1 1 1
20 5 5 5
$EndNodes
$Elements
5
1 15 2 0 1 1
2 1 2 0 1 1 2
3 2 2 1 1 1 2 4
4 4 2 7 1 1 2 4 8
5 4 4 9 2 1 -1 2 4 8 9
$EndElements
$NodeData
1
"some field"
1
0.0
0
$EndNodeData
)";
}

inline std::string gmsh_22_binary() {
  std::string s = "$MeshFormat\n2.2 1 8\n" + raw(int32_t{1}) + "\n$EndMeshFormat\n$Nodes\n5\n";
  const double points[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  for (int32_t v = 0; v < 5; ++v) s += raws(v + 1, points[v][0], points[v][1], points[v][2]);
  s += "\n$EndNodes\n$Elements\n4\n";
  s += raws(int32_t{2}, int32_t{1}, int32_t{2}) +
       raws(int32_t{1}, int32_t{1}, int32_t{1}, int32_t{1}, int32_t{2}, int32_t{3});
  s += raws(int32_t{4}, int32_t{2}, int32_t{2});
  s += raws(int32_t{2}, int32_t{7}, int32_t{1}, int32_t{1}, int32_t{2}, int32_t{3}, int32_t{4});
  s += raws(int32_t{3}, int32_t{9}, int32_t{2}, int32_t{2}, int32_t{3}, int32_t{4}, int32_t{5});
  s += raws(int32_t{15}, int32_t{1}, int32_t{2}) + raws(int32_t{4}, int32_t{0}, int32_t{1}, int32_t{1});
  return s + "\n$EndElements\n";
}

// Two volumes, the second in two physical groups; nodes on a curve and a surface with parameters; tags with gaps.
inline std::string gmsh_41_text() {
  return R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
3 7 "muscle"
$EndPhysicalNames
$Entities
1 1 1 2
1 0 0 0 0 
1 0 0 0 1 0 0 0 2 1 -2 
1 0 0 0 1 1 0 1 3 1 1 
1 0 0 0 1 1 1 1 7 1 1 
2 0 0 0 1 1 1 2 9 8 1 1 
$EndEntities
$Nodes
4 5 10 50
0 1 0 1
10
0 0 0
1 1 1 1
20
1 0 0 0.5
2 1 1 1
30
0 1 0 0.25 0.75
3 1 0 2
40
50
0 0 1
1 1 1
$EndNodes
$Elements
4 4 1 9
0 1 15 1
1 10 
2 1 2 1
2 10 20 30 
3 1 4 1
5 10 20 30 40 
3 2 4 1
9 20 30 40 50 
$EndElements
)";
}

inline std::string gmsh_41_binary() {
  std::string s = "$MeshFormat\n4.1 1 8\n" + raw(int32_t{1}) + "\n$EndMeshFormat\n$Entities\n";
  s += raws(uint64_t{0}, uint64_t{0}, uint64_t{0}, uint64_t{2});
  for (int32_t volume : {1, 2}) {
    s += raw(volume) + raws(0.0, 0.0, 0.0, 1.0, 1.0, 1.0);
    s += volume == 1 ? raws(uint64_t{1}, int32_t{7}) : raws(uint64_t{2}, int32_t{9}, int32_t{8});
    s += raws(uint64_t{1}, int32_t{1});
  }
  s += "\n$EndEntities\n$Nodes\n" + raws(uint64_t{2}, uint64_t{5}, uint64_t{1}, uint64_t{9});
  s += raws(int32_t{2}, int32_t{1}, int32_t{1}, uint64_t{1}, uint64_t{9}, 0.0, 0.0, 0.0, 0.5, 0.5);
  s += raws(int32_t{3}, int32_t{1}, int32_t{0}, uint64_t{4}, uint64_t{1}, uint64_t{2}, uint64_t{3}, uint64_t{4});
  s += raws(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0);
  s += "\n$EndNodes\n$Elements\n" + raws(uint64_t{3}, uint64_t{3}, uint64_t{1}, uint64_t{3});
  s += raws(int32_t{2}, int32_t{1}, int32_t{2}, uint64_t{1}, uint64_t{1}, uint64_t{9}, uint64_t{1}, uint64_t{2});
  s += raws(int32_t{3}, int32_t{1}, int32_t{4}, uint64_t{1}, uint64_t{2}, uint64_t{9}, uint64_t{1}, uint64_t{2},
            uint64_t{3});
  s += raws(int32_t{3}, int32_t{2}, int32_t{4}, uint64_t{1}, uint64_t{3}, uint64_t{1}, uint64_t{2}, uint64_t{3},
            uint64_t{4});
  return s + "\n$EndElements\n";
}

inline std::string medit_tets_first() {
  return R"(MeshVersionFormatted 1
# written by hand
Dimension
3
Tetrahedra 2
1 2 3 4 7
2 3 4 5 9 # the second
Triangles
1
1 2 3 1
Corners
1
1
Vertices 5
0 0 0 0
1 0 0 0
0 1 0 2
0 0 1 0
1 1 1 0
End
)";
}

inline std::string ascii_ply() {
  return "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement vertex 4\nproperty uchar red\n"
         "property float x\nproperty float y\nproperty float z\nproperty list uchar float weights\nelement face 2\n"
         "property list uchar int vertex_indices\nproperty float quality\nelement edge 1\nproperty int vertex1\n"
         "property int vertex2\nend_header\n255 0 0 0 2 0.5 0.5\n0 1 0 0 0\n0 1 1 0 1 nan\n9 0 1 0 0\n"
         "4 0 1 2 3 nan\n3 0 1 2 0.5\n0 1\n";
}

inline std::string binary_ply(std::endian order) {
  std::string s = std::string("ply\r\nformat binary_") + (order == std::endian::big ? "big" : "little") +
                  "_endian 1.0\r\nelement vertex 4\r\nproperty double x\r\nproperty float y\r\nproperty int16 z\r\n"
                  "property list ushort double weights\r\nelement face 2\r\nproperty int8 flag\r\n"
                  "property list uint8 uint32 vertex_index\r\nend_header\r\n";
  const auto put = [&](auto value) { s += raw(value, order); };
  for (int v = 0; v < 4; ++v) {
    put(v * 0.5), put(v * 0.25f), put(int16_t(-v)), put(uint16_t(v % 2));
    if (v % 2) put(0.125);
  }
  put(int8_t{-1}), put(uint8_t{4});
  for (uint32_t v : {0, 1, 2, 3}) put(v);
  put(int8_t{1}), put(uint8_t{3});
  for (uint32_t v : {3, 1, 0}) put(v);
  return s;
}

inline std::string binary_stl(const std::string& head) {
  std::string s = head;
  s.resize(80, ' ');
  s += raw(uint32_t{2});
  for (float z : {0.f, 1.f}) s += raws(0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, z, uint16_t{0});
  return s;
}

// Two tets with fields, as VTK writes them: version 3.0 with the sizes of cells, 5.1 with offsets.
inline std::string legacy_vtk(bool is_binary, bool has_offsets) {
  std::string s = std::string("# vtk DataFile Version ") + (has_offsets ? "5.1" : "3.0") + "\na title\n" +
                  (is_binary ? "BINARY" : "ASCII") + "\nDATASET UNSTRUCTURED_GRID\n";
  const auto put = [&](const auto& numbers) {
    for (const auto number : numbers) {
      if (is_binary)
        s += raw(number, std::endian::big);
      else
        s += std::to_string(number) + ' ';
    }
    s += '\n';
  };
  s += "POINTS 5 double\n";
  put(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
  if (has_offsets) {
    s += "CELLS 3 8\nOFFSETS vtktypeint64\n";
    put(std::vector<int64_t>{0, 4, 8});
    s += "CONNECTIVITY vtktypeint64\n";
    put(std::vector<int64_t>{0, 1, 2, 3, 1, 2, 3, 4});
  } else {
    s += "CELLS 2 10\n";
    put(std::vector<int32_t>{4, 0, 1, 2, 3, 4, 1, 2, 3, 4});
  }
  s += "CELL_TYPES 2\n";
  put(std::vector<int32_t>{10, 10});
  s += "CELL_DATA 2\nSCALARS region int 1\nLOOKUP_TABLE default\n";
  put(std::vector<int32_t>{7, 9});
  s += "METADATA\nINFORMATION 0\n\nPOINT_DATA 5\nVECTORS u float\n";
  put(std::vector<float>(15, 1.5f));
  s += "FIELD FieldData 1\nits%20name 2 5 double\n";
  put(std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  return s;
}

inline std::string legacy_vtk_surface() {
  return "# vtk DataFile Version 4.2\nsurface\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n"
         "VERTICES 1 2\n1 0\nPOLYGONS 1 5\n4 0 1 2 3\nTRIANGLE_STRIPS 1 5\n4 0 1 3 2\n"
         "CELL_DATA 3\nSCALARS part int\nLOOKUP_TABLE default\n1 2 3\n";
}

// A square of two triangles with shared corners repeated, moved by (0, 0, 2): binary, or text with a data URI.
inline std::string gltf_square(bool is_binary) {
  std::string bytes;
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, 0.F, 1.F, 1.F, 0.F, 0.F, 0.F, 0.F})
    bytes.append(reinterpret_cast<const char*>(&x), 4);
  bytes.append("\0\1\2\3\5\4", 6);
  std::string uri = ",\"uri\":\"data:application/octet-stream;base64,";
  append_base64(bytes, uri);
  std::string json =
      R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"mesh":0,"translation":[0,0,2]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
      R"({"bufferView":0,"componentType":5126,"count":6,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"}],"bufferViews":[)"
      R"({"buffer":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":6}],"buffers":[{"byteLength":78)" +
      (is_binary ? "" : uri + "\"") + "}]}";
  if (!is_binary) return json;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  bytes.resize(80);
  std::string file = "glTF";
  const auto put = [&](size_t word) { file.append(reinterpret_cast<const char*>(&word), 4); };
  put(2), put(28 + json.size() + bytes.size()), put(json.size());
  file += "JSON" + json;
  put(bytes.size());
  return file + std::string("BIN\0", 4) + bytes;
}

// A triangle on two joints: the second one, at (1, 0, 0), turns by 90 degrees about z within a second, while the first
// jumps by (0, 0, 5) at its end and grows by the factor 3.
inline std::string gltf_arm() {
  std::string bytes, views, accessors;
  const auto add = [&](const std::string& data, int component, int count, const char* shape) {
    const char* comma = views.empty() ? "" : ",";
    views += comma + (R"({"buffer":0,"byteOffset":)" + std::to_string(bytes.size())) +
             ",\"byteLength\":" + std::to_string(data.size()) + "}";
    accessors += comma + (R"({"bufferView":)" + std::to_string(std::count(views.begin(), views.end(), '{') - 1)) +
                 ",\"componentType\":" + std::to_string(component) + ",\"count\":" + std::to_string(count) +
                 ",\"type\":\"" + shape + "\"}";
    bytes += data;
  };
  const auto floats = [](std::vector<float> x) {
    return std::string(reinterpret_cast<const char*>(x.data()), 4 * x.size());
  };
  const float half = 0.5F, root = 0.70710678F;
  add(floats({0, 0, 0, 2, 0, 0, 1, 1, 0}), 5126, 3, "VEC3");
  add(std::string("\0\0\0\0\1\0\0\0\0\1\0\0", 12), 5121, 3, "VEC4");
  add(floats({1, 0, 0, 0, 1, 0, 0, 0, half, half, 0, 0}), 5126, 3, "VEC4");
  add(floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}),
      5126, 2, "MAT4");
  add(floats({0, 1}), 5126, 2, "SCALAR");
  add(floats({0, 0, 0, 1, 0, 0, root, root}), 5126, 2, "VEC4");
  add(floats({0, 0, 0, 0, 0, 5}), 5126, 2, "VEC3");
  add(floats({0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0, 3, 3, 3, 0, 0, 0}), 5126, 6, "VEC3");
  std::string uri = "data:application/octet-stream;base64,";
  append_base64(bytes, uri);
  return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"skin":0,"translation":[9,9,9]},)"
         R"({"children":[2]},{"translation":[1,0,0]}],"skins":[{"joints":[1,2],"inverseBindMatrices":3}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2}}]}],)"
         R"("animations":[{"name":"bend","channels":[{"sampler":0,"target":{"node":2,"path":"rotation"}},)"
         R"({"sampler":1,"target":{"node":1,"path":"translation"}},{"sampler":2,"target":{"node":1,"path":"scale"}}],)"
         R"("samplers":[{"input":4,"output":5},{"input":4,"output":6,"interpolation":"STEP"},)"
         R"({"input":4,"output":7,"interpolation":"CUBICSPLINE"}]}],"accessors":[)" +
         accessors + "],\"bufferViews\":[" + views + "],\"buffers\":[{\"byteLength\":" + std::to_string(bytes.size()) +
         ",\"uri\":\"" + uri + "\"}]}";
}

// All files are valid.
inline std::vector<MeshExample> mesh_examples() {
  return {
      {"gmsh 2.2 text", ".msh", gmsh_22_text(), 6, 2, 0, {7, 9}},
      {"gmsh 2.2 binary", ".msh", gmsh_22_binary(), 5, 2, 0, {7, 9}},
      {"gmsh 4.1 text", ".msh", gmsh_41_text(), 5, 2, 0, {7, 9}},
      {"gmsh 4.1 binary", ".msh", gmsh_41_binary(), 5, 2, 0, {7, 9}},
      {"medit, tets before vertices", ".mesh", medit_tets_first(), 5, 2, 0, {7, 9}},
      {"obj", ".obj", "# quad\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1/1 2//1 3 -1\n", 4, 0, 2},
      {"off", ".off", "OFF # a comment\n# another\n4 1 0\n0 0 0\n1 0 0\n1 1 0 # third\n0 1 0\n4 0 1 2 3 255 0 0\n", 4,
       0, 2},
      {"off with colors", ".off", "COFF 3 1 3\n0 0 0 255 0 0 255\n1 0 0 0 0 0 0\n1 1 0 1 1 1 1\n3 0 1 2\n", 3, 0, 1},
      {"ply text", ".ply", ascii_ply(), 4, 0, 3},
      {"ply binary little", ".ply", binary_ply(std::endian::little), 4, 0, 3},
      {"ply binary big", ".ply", binary_ply(std::endian::big), 4, 0, 3},
      {"stl binary", ".stl", binary_stl("made by hand"), 4, 0, 2},
      {"stl binary that begins with solid", ".stl", binary_stl("solid body"), 4, 0, 2},
      {"stl text", ".stl",
       "solid two words\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
       "  endloop\n endfacet\n FACET NORMAL nan nan nan\n  OUTER LOOP\n   VERTEX -0 0 0\n   VERTEX 1e0 0 0\n"
       "   VERTEX 0 0 1\n  ENDLOOP\n ENDFACET\nendsolid two words\n",
       4, 0, 2},
      {"legacy VTK 3.0 text", ".vtk", legacy_vtk(false, false), 5, 2, 0, {7, 9}},
      {"legacy VTK 3.0 binary", ".vtk", legacy_vtk(true, false), 5, 2, 0, {7, 9}},
      {"legacy VTK 5.1 text", ".vtk", legacy_vtk(false, true), 5, 2, 0, {7, 9}},
      {"legacy VTK 5.1 binary", ".vtk", legacy_vtk(true, true), 5, 2, 0, {7, 9}},
      {"legacy VTK surface", ".vtk", legacy_vtk_surface(), 4, 0, 4},
      {"glTF binary", ".glb", gltf_square(true), 4, 0, 2},
      {"glTF text", ".gltf", gltf_square(false), 4, 0, 2},
      {"glTF with a skin", ".gltf", gltf_arm(), 3, 0, 1},
  };
}

}  // namespace aspic
