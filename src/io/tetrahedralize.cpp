#include "io/tetrahedralize.h"

#include <cmath>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/external_program.h"
#include "io/mesh_file.h"
#include "io/number_text.h"
#include "mesh/box.h"
#include "mesh/cage.h"

namespace aspic {

namespace fs = std::filesystem;

#ifdef __EMSCRIPTEN__  // a browser runs no other program

Tetrahedralization tetrahedralize(const fs::path& path, const TetrahedralizeOptions& options) {
  const TriMesh surface = read_tri_mesh(path);
  const Box box = bounding_box(surface.vertices);
  TetMesh cage;
  try {
    cage = make_cage(surface, options.size > 0 ? options.size : norm(box.upper - box.lower) / 25);
  } catch (const InvalidInput& e) {
    throw InvalidInput(path.string() + ": " + e.what());
  }
  if (cage.tets.empty()) throw InvalidInput(path.string() + ": is flat; a body needs a closed surface");
  return {std::move(cage),
          {"this page has no mesher, so that the tets are those of cubes around the surface; for tets that follow it, "
           "install Aspic and run: ./run mesh " +
           path.filename().string()}};
}

#else

namespace {

constexpr const char* kProgram = "aspic-mesh";
constexpr int kOutOfTime = 4;  // exit code of the program

// Search path: beside this program (installation), its place in the build folder, the PATH.
fs::path mesher() {
  const fs::path here = program_folder();
  return find_program(kProgram, {here, here / ".." / "mesh", here / ".." / "apps" / "mesh", here / "apps" / "mesh"},
                      "filling a surface with tets needs it; in Aspic's sources `./run mesh` builds it (or "
                      "-DASPIC_MESHER=ON, Debian package libcgal-dev), or give a mesh of tets");
}

void add_option(const char* name, double value, std::vector<std::string>& words) {
  if (!(value > 0)) return;
  words.emplace_back(name);
  append_number(words.emplace_back(), value);
}

// Returns the lines that begin with the name of the surface; lines of the quality table do not.
std::vector<std::string> notes(const fs::path& output, const std::string& surface) {
  std::error_code error;
  std::istringstream lines(fs::exists(output, error) ? read_file(output) : "");
  std::vector<std::string> notes;
  const std::string start = surface + ": ";
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(start)) notes.push_back(line.substr(start.size()));
  return notes;
}

}  // namespace

Tetrahedralization tetrahedralize(const fs::path& surface, const TetrahedralizeOptions& options) {
  if (!(options.size >= 0) || !std::isfinite(options.size))
    throw InvalidInput(surface.string() + ": the target edge length is " + std::to_string(options.size) +
                       "; it must be positive, or 0 for a default");
  if (!options.program.empty() && !is_program(options.program))
    throw InvalidInput(options.program.string() + ": is not a program; give the path of " + kProgram);
  const fs::path program = options.program.empty() ? mesher() : options.program;
  const TemporaryFolder folder;
  const fs::path result = folder.path() / "tets.mesh";
  std::vector<std::string> words = {fs::absolute(program).string(), fs::absolute(surface).string(), "-o",
                                    result.string()};
  add_option("--size", options.size, words);
  add_option("--time-limit", options.seconds, words);
  const std::string said = run_program({.name = kProgram,
                                        .command = words,
                                        .about = surface.string(),
                                        .messages = folder.path() / "messages",
                                        .output = folder.path() / "output",
                                        .after_signal = "out of memory? try a larger size",
                                        .when_unusable = "build it again with -DASPIC_MESHER=ON",
                                        .out_of_time = kOutOfTime});
  std::error_code error;
  if (!fs::exists(result, error)) throw InvalidInput(surface.string() + ": " + kProgram + " wrote no mesh: " + said);
  return {read_tet_mesh(result), notes(folder.path() / "output", words[1])};
}

#endif

}  // namespace aspic
