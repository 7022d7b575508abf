// The folder of a run before its files are written or continued.
#pragma once
#include <filesystem>
#include <string>

#include "results/run_directory.h"
#include "results/run_directory_layout.h"
#include "scene/scene.h"

namespace aspic {

// All throw InvalidInput.
void create_folder(const std::filesystem::path& folder);
void refuse_run(const RunLayout& layout);  // the folder contains a run
// Removes an earlier run except its files among `inputs`, or refuses to.
void make_room(const RunLayout& layout, const SceneInputs& inputs, ExistingRun existing);
void require_checkpoint(const RunLayout& layout);  // the folder contains a run with a checkpoint
// `in_checkpoint`: the fingerprint there. The message names the first line that differs.
void require_same_scene(const RunLayout& layout, const std::string& resolved, const std::string& in_checkpoint);

}  // namespace aspic
