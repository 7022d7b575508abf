// The table, files, pictures and page of the gallery agree.
#include "aspic/scene_gallery.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <set>

#include "base/error.h"
#include "io/atomic_file.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kShipped = fs::path(ASPIC_SOURCE_DIR) / "scenes";

TEST(GalleryTable, HasSceneSentenceAndPictureOfEachName) {
  const std::set<std::string> levels = {"first steps", "intermediate", "research"};
  std::set<std::string> names;
  for (const GalleryScene& scene : gallery_scenes(kShipped)) {
    EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
    EXPECT_TRUE(levels.contains(scene.level)) << scene.name;
    EXPECT_TRUE(scene.about.ends_with('.')) << scene.file << ": the first comment is not one sentence";
    EXPECT_TRUE(fs::exists(kShipped / "gallery" / (scene.name + ".webp"))) << scene.name << ": tools/gallery makes it";
  }
  EXPECT_GE(names.size(), 24u);
  for (const auto& entry : fs::directory_iterator(kShipped / "gallery")) {
    const bool is_listed = entry.path().extension() == ".toml" || entry.path().extension() == ".webp";
    EXPECT_TRUE(!is_listed || names.contains(entry.path().stem())) << entry.path() << ": is not in gallery.json";
  }
}

TEST(GalleryTable, PageIsThatOfTheTable) {
  const fs::path page = fs::path(ASPIC_SOURCE_DIR) / "docs" / "gallery.md";
  const std::string text = gallery_page(gallery_scenes(kShipped));
  if (std::getenv("ASPIC_UPDATE_DOCS")) write_file(page, text);
  EXPECT_EQ(read_file(page), text) << "tools/gallery writes docs/gallery.md anew";
}

TEST(GalleryTable, SuggestsTheNearestName) {
  const std::vector<GalleryScene> scenes = gallery_scenes(kShipped);
  EXPECT_EQ(scene_named("knot", scenes).file, kShipped / "gallery/knot.toml");
  for (const char* name : {"knots", "Knot", "kont"}) {
    try {
      scene_named(name, scenes);
      ADD_FAILURE() << name;
    } catch (const InvalidInput& e) {
      EXPECT_THAT(e.what(), HasSubstr("did you mean 'knot'?"));
    }
  }
}

}  // namespace
}  // namespace aspic::cli
