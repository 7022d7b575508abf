// The saved scene of a session is portable and repeats the session.
#include <gmock/gmock.h>

#include <filesystem>

#include "base/hash.h"
#include "dynamics/state.h"
#include "io/base64.h"
#include "io/gzip.h"
#include "io/mesh_file.h"
#include "mesh/generators.h"
#include "scene/scene.h"
#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string from_base64(const std::string& text) {
  std::string_view rest = text;
  std::string bytes;
  EXPECT_TRUE(decode_base64(rest, text.size(), bytes));
  return bytes;
}

// Writes the files of a reply to a folder and returns the path of the scene.
fs::path written(const Json& reply, const fs::path& folder) {
  for (const Json& file : reply.at("files")) {
    const fs::path path = folder / file.at("name").get<std::string>();
    fs::create_directories(path.parent_path());
    write_file(path, gunzipped(from_base64(file.at("gzip")), 1 << 20));
  }
  return folder / reply.at("scene").get<std::string>();
}

std::string hash_after(const fs::path& scene_path, int steps) {
  Scene scene = load_scene(scene_path);
  for (int i = 0; i < steps; ++i) scene.simulation.step();
  return hex_digits(scene.simulation.state_hash());
}

std::string hash_after(const std::string& toml, int steps) {
  static const TestFolder folder;
  write_file(folder.path() / "saved.toml", toml);
  return hash_after(folder.path() / "saved.toml", steps);
}

std::string hash_of_last(Page& page) { return page.rows().back().at("state_hash").get<std::string>(); }

std::string mesh_scene(const fs::path& folder) {
  write_mesh(folder / "block.msh", make_box({}, {{1, 0.2, 0.2}}, {5, 2, 2}));
  const std::string toml = std::string(kBeam).replace(
      kBeam.find("shape"), kBeam.find('\n', kBeam.find("shape")) - kBeam.find("shape"), "mesh = \"block.msh\"");
  write_file(folder / "block.toml", toml);
  return (folder / "block.toml").string();
}

TEST(SavedScene, RepeatsTheSessionsFirstSteps) {
  Page page;
  page.send({{"do", "set"}, {"key", "material.young"}, {"value", 3e5}});
  page.steps(3);
  const Json saved = page.send({{"ask", "scene"}, {"side", "a"}});
  EXPECT_THAT(saved["name"], HasSubstr(".toml"));
  EXPECT_EQ(hash_after(saved["text"].get<std::string>(), 3), hash_of_last(page));
}

TEST(SavedScene, RepeatsADragBitForBit) {
  Page page;
  page.steps(1);
  page.grab_end({1, 0.3, 0.1});
  page.steps(2);
  page.send({{"do", "move"}, {"target", {1.1, 0.4, 0.2}}});
  page.steps(2);
  page.send({{"do", "stiffness"}, {"value", 50}});
  page.steps(1);
  page.send({{"do", "release"}});
  page.steps(2);
  const std::string toml = page.send({{"ask", "scene"}, {"side", "a"}})["text"];
  EXPECT_THAT(toml, HasSubstr("[[body.grab]]"));
  EXPECT_EQ(hash_after(toml, 8), hash_of_last(page));
}

TEST(SavedScene, OmitsRewoundDrags) {
  Page page;
  page.grab_end({1, 0.3, 0.1});
  page.steps(2);
  page.send({{"do", "reset"}});
  EXPECT_THAT(page.send({{"ask", "scene"}, {"side", "a"}})["text"].get<std::string>(), Not(HasSubstr("grab")));
}

TEST(SavedScene, KeepsPinsSetAtTheStart) {
  Page page;
  const Geometry& g = page.geometry();
  int end = 0;
  for (size_t v = 0; v < g.rest.size() / 3; ++v)
    if (g.rest[3 * v] > 0.999F) end = static_cast<int>(v);
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", {end}}, {"pinned", true}});
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", {page.pins()[0]}}, {"pinned", false}});
  page.steps(2);
  const Json saved = page.send({{"ask", "scene"}, {"side", "a"}});
  EXPECT_TRUE(saved["notes"].empty());
  EXPECT_EQ(hash_after(saved["text"].get<std::string>(), 2), hash_of_last(page));
}

TEST(SavedScene, NotesLaterPins) {
  Page page;
  page.steps(1);
  page.send({{"do", "pin"}, {"side", "a"}, {"vertices", {page.pins()[0]}}, {"pinned", false}});
  EXPECT_THAT(page.send({{"ask", "scene"}, {"side", "a"}})["notes"].dump(), HasSubstr("pins"));
}

TEST(SavedScene, IncludesItsMesh) {
  const TestFolder folder;
  Page page;
  page.send({{"do", "load"}, {"scene", mesh_scene(folder.path())}});
  page.steps(2);
  const Json archive = page.send({{"ask", "scene"}, {"side", "a"}});
  EXPECT_EQ(archive["name"], "block.zip");
  EXPECT_EQ(from_base64(archive["base64"]).substr(0, 4), "PK\3\4");
  const Json files = page.send({{"ask", "scene_files"}, {"side", "a"}});
  const fs::path scene = written(files, folder.path() / "elsewhere");
  fs::remove_all(folder.path() / "block.msh");
  EXPECT_THAT(read_file(scene), Not(HasSubstr(folder.path().string()))) << "no path of this machine";
  EXPECT_EQ(hash_after(scene, 2), hash_of_last(page));
}

TEST(SavedScene, IsLoadedFromItsFiles) {
  const TestFolder folder;
  Page page;
  page.send({{"do", "load"}, {"scene", mesh_scene(folder.path())}});
  page.steps(2);
  const std::string hash = hash_of_last(page);
  const Json files = page.send({{"ask", "scene_files"}, {"side", "a"}});
  page.refused({{"do", "load"}, {"scene", "../block.toml"}, {"files", files["files"]}});
  page.send({{"do", "load"}, {"scene", files["scene"]}, {"files", files["files"]}});
  fs::remove_all(folder.path() / "block.msh");
  EXPECT_EQ(page.scene()["name"], "block");
  page.send({{"do", "set"}, {"key", "time.step"}, {"value", 0.01}});  // reads the files again
  page.steps(2);
  EXPECT_EQ(hash_of_last(page), hash);
}

Json upload(const std::string& name, const std::string& gzip) {
  return {{"do", "load"}, {"scene", name}, {"files", {{{"name", name}, {"gzip", gzip}}}}};
}

TEST(Upload, RefusesNamesOutsideTheUpload) {
  Page page;
  for (const char* name : {"../a.toml", "/tmp/a.toml", "a/../../b.toml", "", ".", "a\nb.toml", "c:\\a.toml"})
    EXPECT_THAT(page.refused(upload(name, "")), HasSubstr("invalid name")) << name;
}

TEST(Upload, RefusesUnpackedFiles) {
  Page page;
  EXPECT_THAT(page.refused(upload("a.toml", "!")), HasSubstr("base64"));
  EXPECT_THAT(page.refused(upload("a.toml", "aGVsbG8=")), HasSubstr("a.toml"));
  EXPECT_EQ(page.scene()["bodies"][0], "beam") << "the old scene stays";
}

}  // namespace
}  // namespace aspic::viewer
