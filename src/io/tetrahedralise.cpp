#include "io/tetrahedralise.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "base/error.h"
#include "io/external_program.h"
#include "io/mesh_file.h"
#include "io/number_text.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "aspic-mesh";

// Beside this program, where an installation has it; at its place in the build folder; on the PATH.
fs::path mesher() {
  const fs::path here = program_folder();
  return find_program(kProgram, {here, here / ".." / "mesh", here / ".." / "apps" / "mesh", here / "apps" / "mesh"},
                      "filling a surface with tets needs it; build Aspic with -DASPIC_MESHER=ON (Debian package "
                      "libcgal-dev), or give a mesh of tets");
}

// The diagonal of the surface's bounding box / 25.
double default_size(const fs::path& surface) {
  const TriMesh mesh = read_tri_mesh(surface);
  Vec3d lower = mesh.vertices.at(0), upper = lower;
  for (const Vec3d& vertex : mesh.vertices)
    for (int i = 0; i < 3; ++i) {
      lower[i] = std::min(lower[i], vertex[i]);
      upper[i] = std::max(upper[i], vertex[i]);
    }
  const double diagonal = std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
  if (!(diagonal > 0)) throw InvalidInput(surface.string() + ": all vertices are in one place; use a closed surface");
  return diagonal / 25;
}

}  // namespace

TetMesh tetrahedralise(const fs::path& surface, const TetrahedraliseOptions& options) {
  if (!(options.size >= 0) || !std::isfinite(options.size))
    throw InvalidInput(surface.string() + ": the target edge length is " + std::to_string(options.size) +
                       "; it must be positive, or 0 for a default");
  if (!options.program.empty() && !is_program(options.program))
    throw InvalidInput(options.program.string() + ": is not a program; give the path of " + kProgram);
  const fs::path program = options.program.empty() ? mesher() : options.program;
  std::string size;
  append_number(size, options.size > 0 ? options.size : default_size(surface));

  const TemporaryFolder folder;
  const fs::path result = folder.path() / "tets.mesh";
  const std::string said = run_program({.name = kProgram,
                                        .command = {fs::absolute(program).string(), fs::absolute(surface).string(),
                                                    "-o", result.string(), "--size", size},
                                        .about = surface.string(),
                                        .messages = folder.path() / "messages",
                                        .after_signal = "out of memory? try a larger size",
                                        .when_unusable = "build it again with -DASPIC_MESHER=ON"});
  std::error_code error;
  if (!fs::exists(result, error)) throw InvalidInput(surface.string() + ": " + kProgram + " wrote no mesh: " + said);
  return read_tet_mesh(result);
}

}  // namespace aspic
