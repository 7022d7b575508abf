// Fuzz targets: one function per reader of foreign files. Each accepts any bytes and either reads them or throws
// InvalidInput; any other outcome is a defect. Targets check what the rest of the library relies on, and that messages
// contain no control characters.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::fuzz {

using Feed = void (*)(std::string_view bytes);

struct Target {
  std::string_view name;
  Feed feed;
};

// Surfaces and meshes.
void gmsh(std::string_view bytes);
void gmsh_slices(std::string_view bytes);  // compared with gmsh()
void medit(std::string_view bytes);
void tetgen(std::string_view bytes);  // .node, a line "====", .ele
void vtu(std::string_view bytes);
void vtk(std::string_view bytes);
void obj(std::string_view bytes);
void off(std::string_view bytes);
void ply(std::string_view bytes);
void stl(std::string_view bytes);
void gltf(std::string_view bytes);
void doctor(std::string_view bytes);  // OFF or Medit, examined and repaired
// Parts of files.
void gzip(std::string_view bytes);
void base64(std::string_view bytes);
void xml(std::string_view bytes);
void csv(std::string_view bytes);
// Runs and fits.
void checkpoint(std::string_view bytes);
void point_cache(std::string_view bytes);
void run_folder(std::string_view bytes);     // files in one text, see several_files.h
void run_recording(std::string_view bytes);  // the files of a run
void journal(std::string_view bytes);
void material(std::string_view bytes);
void data_set(std::string_view bytes);  // files in one text
void motion_table(std::string_view bytes);
// Scenes.
void toml(std::string_view bytes);
void scene(std::string_view bytes);     // builds the scene, with at most a few hundred tets
void obstacle(std::string_view bytes);  // OBJ, with a body that falls onto it
void thin(std::string_view bytes);      // OBJ, the sheet or rod of a scene
void values(std::string_view bytes);    // a table of numbers per element
void expression(std::string_view bytes);
void overrides(std::string_view bytes);  // one per line

// The viewer's page.
void page_text(std::string_view bytes);  // addresses, heads of messages, recorded sessions
void session(std::string_view bytes);    // messages to a session, one per line

std::span<const Target> targets();
const Target* target_named(std::string_view name);  // null if unknown

// Calls `feed` and returns the message of InvalidInput, or an empty text if there was none. Checks that the message is
// a few printable lines.
std::string attempt(Feed feed, std::string_view bytes);

// Ends the program in every build if a property does not hold.
void require(bool holds, const char* what);
void require_message(std::string_view message);                 // a few printable lines
void require_printable(const std::vector<std::string>& texts);  // notes, names

}  // namespace aspic::fuzz
