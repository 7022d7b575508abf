#include "aspic/gallery.h"

#include <gmock/gmock.h>

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
  for (const char* name : {"a.toml", "b.toml"}) write_file(path(name), "");
  const RecentScenes recent(path("state/aspic/recent"));
  EXPECT_THAT(recent.read(), IsEmpty());
  recent.note(path("a.toml"));
  recent.note(path("b.toml"));
  recent.note(path("a.toml"));
  EXPECT_THAT(recent.read(), ElementsAre(path("a.toml"), path("b.toml")));
  std::filesystem::remove(path("a.toml"));
  EXPECT_THAT(recent.read(), ElementsAre(path("b.toml")));
  RecentScenes(std::filesystem::path()).note(path("b.toml"));
}

}  // namespace
}  // namespace aspic::cli
