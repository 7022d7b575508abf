// Fields of a body that were painted on a surface: vertex attributes of PLY files.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/harmonic_extension.h"
#include "scene/placement.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic {

bool is_painted(const std::filesystem::path& path);  // whether a file has the extension of a painted surface

// Throws InvalidInput if points of a body are farther from a surface than half of the surface's diagonal: its units or
// its placement are wrong. `farthest`: largest distance [m].
void refuse_if_elsewhere(const std::vector<Vec3d>& surface, double farthest, const std::string& body);

class PaintedFields {
 public:
  // `place`: placement of the body, applied to the surfaces. Keeps a reference to `files`.
  PaintedFields(const AffineMap& place, SceneFiles& files, std::string body);

  // Returns the attribute `name` of the PLY `file` of a table at each vertex of the placed mesh. Vertices of the
  // boundary have the value of the closest point of the surface; inside, the field is harmonic. Adds the file to the
  // results and checks its hash. Throws InvalidInput.
  const std::vector<double>& at_vertices(Table& table, const TetMesh& mesh);

 private:
  std::vector<double> read(const std::filesystem::path& path, const std::string& name, const TetMesh& mesh);

  AffineMap place_;
  SceneFiles& files_;
  std::string body_;
  std::unique_ptr<HarmonicExtension> extension_;
  std::map<std::filesystem::path, std::string> kept_;                                   // names in the results
  std::map<std::pair<std::filesystem::path, std::string>, std::vector<double>> known_;  // by file and attribute
};

}  // namespace aspic
