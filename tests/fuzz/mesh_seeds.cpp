#include <map>

#include "io/gmsh.h"
#include "io/gzip.h"
#include "io/medit.h"
#include "io/mesh_examples_test.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"
#include "io/tetgen.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "seeds.h"

namespace aspic::fuzz {
namespace {

TetMesh two_regions() {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1}, BoxCut::five);
  mesh.region = {1, 1, 2, 2, 2};
  return mesh;
}

// Files of other programs, by purpose.
void append_examples(std::vector<Seed>& seeds) {
  const std::map<std::string, std::string> targets = {{".msh", "gmsh"}, {".mesh", "medit"}, {".obj", "obj"},
                                                      {".off", "off"},  {".ply", "ply"},    {".stl", "stl"},
                                                      {".vtk", "vtk"},  {".glb", "gltf"},   {".gltf", "gltf"}};
  int number = 0;
  for (const MeshExample& example : mesh_examples())
    seeds.push_back({targets.at(example.extension), std::to_string(++number), example.contents});
}

}  // namespace

std::vector<Seed> mesh_seeds() {
  const TetMesh tets = two_regions();
  const TriMesh surface = boundary_surface(tets).surface;
  const TetgenText pair = tetgen_text(tets);
  std::vector<Seed> seeds = {
      {"gmsh", "tets_ascii", gmsh_bytes(tets, FileEncoding::ascii)},
      {"gmsh", "tets_binary", gmsh_bytes(tets, FileEncoding::binary)},
      {"gmsh", "surface_binary", gmsh_bytes(surface, FileEncoding::binary)},
      {"medit", "tets", medit_text(tets)},
      {"medit", "surface", medit_text(surface)},
      {"doctor", "tets", medit_text(tets)},
      {"doctor", "surface", off_text(surface)},
      {"tetgen", "tets", pair.node + "====\n" + pair.ele},
      {"obj", "surface", obj_text(surface)},
      {"off", "surface", off_text(surface)},
      {"ply", "surface_ascii", ply_bytes(surface, FileEncoding::ascii)},
      {"ply", "surface_binary", ply_bytes(surface, FileEncoding::binary)},
      {"stl", "surface_ascii", stl_bytes("", surface, FileEncoding::ascii)},
      {"stl", "surface_binary", stl_bytes("", surface, FileEncoding::binary)},
  };
  append_examples(seeds);
  return seeds;
}

std::vector<Seed> part_seeds() {
  return {{"gzip", "text", gzipped("a text that is packed a text that is packed")},
          {"gzip", "zeros", gzipped(std::string(3000, '\0'))},
          {"base64", "bytes", "QXNwaWM="},
          {"base64", "two", "QXM=\n cGlj"},
          {"xml", "nested", "<?xml version=\"1.0\"?>\n<a b=\"c &amp; d\"><!-- e --><f/>text</a>\n"},
          {"xml", "appended", "<a><AppendedData encoding=\"raw\">_\x01\x02</a>"}};
}

}  // namespace aspic::fuzz
