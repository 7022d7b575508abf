// The mesh of a body: read, generated, or made by filling a surface; judged by the doctor and placed.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/embed.h"
#include "mesh/tet_mesh.h"
#include "scene/scene.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic {

// A mesh as a file has it, before it is placed.
struct LoadedMesh {
  TetMesh tets;
  std::filesystem::path surface;  // the file that was filled, if any
};

struct MeshLoader {
  SceneFiles& files;
  std::filesystem::path mesher;
  std::vector<std::string>& notes;
  Announce announce;
  TetLimit limit = {};
  double tets = 0;            // so far
  double mesher_seconds = 0;  // as in SceneOptions

  void tell(const std::string& what) const;
  void tell_if_many(int tets, const std::string& what) const;  // so many that it takes more than a moment
  std::string why_not(double more_tets) const;                 // empty: they are within the limit and fit into memory
  std::string why_not_in_memory(double more_tets) const;       // empty: what they take at least is free
};

// Reads a mesh; fills a surface with tets of edge length `size` (0: the mesher's choice). Errors that the doctor finds
// throw InvalidInput; its warnings become notes.
LoadedMesh load_mesh(const std::filesystem::path& path, double size, MeshLoader& loader);

struct BodyMesh {
  TetMesh tets;         // the placed rest shape, checked
  TriMesh skin;         // placed alike
  Embedding embedding;  // of the skin into the tets
};

// Resolves mesh, shape and skin of a body, whose table then names what the results keep. `loaded`: the mesh, when it
// was read before.
BodyMesh make_body_mesh(Value& body, MeshLoader& loader, std::optional<LoadedMesh> loaded);

}  // namespace aspic
