#include "scene/scene_files.h"

#include <algorithm>

#include "base/error.h"
#include "io/gltf_reader.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end && names.size() < 1000; i.increment(error))
    names.push_back(i->path().filename().string());
  return names;
}

bool is_confined(const fs::path& path) {
  if (path.is_absolute() || path.has_root_name()) return false;
  const fs::path normal = path.lexically_normal();
  auto part = normal.begin();
  if (part != normal.end() && *part == "..") ++part;
  return part == normal.end() || *part != "..";
}

// Whether `file`, after following links, is below `top`.
bool is_below(const fs::path& file, const fs::path& top) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error), real_top = fs::canonical(top, error);
  return !error && std::mismatch(real_top.begin(), real_top.end(), real.begin(), real.end()).first == real_top.end();
}

}  // namespace

std::string fingerprint_of(const TetMesh& mesh) {
  Fingerprint hash;
  hash.add(mesh.rest.data(), mesh.rest.size() * sizeof(Vec3d));
  hash.add(mesh.tets.data(), mesh.tets.size() * sizeof(Tet));
  hash.add(mesh.region.data(), mesh.region.size() * sizeof(int));
  hash.add(mesh.sheet.data(), mesh.sheet.size() * sizeof(Triangle));
  hash.add(mesh.pattern.data(), mesh.pattern.size() * sizeof(std::array<Vec3d, 3>));
  hash.add(mesh.rods.data(), mesh.rods.size() * sizeof(Segment));
  return hash.text();
}

std::string fingerprint_of_file(const fs::path& path) {
  const std::string bytes = read_self_contained(path);
  Fingerprint hash;
  hash.add(bytes.data(), bytes.size());
  return hash.text();
}

SceneFiles::SceneFiles(fs::path folder, bool allow_outside)
    : folder_(std::move(folder)), allow_outside_(allow_outside) {}

fs::path SceneFiles::find(const Value& name) const {
  const fs::path path = name.text();
  const std::string shown = shortened(toml_string(name.text()));
  const bool trusted = allow_outside_ || name.place.is_override();
  if (!trusted && !is_confined(path))
    throw error_at(name.place, shown +
                                   " is outside the scene's folder and its parent; move the file there, or "
                                   "pass it on the command line with --set");
  const fs::path full = path.is_absolute() ? path : (name.place.is_override() ? path : folder_ / path);
  std::error_code error;
  if (fs::is_regular_file(full, error)) {
    if (trusted || is_below(full, folder_.empty() ? ".." : folder_ / "..")) return full;
    throw error_at(name.place, shown +
                                   " is a link to outside the scene's folder and its parent; copy the "
                                   "file there, or pass it on the command line with --set");
  }
  if (fs::is_directory(full, error)) throw error_at(name.place, shown + " is a folder; a file is needed");
  if (fs::exists(full, error)) throw error_at(name.place, shown + " is not a regular file; copy its contents to one");
  const std::string nearest = nearest_name(full.filename().string(), names_in(full.parent_path()));
  throw error_at(name.place, shown + " does not exist (looked for " + full.lexically_normal().string() + ")" +
                                 (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

std::string SceneFiles::keep(const fs::path& source, const std::string& stem) {
  const std::string name = "inputs/" + stem + source.extension().string();
  kept_files.emplace_back(name, source.string());
  return name;
}

std::string SceneFiles::keep(const TetMesh& mesh, const std::string& stem) {
  const std::string name = "inputs/" + stem + ".msh";
  kept_meshes.emplace_back(name, mesh);
  return name;
}

void check_fingerprint(Table& table, const std::string& key, const std::string& hash, const std::string& what) {
  if (const Value* expected = table.find(key); expected && expected->text() != hash)
    throw error_at(expected->place, key + " = " + shortened(toml_string(expected->text())) + ", but " + what + " has " +
                                        hash + ": it has changed; remove " + key + " to accept this");
  table.set(key, {hash, {}});
}

}  // namespace aspic
