// Finds the files that a scene names, restricts them to its folders, and lists them for the results.
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
  // Names are relative to `folder`. Files outside of it and of its parent are rejected unless `allow_outside`.
  SceneFiles(std::filesystem::path folder, bool allow_outside);

  // Returns the file that a value names. Throws InvalidInput with the nearest name if it is rejected or missing.
  std::filesystem::path find(const Value& name) const;

  // Adds a file to the results; returns its name there: "inputs/" + stem + the extension of the source.
  std::string keep(const std::filesystem::path& source, const std::string& stem);
  std::string keep(const TetMesh& mesh, const std::string& stem);

  std::vector<std::pair<std::string, std::string>> kept_files;
  std::vector<std::pair<std::string, TetMesh>> kept_meshes;

 private:
  std::filesystem::path folder_;
  bool allow_outside_;
};

// Compares with the hash under `key` of `table`; if absent, stores the hash there.
void check_fingerprint(Table& table, const std::string& key, const std::string& hash, const std::string& what);

}  // namespace aspic
