#include <fmt/format.h>
#include <limits>
#include <map>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/external_program.h"
#include "io/mesh_file.h"
#include "viewer/animation.h"
#include "viewer/function_query.h"
#include "viewer/iteration_query.h"
#include "viewer/place_query.h"
#include "viewer/saved_scene.h"
#include "viewer/session_impl.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

constexpr int kMostTets = 500'000;  // of a mesh that a page can be given: about 60 MB of text

// As deformed now, by the user's numbers.
std::string mesh_text(const ShownSide& shown, const std::string& format) {
  const Model& model = shown.side.model();
  if (model.mesh.tet_count() > kMostTets)
    throw InvalidInput(
        fmt::format("a mesh of {} tets; at most {} are given to a page (a run writes its frames: "
                    "aspic run)",
                    model.mesh.tet_count(), kMostTets));
  const TemporaryFolder folder;
  const fs::path path = folder.path() / ("mesh." + format);
  const View view = shown.side.view();
  if (format == "obj" || format == "ply") {
    TriMesh mesh{shown.surface.rest, shown.surface.triangles};
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.vertices[v] = shown.surface.position(v, view.x);
    write_mesh(path, mesh);
  } else {
    TetMesh mesh = model.mesh;
    for (size_t v = 0; v < mesh.rest.size(); ++v)
      for (int r = 0; r < 3; ++r) mesh.rest[v][r] = view.x[3 * v + r];
    write_mesh(path, to_user(model.numbering, mesh));
  }
  return read_file(path);
}

Json mesh_reply(const ShownSide& shown, const Json& format) {
  for (const char* known : {"obj", "ply", "vtu", "msh", "mesh"})
    if (format == known)
      return {{"name", fmt::format("{}_{:06}.{}", shown.side.steered().scene.name, shown.side.steps_taken(), known)},
              {"text", mesh_text(shown, known)}};
  refuse("mesh.format", format, "'obj', 'ply', 'vtu', 'msh' or 'mesh' is expected");
}

Json gallery_reply(const Gallery& gallery) {
  Json reply = {{"scenes", Json::array()}, {"recent", Json::array()}};
  for (const OfferedScene& scene : gallery.scenes)
    reply["scenes"].push_back({{"name", scene.name}, {"about", scene.about}, {"path", scene.path.string()}});
  for (const fs::path& path : gallery.recent) reply["recent"].push_back(path.string());
  return reply;
}

}  // namespace

ShownSide& Session::Impl::side_of(Arguments& arguments) {
  const Json& name = arguments.value("side");
  if (name == "a") return *a;
  if (name != "b") refuse("side", name, "'a' or 'b' is expected");
  if (!b) throw InvalidInput("there is no side b; compare opens it");
  return *b;
}

Json Session::Impl::query(const Json& message) {
  Arguments asked(message, "message");
  const std::string what = asked.text("ask", 100);
  Arguments arguments(message, what);
  arguments.value("ask");
  arguments.value("id");  // without one nobody could tell what is answered
  if (what == "vertex") {
    const ShownSide& shown = side_of(arguments);
    const int vertex = arguments.integer("vertex", 0, shown.surface.vertex_count() - 1);
    arguments.finish();
    return vertex_reply(shown.side, shown.surface, vertex);
  }
  if (what == "tet") {
    const ShownSide& shown = side_of(arguments);
    const int triangle = arguments.integer("triangle", 0, shown.surface.triangle_count() - 1);
    arguments.finish();
    return tet_reply(shown.side, shown.surface, triangle);
  }
  if (what == "iteration") {
    ShownSide& shown = side_of(arguments);
    const int step = arguments.integer("step", 1, std::numeric_limits<int>::max());
    const int iteration = arguments.integer("iteration", 0, std::numeric_limits<int>::max());
    arguments.finish();
    return iteration_reply(shown.side, step, iteration, stop_token());
  }
  if (what == "worst") {
    const ShownSide& shown = side_of(arguments);
    arguments.finish();
    return worst_reply(shown.side);
  }
  if (what == "function") return function_reply(arguments);
  if (what == "mesh") {
    const ShownSide& shown = side_of(arguments);
    const Json& format = arguments.value("format");
    arguments.finish();
    return mesh_reply(shown, format);
  }
  if (what == "scene") {
    const ShownSide& shown = side_of(arguments);
    arguments.finish();
    return scene_reply(saved_scene(shown.side, SavedHand::with_drags));
  }
  if (what == "scene_files") {
    const ShownSide& shown = side_of(arguments);
    arguments.finish();
    return scene_files_reply(saved_scene(shown.side, SavedHand::without_drags));
  }
  if (what == "animation") {
    const ShownSide& shown = side_of(arguments);
    const Json& format = arguments.value("format");
    arguments.finish();
    return animation_reply(shown, format);
  }
  if (what == "gallery") {
    arguments.finish();
    return gallery_reply(options.gallery ? options.gallery() : Gallery{});
  }
  if (what == "recording") {
    arguments.finish();
    require_saved_material();
    if (!log.is_complete()) throw InvalidInput("too much was done to be recorded; reset begins a new recording");
    return to_json(
        Recording{a->side.steered().path.string(), base_overrides, comparison, log.events(), a->side.steps_taken()});
  }
  throw InvalidInput(fmt::format("unknown question '{}'{}", what,
                                 suggestion(what, {"vertex", "tet", "iteration", "worst", "function", "mesh", "scene",
                                                   "scene_files", "animation", "gallery", "recording"})));
}

}  // namespace aspic::viewer
