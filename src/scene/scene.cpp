#include "scene/scene.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/gltf_reader.h"
#include "io/mesh_file.h"
#include "scene/mesh_scene.h"
#include "scene/scene_builder.h"
#include "scene/scene_document.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

void copy_file(const fs::path& source, const fs::path& target) {
  std::error_code error;
  if (fs::equivalent(source, target, error)) return;
  write_file(target, read_self_contained(source));
}

}  // namespace

SceneInput read_scene_input(const fs::path& path, const SceneOptions& options) {
  if (path.extension() == ".toml") {
    SceneSource source{read_scene_document(read_toml_text(path), path.string(), options.overrides),
                       path.stem().string(),
                       path.string(),
                       {},
                       {}};
    return {std::move(source), SceneFiles(path.parent_path(), options.allow_outside)};
  }
  SceneFiles files("", true);  // the user named the mesh
  std::vector<std::string> notes;
  MeshLoader loader{files, options.mesher, notes, options.announce, options.limit, 0, options.mesher_seconds};
  SceneSource source = scene_of_mesh(path, options.overrides, loader);
  source.notes.insert(source.notes.begin(), notes.begin(), notes.end());
  return {std::move(source), std::move(files)};
}

SceneModel load_scene_model(const fs::path& path, const SceneOptions& options) {
  SceneInput input = read_scene_input(path, options);
  return build_scene_model(std::move(input.source), std::move(input.files), options);
}

Scene load_scene(const std::string& path, const SceneOptions& options) {
  SceneInput input = read_scene_input(path, options);
  return build_scene(std::move(input.source), std::move(input.files), options);
}

void write_inputs(const SceneInputs& inputs, const std::string& folder) {
  const auto prepared = [&](const std::string& name) {
    const fs::path target = fs::path(folder) / name;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (error) throw InvalidInput(target.parent_path().string() + ": cannot be created: " + error.message());
    return target;
  };
  for (const auto& [name, source] : inputs.files) aspic::copy_file(source, prepared(name));
  for (const auto& [name, mesh] : inputs.generated_meshes) write_mesh(prepared(name), mesh);
}

}  // namespace aspic
