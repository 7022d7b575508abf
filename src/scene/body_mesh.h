// The mesh of a body: read, generated, or made by filling a surface; checked and placed.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/embed.h"
#include "mesh/generators.h"
#include "mesh/mesh_groups.h"
#include "mesh/tet_mesh.h"
#include "scene/scene.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic {

// A mesh in the coordinates of its file.
struct LoadedMesh {
  TetMesh tets;
  std::filesystem::path surface;  // the file that was filled, if any
  MeshGroups groups = {};         // of a file of tets
};

struct MeshLoader {
  SceneFiles& files;
  std::filesystem::path mesher;
  std::vector<std::string>& notes;
  Announce announce;
  TetLimit limit = {};
  double tets = 0;            // number of tets so far
  double mesher_seconds = 0;  // as in SceneOptions

  void report(const std::string& what) const;
  void report_if_many(int tets, const std::string& what) const;  // if the work takes about a second or more
  std::string why_not(double more_tets) const;  // reason to refuse them; empty: within the limit and the memory
  std::string why_not_in_memory(double more_tets) const;  // reason to refuse them; empty: fit into the memory
};

// Reads a mesh; fills a surface with tets of edge length `size` (0: default of the mesher). Defects throw InvalidInput;
// warnings become notes.
LoadedMesh load_mesh(const std::filesystem::path& path, double size, MeshLoader& loader);

// Cells of the checked table shape.box.
struct BoxCells {
  std::array<double, 3> count;  // may exceed the range of int
  BoxCut cut;

  double tets() const;
  std::array<int, 3> integers() const { return {int(count[0]), int(count[1]), int(count[2])}; }
};
BoxCells cells_of(const Value& box);

TetMesh shape_mesh(const Value& shape, const MeshLoader& loader);     // generates one of the table's solids
TriMesh shape_surface(const Value& shape, const MeshLoader& loader);  // a sheet, or the boundary of a solid

struct BodyMesh {
  TetMesh tets;         // the placed rest shape, checked; or a sheet or a rod
  TriMesh skin;         // placed alike
  Embedding embedding;  // of the skin into the tets
  MeshGroups groups = {};
  std::vector<TriangleUv> uv = {};  // of the skin; may be empty
};

// Resolves mesh, shape and skin of a body, and names the files of the results in its table. `loaded`: the mesh, if
// already read.
BodyMesh make_body_mesh(Value& body, MeshLoader& loader, std::optional<LoadedMesh> loaded);

}  // namespace aspic
