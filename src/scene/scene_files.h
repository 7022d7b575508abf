// The files that a scene names: found and confined, and remembered for the results.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "mesh/tet_mesh.h"
#include "scene/value.h"

namespace aspic {

class Fingerprint : public Fnv1a {
 public:
  std::string text() const { return "fnv1a:" + hex_digits(value()); }  // "fnv1a:0123456789abcdef"
};
std::string fingerprint_of(const TetMesh& mesh);
std::string fingerprint_of_file(const std::filesystem::path& path);

class SceneFiles {
 public:
  // Names are relative to `folder`. Outside of it and of the folder above nothing is read, unless `allow_outside`.
  SceneFiles(std::filesystem::path folder, bool allow_outside);

  // The file that a value names. Throws InvalidInput when it is refused or missing, with the nearest name there.
  std::filesystem::path find(const Value& name) const;

  // Remembers a file for the results; returns its name there: "inputs/" + stem + the source's extension.
  std::string keep(const std::filesystem::path& source, const std::string& stem);
  std::string keep(const TetMesh& mesh, const std::string& stem);

  std::vector<std::pair<std::string, std::filesystem::path>> kept_files;
  std::vector<std::pair<std::string, TetMesh>> kept_meshes;

 private:
  std::filesystem::path folder_;
  bool allow_outside_;
};

// Compares with the hash of a resolved scene, when `table` has one under `key`; otherwise puts it there.
void check_fingerprint(Table& table, const std::string& key, const std::string& hash, const std::string& what);

}  // namespace aspic
