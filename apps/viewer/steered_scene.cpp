#include "viewer/steered_scene.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/free_memory.h"
#include "scene/scene_document.h"
#include "viewer/session.h"
#include "viewer/settings.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerTet = 3000;  // with matrices, skin and snapshots; multigrid uses a third

// Reading a device or a pipe may never end.
void require_file(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return;
  throw InvalidInput(fmt::format("{}: {}; a scene (.toml) or a mesh is expected", path.string(),
                                 fs::exists(path, error) ? "not a file" : "no such file"));
}

// The current scene stays in memory during loading, and a comparison has two sides.
TetLimit tets_that_fit(double most) {
  const double share = 0.25 * static_cast<double>(free_memory());
  if (most * kBytesPerTet < share) return {.tets = most, .why = "are allowed here", .counts_files = true};
  return {
      .tets = std::floor(share / kBytesPerTet),
      .why = fmt::format("fit into the {:.1f} GB that a session may use, a quarter of the free memory", share / 1e9),
      .counts_files = true};
}

// Such a setting does not change the loaded model.
bool needs_only_solver(const std::string& key) {
  return key.starts_with("solver.") && key != "solver.mass" && key != "solver.initial_guess";
}

}  // namespace

SteeredScene load_steered(const fs::path& path, const std::vector<std::string>& overrides, const Announce& announce,
                          const SessionOptions& options) {
  require_file(path);
  GrabSpring* mouse = nullptr;
  std::unique_ptr<SideTool> tool;
  size_t mouse_load = 0, tool_load = 0;
  const auto amend = [&](Model& model) {
    tool_load = model.loads.size();
    tool = options.extension.make_tool ? options.extension.make_tool(model) : std::make_unique<SideTool>();
    auto spring = std::make_unique<GrabSpring>();
    mouse = spring.get();
    mouse_load = model.loads.size();
    model.loads.push_back(std::move(spring));
  };
  Scene scene = load_scene(
      path, {.overrides = overrides, .announce = announce, .limit = tets_that_fit(options.most_tets), .amend = amend});
  Table document = read_scene_document(scene.resolved, path.string());
  return {std::move(scene), mouse, mouse_load, std::move(tool), tool_load, std::move(document), path, overrides};
}

SceneChange changed_scene(const SteeredScene& steered, const std::string& override_text, const Announce& announce,
                          const SessionOptions& session) {
  SceneChange change{.overrides = with_override(steered.overrides, override_text)};
  const bool drops = override_text.find('=') == std::string::npos;  // restores the value in the scene file
  const Simulation& simulation = steered.scene.simulation;
  if (!drops && needs_only_solver(key_of(override_text))) {
    change.document = read_scene_document(steered.scene.resolved, steered.path.string(), {override_text});
    change.solver = solver_options(*change.document.find("solver"));
    SimulationOptions options = simulation.options();
    options.solver = *change.solver;
    if (const auto conflict = find_conflict(options)) throw InvalidInput(conflict->reason);
    return change;
  }
  change.reloaded = load_steered(steered.path, change.overrides, announce, session);
  if (change.reloaded->scene.simulation.model().mesh.vertex_count() != simulation.model().mesh.vertex_count())
    throw InvalidInput(fmt::format("{} changes the mesh; load the scene anew with it", override_text));
  change.reloaded->tool->continue_from(*steered.tool);
  return change;
}

}  // namespace aspic::viewer
