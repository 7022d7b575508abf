// The scene of a session as portable files: the TOML with all values and the files that it refers to.
#pragma once
#include <string>
#include <vector>

#include "io/zip.h"
#include "viewer/side.h"

namespace aspic::viewer {

std::string saved_name(const Scene& scene);  // valid as a file name, without extension

enum class SavedHand { with_drags, without_drags };

struct SavedScene {
  std::string name;                // name of the scene, valid as a file name
  std::vector<ZipEntry> files;     // the first one is "NAME.toml"; the others are below "inputs/"
  std::vector<std::string> notes;  // descriptions of unsaved parts
};

// The scene starts with the current settings and with the pins set before the first step. With drags, each pull of the
// mouse becomes a [[body.grab]] along its path, and the run is long enough for it. Throws InvalidInput if a file is no
// longer readable.
SavedScene saved_scene(const Side& side, SavedHand hand);

// Returns {"name", "text"} for a scene without other files, otherwise {"name", "base64"} of a ZIP archive.
Json scene_reply(const SavedScene& saved);
// Returns {"scene", "files", "notes"}, the arguments of the command "load".
Json scene_files_reply(const SavedScene& saved);

// Returns {"name", "base64"} of a file for the page. Throws InvalidInput if the file is too large.
Json file_reply(const std::string& name, const std::string& bytes);

}  // namespace aspic::viewer
