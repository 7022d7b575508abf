// A session's scene as files that run anywhere: the TOML with all its values, and what it refers to beside it.
#pragma once
#include <string>
#include <vector>

#include "io/zip.h"
#include "viewer/side.h"

namespace aspic::viewer {

std::string saved_name(const Scene& scene);  // fit for a file, without extension

enum class SavedHand { with_drags, without_drags };

struct SavedScene {
  std::string name;                // of the scene, fit for a file
  std::vector<ZipEntry> files;     // the first one is "NAME.toml"; the others are below "inputs/"
  std::vector<std::string> notes;  // what could not be saved
};

// The settings of now, from the start of the run, with the pins that were put before the first step. With drags: what
// the mouse did is a [[body.grab]] along the path that it took, and the run is long enough for it. Throws InvalidInput
// when a file cannot be read any more.
SavedScene saved_scene(const Side& side, SavedHand hand);

// {"name", "text"} of a scene without other files, {"name", "base64"} of a ZIP archive of one with them.
Json scene_reply(const SavedScene& saved);
// {"scene", "files", "notes"}: what the command "load" takes.
Json scene_files_reply(const SavedScene& saved);

// {"name", "base64"} of a file for the page. Throws InvalidInput when it is too large for it.
Json file_reply(const std::string& name, const std::string& bytes);

}  // namespace aspic::viewer
