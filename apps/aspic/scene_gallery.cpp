// `aspic gallery`: lists and runs shipped scenes for newcomers.
#include "aspic/scene_gallery.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "aspic/commands.h"
#include "aspic/shipped_files.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "scene/first_comment.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

// Drops the page number of a scene of the lecture: 01_cape.
std::string name_of(const fs::path& scene) {
  const std::string stem = scene.stem().string();
  return stem.substr(stem.find_first_not_of("0123456789_"));
}

std::vector<GalleryScene> shipped_gallery() {
  const fs::path table = shipped_file("scenes/gallery.json");
  if (table.empty())
    throw InvalidInput(
        "scenes/gallery.json is missing: call aspic in its source folder, or install it with its scenes");
  return gallery_scenes(table.parent_path());
}

int list() {
  std::string level;
  for (const GalleryScene& scene : shipped_gallery()) {
    if (scene.level != level) fmt::print("{}{}:\n", level.empty() ? "" : "\n", scene.level);
    level = scene.level;
    fmt::print("  {:<24} {}\n", scene.name, scene.about);
  }
  fmt::print("\naspic gallery NAME runs one of them. Pictures: docs/gallery.md\n");
  return exit_done;
}

int run(const std::string& name) {
  const std::vector<GalleryScene> scenes = shipped_gallery();
  const GalleryScene& scene = scene_named(name, scenes);
  fmt::print("{}\n", scene.about);
  const fs::path out = fs::path("out") / name;
  const int code = run_scene(scene.file, out);
  fmt::print("\nlive       aspic view {}\n", scene.file.string());
  fmt::print("play       aspic view {}\n", out.string());
  fmt::print("video      aspic render {} -o {}.mp4\n", out.string(), name);
  return code;
}

}  // namespace

std::vector<GalleryScene> gallery_scenes(const fs::path& folder) {
  const fs::path table = folder / "gallery.json";
  std::vector<GalleryScene> scenes;
  try {
    for (const auto& row : nlohmann::json::parse(read_file(table))) {
      const fs::path path = row.at("scene").get<std::string>();
      scenes.push_back(
          {name_of(path), row.at("level").get<std::string>(), first_comment(folder / path), path, folder / path});
    }
  } catch (const nlohmann::json::exception& e) {
    throw InvalidInput(fmt::format("{}: {}", table.string(), e.what()));
  }
  return scenes;
}

const GalleryScene& scene_named(const std::string& name, const std::vector<GalleryScene>& scenes) {
  std::vector<std::string> names;
  for (const GalleryScene& scene : scenes) {
    if (scene.name == name) return scene;
    names.push_back(scene.name);
  }
  throw InvalidInput(
      fmt::format("no scene '{}' in the gallery{}; aspic gallery lists them", name, suggestion(name, names)));
}

std::string gallery_page(const std::vector<GalleryScene>& scenes) {
  constexpr int kColumns = 3;
  std::string text =
      "# Gallery\n\nFor newcomers: scenes that take at most a minute on two cores, **cape** several minutes. `aspic "
      "gallery NAME`, in a "
      "checkout `./run gallery NAME`, runs one into `out/NAME`; a picture links its file.\n";
  std::string level;
  int column = 0;
  const auto end_row = [&] {
    if (column % kColumns) text += "\n";
  };
  for (const GalleryScene& scene : scenes) {
    if (scene.level != level) {
      end_row();
      level = scene.level, column = 0;
      text += fmt::format("\n## {}{}\n\n| | | |\n|---|---|---|\n", static_cast<char>(std::toupper(level[0])),
                          level.substr(1));
    }
    text += fmt::format("| [![{0}](../scenes/gallery/{0}.webp)](../scenes/{1})<br>**{0}**: {2} ", scene.name,
                        scene.path.string(), scene.about);
    if (++column % kColumns == 0) text += "|\n";
  }
  end_row();
  return text;
}

void add_gallery(CLI::App& app, Action& action) {
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("gallery", "Lists and runs the scenes of the gallery");
  command->footer(R"(
Examples:
  aspic gallery           names, sentences and difficulties
  aspic gallery knot      results in out/knot; a second call continues the run or does nothing)");
  command->add_option("NAME", *name, "Scene to run; lists them by default");
  command->callback([name, &action] { action = [name] { return name->empty() ? list() : run(*name); }; });
}

}  // namespace aspic::cli
