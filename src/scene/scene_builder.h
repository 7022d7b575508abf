// Builds a scene from a complete document.
#pragma once
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "dynamics/simulation_checks.h"
#include "scene/body_mesh.h"
#include "scene/scene.h"
#include "scene/scene_model.h"
#include "scene/value.h"

namespace aspic {

struct SceneSource {
  Table document;                            // has passed read_scene_document()
  std::string name;                          // name of the scene
  std::string file;                          // file name for messages
  std::map<std::string, LoadedMesh> meshes;  // meshes of bodies that were already read
  std::vector<std::string> notes;
};

struct SceneInput {
  SceneSource source;
  SceneFiles files;
};
// Reads a scene without its meshes. For a mesh file, reads it and completes the document with defaults. Throws
// InvalidInput.
SceneInput read_scene_input(const std::filesystem::path& path, const SceneOptions& options);

// Both throw InvalidInput.
SceneModel build_scene_model(SceneSource source, SceneFiles files, const SceneOptions& options);
Scene build_scene(SceneSource source, SceneFiles files, const SceneOptions& options);
// Writes the version of this program into a document. Adds a note if it had another one.
void mark_version(Table& document, std::vector<std::string>& notes);
// Return the options of a complete document. Throw InvalidInput.
SimulationOptions simulation_options(const Table& document, std::vector<std::string>& notes);
OutputOptions output_options(const Value& output);
// Appends the material fields of the results for tets with these parameters; zero where a body is not elastic.
void export_moduli(std::span<const MaterialParameters> parameters, Model& model);
std::string remedy_in_scene(BadInitialState::Kind kind);
// Returns the number of steps, from the checked table `time` of a scene.
int steps_of(const Value& time);

}  // namespace aspic
