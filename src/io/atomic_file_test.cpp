#include "io/atomic_file.h"

#include <gmock/gmock.h>
#include <stdlib.h>

#include "io/folder_test.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using AtomicFile = FolderTest;

TEST_F(AtomicFile, ReadsBackWrittenContents) {
  const std::string contents("a\0b\r\n\xff", 6);
  write_file(folder / "a", contents);
  EXPECT_EQ(read_file(folder / "a"), contents);
  write_file(folder / "a", "");
  EXPECT_EQ(read_file(folder / "a"), "");
}

TEST_F(AtomicFile, LeavesNoTemporaryFile) {
  write_file(folder / "a", "1");
  write_file(folder / "a", "2");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(AtomicFile, SetsDefaultPermissionsAndKeepsOldOnes) {
  write_file(folder / "a", "1");
  EXPECT_NE(fs::status(folder / "a").permissions() & fs::perms::owner_read, fs::perms::none);
  fs::permissions(folder / "a", fs::perms::owner_all);
  write_file(folder / "a", "2");
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_all);
}

TEST_F(AtomicFile, KeepsSymbolicLinks) {
  write_file(folder / "a", "1");
  fs::create_symlink(folder / "a", folder / "link");
  write_file(folder / "link", "2");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "a"), "2");
}

TEST_F(AtomicFile, RejectsSparseFiles) {
  write_file(folder / "sparse", "MeshVersionFormatted 2");
  fs::resize_file(folder / "sparse", std::uintmax_t{3} << 30);
  EXPECT_THAT(message_of([&] { read_file(folder / "sparse"); }),
              HasSubstr("sparse: is 3221225472 bytes, of which only"));
}

TEST_F(AtomicFile, ReportsInvalidFileNames) {
  const fs::path long_name = folder / std::string(300, 'a'), loop = folder / "loop";
  fs::create_symlink("loop", loop);
  for (const fs::path& path : {long_name, long_name / "a", loop, loop / "a"}) {
    EXPECT_THAT(message_of([&] { read_file(path); }), HasSubstr(path.string() + ": cannot be read: "));
    EXPECT_THAT(message_of([&] { write_file(path, "1"); }), HasSubstr(path.string() + ": "));
  }
}

TEST_F(AtomicFile, ReportsUnreadableAndUnwritablePaths) {
  EXPECT_THAT(message_of([&] { read_file(folder / "none"); }), HasSubstr("none: cannot be read: No such file"));
  EXPECT_THAT(message_of([&] { read_file(folder); }), HasSubstr("is a folder"));
  EXPECT_THAT(message_of([&] { read_file("/dev/zero"); }), HasSubstr("is not a regular file"));
  EXPECT_THAT(message_of([&] { write_file(folder / "none" / "a", "1"); }),
              HasSubstr("a: cannot be written: No such file"));
  EXPECT_THAT(message_of([&] { write_file("/dev/null", "1"); }), HasSubstr("is not a regular file"));
  EXPECT_THAT(message_of([&] { write_file(folder, "1"); }), HasSubstr("is not a regular file"));
}

}  // namespace
}  // namespace aspic
