// The questions of a page. They change no state, and any page may send them.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/external_program.h"
#include "io/mesh_file.h"
#include "viewer/commands.h"
#include "viewer/playback.h"
#include "viewer/replies.h"
#include "viewer/saved_scene.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxTets = 500'000;  // maximum size of a mesh for a page: about 60 MB of text
constexpr int kMaxInt = std::numeric_limits<int>::max();

// The deformed mesh with the vertex and tet numbers of the user.
std::string mesh_text(const ShownSide& shown, const std::string& format) {
  const Model& model = shown.side.model();
  if (model.mesh.tet_count() > kMaxTets)
    throw InvalidInput(
        fmt::format("a mesh of {} tets; the page exports at most {}. Use aspic run, which writes frames of any size",
                    model.mesh.tet_count(), kMaxTets));
  const TemporaryFolder folder;
  const fs::path path = folder.path() / ("mesh." + format);
  const Positions x = shown.side.positions();
  if (format == "obj" || format == "ply") {
    TriMesh mesh{shown.surface.rest, shown.surface.triangles};
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.vertices[v] = shown.surface.position(v, x);
    write_mesh(path, mesh);
  } else {
    TetMesh mesh = model.mesh;
    for (size_t v = 0; v < mesh.rest.size(); ++v)
      for (int r = 0; r < 3; ++r) mesh.rest[v][r] = x[3 * v + r];
    write_mesh(path, to_user(model.numbering, mesh));
  }
  return read_file(path);
}

Json mesh_reply(const ShownSide& shown, const std::string& format) {
  return {{"name", fmt::format("{}_{:06}.{}", shown.side.steered().scene.name, shown.side.steps_taken(), format)},
          {"text", mesh_text(shown, format)}};
}

Camera camera_of(const Json& value) {
  Arguments arguments(value, "camera");
  Camera camera{.eye = arguments.vector("eye"),
                .right = arguments.vector("right"),
                .up = arguments.vector("up"),
                .slope = arguments.number("slope"),
                .nearest = arguments.number("nearest")};
  const double skew =
      std::abs(dot(camera.right, camera.up)) + std::abs(norm(camera.right) - 1) + std::abs(norm(camera.up) - 1);
  if (!(skew < 1e-6 && camera.slope > 0 && camera.nearest > 0))
    refuse("camera", value, "orthonormal right and up, and positive slope and nearest");
  arguments.finish();
  return camera;
}

Json mesh_error_reply(Stage& stage, ShownSide& shown, const StopToken& stop) {
  shown.side.estimate_mesh_error(stop);
  if (stop.stopped()) throw Interrupted("interrupted by a command; repeat the question");
  stage.send(steps_message(shown, shown.side.steps_taken() - 1));
  stage.send_new_fields();
  return shown.side.history().rows().last()->report.mesh_error;
}

Json gallery_reply(const Gallery& gallery) {
  Json reply = {{"scenes", Json::array()}, {"recent", Json::array()}};
  for (const OfferedScene& scene : gallery.scenes)
    reply["scenes"].push_back(
        {{"name", scene.name}, {"about", scene.about}, {"path", scene.path.string()}, {"picture", scene.picture}});
  for (const fs::path& path : gallery.recent) reply["recent"].push_back(path.string());
  return reply;
}

}  // namespace

void add_questions(const SessionOptions& options, Stage& stage, const Playback& playback, Questions& questions) {
  const auto add = [&](const char* name, auto reply) {
    questions[name] = [&stage, reply](Arguments& arguments) { return reply(stage.named(arguments), arguments); };
  };
  add("vertex", [](ShownSide& shown, Arguments& arguments) {
    const int vertex = arguments.integer("vertex", 0, shown.surface.vertex_count() - 1);
    arguments.finish();
    return vertex_reply(shown, vertex);
  });
  add("tet", [](ShownSide& shown, Arguments& arguments) {
    const int triangle = arguments.integer("triangle", 0, shown.surface.triangle_count() - 1);
    arguments.finish();
    return tet_reply(shown, triangle);
  });
  add("iteration", [&playback](ShownSide& shown, Arguments& arguments) {
    const int step = arguments.integer("step", 1, kMaxInt), iteration = arguments.integer("iteration", 0, kMaxInt);
    arguments.finish();
    return iteration_reply(shown.side, step, iteration, playback.stop_token());
  });
  add("mesh", [](ShownSide& shown, Arguments& arguments) {
    const std::string format = arguments.choice("format", {"obj", "ply", "vtu", "msh", "mesh"});
    arguments.finish();
    return mesh_reply(shown, format);
  });
  add("animation", [](ShownSide& shown, Arguments& arguments) {
    const std::string format = arguments.choice("format", {"usd", "pc2", "glb"});
    std::optional<Camera> camera;
    if (arguments.has("camera")) camera = camera_of(arguments.value("camera"));
    arguments.finish();
    return animation_reply(shown, format, camera);
  });
  const auto add_plain = [&](const char* name, auto reply_of) {
    add(name, [reply_of](ShownSide& shown, Arguments& arguments) {
      arguments.finish();
      return reply_of(shown);
    });
  };
  add_plain("worst", worst_reply);
  add_plain("mesh_error", [&](ShownSide& s) { return mesh_error_reply(stage, s, playback.stop_token()); });
  add_plain("scene", [](ShownSide& s) { return scene_reply(saved_scene(s.side, SavedHand::with_drags)); });
  add_plain("scene_files",
            [](ShownSide& s) { return scene_files_reply(saved_scene(s.side, SavedHand::without_drags)); });
  questions["function"] = function_reply;
  questions["gallery"] = [&](Arguments& arguments) {
    arguments.finish();
    return gallery_reply(options.gallery ? options.gallery() : Gallery{});
  };
  questions["recording"] = [&](Arguments& arguments) {
    arguments.finish();
    return to_json(stage.recording());
  };
}

}  // namespace aspic::viewer
