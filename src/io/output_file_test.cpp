#include "io/output_file.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using GrowingFile = FolderTest;

TEST_F(GrowingFile, AppendsOverwritesAndShortens) {
  OutputFile file = OutputFile::create(path("a"));
  file.append("hello ");
  file.append("world");
  file.write_at(0, "J");
  file.sync();
  EXPECT_EQ(file.size(), 11u);
  EXPECT_EQ(read_file(path("a")), "Jello world");
  file.truncate(5);
  file.append("!");
  file.close();
  EXPECT_EQ(read_file(path("a")), "Jello!");
}

TEST_F(GrowingFile, ContinuesExistingFile) {
  put(path("a"), "one\n");
  OutputFile file = OutputFile::open_existing(path("a"));
  file.append("two\n");
  EXPECT_EQ(read_file(path("a")), "one\ntwo\n");
}

TEST_F(GrowingFile, ReportsFailedFileAndReason) {
  const auto message = [](auto call) { return message_of<InvalidInput>(call); };
  EXPECT_THAT(message([&] { OutputFile::open_existing(path("missing")); }), HasSubstr("missing: cannot be opened"));
  EXPECT_THAT(message([&] { OutputFile::create(path("no/folder")); }), HasSubstr("No such file or directory"));
  EXPECT_THAT(message([&] { OutputFile::open_existing("/dev/full").append("x"); }),
              HasSubstr("/dev/full: cannot be written: No space left on device"));
}

}  // namespace
}  // namespace aspic
