// `aspic convert`: converts between mesh formats, and runs to animated glTF.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <variant>

#include "aspic/commands.h"
#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/mesh_file.h"
#include "mesh/elements.h"
#include "mesh/surface.h"
#include "results/run_directory.h"
#include "results/run_gltf.h"
#include "scene/scene.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertArguments {
  fs::path in, out;
  bool surface = false, binary = false;
};

std::string describe(const TetMesh& mesh) { return size_text(mesh); }
std::string describe(const TriMesh& mesh) {
  return fmt::format("{} vertices, {} triangles", mesh.vertex_count(), mesh.triangle_count());
}

const MeshFormat& format_of(const fs::path& path) {
  std::vector<std::string> writable;
  for (const MeshFormat& format : mesh_formats()) {
    if (format.extension == path.extension()) return format;
    if (format.writes_tets || format.writes_triangles) writable.push_back(format.extension);
  }
  throw InvalidInput(fmt::format("{}: '{}' is not the extension of a mesh format{}", path.string(),
                                 path.extension().string(), suggestion(path.extension().string(), writable)));
}

template <class Mesh>
int write(const ConvertArguments& arguments, const Mesh& mesh, const std::string& what) {
  write_mesh(arguments.out, mesh, arguments.binary ? FileEncoding::binary : FileEncoding::ascii);
  fmt::print("{}: {}{}\n", printable(arguments.out.string()), what, describe(mesh));
  return exit_done;
}

int convert_run(const ConvertArguments& arguments) {
  const RunLayout layout(arguments.in);
  if (!layout.holds_run())
    throw InvalidInput(arguments.in.string() + ": is a folder without a run (there is no steps.csv of one)");
  if (arguments.out.extension() == ".usda")
    throw InvalidInput(
        fmt::format("{}: a run writes it itself (output.usd): {}", arguments.out.string(), layout.usd().string()));
  if (arguments.out.extension() != ".glb")
    throw InvalidInput(arguments.out.string() + ": a run becomes animated glTF; name the file .glb");
  const RunGltf gltf = run_glb(layout, load_scene(scene_of_run(arguments.in)));
  write_file(arguments.out, gltf.bytes);
  fmt::print("{}: {} of {} frames, {:.1f} MB\n", printable(arguments.out.string()), gltf.frames, gltf.frames_of_run,
             1e-6 * static_cast<double>(gltf.bytes.size()));
  return exit_done;
}

int convert(const ConvertArguments& arguments) {
  if (fs::is_directory(arguments.in)) return convert_run(arguments);
  const MeshFormat& format = format_of(arguments.out);
  std::vector<std::string> notes;
  const auto mesh = read_mesh(arguments.in, &notes);
  fmt::print("{}: {}\n", printable(arguments.in.string()), std::visit([](const auto& m) { return describe(m); }, mesh));
  for (const std::string& note : notes) fmt::print("note: {}\n", printable(note));

  if (const auto* tets = std::get_if<TetMesh>(&mesh)) {
    if (format.writes_tets && !arguments.surface) return write(arguments, *tets, "");
    if (format.writes_triangles) return write(arguments, boundary_surface(*tets).surface, "the boundary, ");
  } else {
    if (format.writes_triangles) return write(arguments, std::get<TriMesh>(mesh), "");
    if (format.writes_tets) {
      throw InvalidInput(fmt::format("{} is a surface but {} stores tets; fill it first: aspic mesh {} -o {}",
                                     arguments.in.string(), format.extension, arguments.in.string(),
                                     arguments.out.string()));
    }
  }
  const std::string remedy = format.extension == ".gltf" ? "; name the file .glb" : "";
  throw InvalidInput(fmt::format("{}: {} can be read but not written{}", arguments.out.string(), format.name, remedy));
}

std::string format_table() {
  std::string text = "\nFormats (r: read, w: write):           tets  triangles\n";
  for (const MeshFormat& format : mesh_formats()) {
    const auto mark = [](bool reads, bool writes) { return std::string(reads ? "r" : "-") + (writes ? "w" : "-"); };
    text +=
        fmt::format("  {:<6} {:<30} {}    {}\n", format.extension, format.name,
                    mark(format.reads_tets, format.writes_tets), mark(format.reads_triangles, format.writes_triangles));
  }
  return text;
}

}  // namespace

void add_convert(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert", "Converts a mesh to another format, selected by the file name, or a run to animated glTF");
  command->footer([] {
    return "\nExamples:\n  aspic convert bunny.msh bunny.vtu\n  aspic convert bunny.mesh bunny.obj    the boundary\n"
           "  aspic convert bunny.obj bunny.glb     for Blender and browsers\n"
           "  aspic convert out/bunny bunny.glb     the skins and obstacles of a run, at most 240 frames\n" +
           format_table();
  });
  command->add_option("IN", arguments->in, "Mesh, or folder of a run")->required();
  command->add_option("OUT", arguments->out, "Mesh to write; an existing file is replaced")->required();
  command->add_flag("--surface", arguments->surface, "Write the boundary of a tet mesh instead of its tets");
  command->add_flag("--binary", arguments->binary, "Write the binary encoding if the format has both");
  command->callback([arguments, &action] { action = [arguments] { return convert(*arguments); }; });
}

}  // namespace aspic::cli
