#include "aspic/gallery.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic::cli {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using SceneGallery = FolderTest;

TEST_F(SceneGallery, ListsScenesWithTheirFirstComment) {
  std::filesystem::create_directories(path("sub"));
  write_file(path("b.toml"), "# A beam.\n[time]\n");
  write_file(path("sub/a.toml"), "[time]\n");
  write_file(path("notes.txt"), "# none\n");
  const auto scenes = viewer::scenes_below(folder);
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[0].name, "b.toml");
  EXPECT_EQ(scenes[0].about, "A beam.");
  EXPECT_EQ(scenes[1].name, "sub/a.toml");
  EXPECT_EQ(scenes[1].about, "");
  EXPECT_THAT(viewer::scenes_below(path("none")), IsEmpty());
}

TEST_F(SceneGallery, RemembersWhatWasOpenedNewestFirst) {
  const std::filesystem::path scenes = std::filesystem::path(ASPIC_SOURCE_DIR) / "scenes";
  const auto a = scenes / "bunny.toml", b = scenes / "chute.toml";
  const RecentScenes recent(path("state/aspic/recent"));
  ::setenv("TMPDIR", folder.path().c_str(), 1);  // the source may lie in /tmp, whose scenes are forgotten
  EXPECT_THAT(recent.read(), IsEmpty());
  recent.note(a);
  recent.note(b);
  recent.note(a);
  EXPECT_THAT(recent.read(), ElementsAre(a, b));
  write_file(path("state/aspic/recent"), (scenes / "none.toml").string() + "\n" + b.string() + "\n");
  EXPECT_THAT(recent.read(), ElementsAre(b));
  RecentScenes(std::filesystem::path()).note(b);
  ::unsetenv("TMPDIR");
}

TEST_F(SceneGallery, ForgetsTemporaryScenes) {
  write_file(path("a.toml"), "");
  const RecentScenes recent(path("state/aspic/recent"));
  recent.note(path("a.toml"));
  EXPECT_THAT(recent.read(), IsEmpty());
  std::filesystem::create_directories(path("state/aspic"));
  write_file(path("state/aspic/recent"), path("a.toml").string() + "\n");  // noted by an earlier version
  EXPECT_THAT(recent.read(), IsEmpty());
}

}  // namespace
}  // namespace aspic::cli
