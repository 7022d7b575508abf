#include "io/checkpoint.h"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using CheckpointFile = FolderTest;

Checkpoint sample(int64_t step) {
  return {"scene",
          {{"q", {0.1, -0.0, 1e-310}}, {"empty", {}}},
          {{"step", step}, {"least", std::numeric_limits<int64_t>::min()}}};
}

std::string message(const std::filesystem::path& path) {
  return message_of<InvalidInput>([&] { read_checkpoint(path); });
}

TEST_F(CheckpointFile, ReadsBackToTheSameBits) {
  write_checkpoint(path("c.bin"), sample(7));
  const Checkpoint read = read_checkpoint(path("c.bin"));
  EXPECT_EQ(read.fingerprint, "scene");
  EXPECT_EQ(read.integer("step"), 7);
  EXPECT_EQ(read.integer("least"), std::numeric_limits<int64_t>::min());
  ASSERT_EQ(read.array("q").size(), 3u);
  EXPECT_EQ(std::memcmp(read.array("q").data(), sample(7).arrays[0].second.data(), 24), 0);
  EXPECT_TRUE(read.array("empty").empty());
  EXPECT_THROW(read.array("p"), InvalidInput);
  EXPECT_THROW(read.integer("p"), InvalidInput);
}

TEST_F(CheckpointFile, EveryChangedBitIsDetected) {
  write_checkpoint(path("c.bin"), sample(1));
  const std::string whole = read_file(path("c.bin"));
  for (size_t n = 0; n < whole.size(); ++n) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = whole;
      changed[n] = static_cast<char>(changed[n] ^ (1 << bit));
      put(path("c.bin"), changed);
      ASSERT_NE(message(path("c.bin")), "") << "byte " << n << ", bit " << bit;
    }
  }
}

TEST_F(CheckpointFile, EveryTruncationAndExtensionIsDetected) {
  write_checkpoint(path("c.bin"), sample(1));
  const std::string whole = read_file(path("c.bin"));
  for (size_t n = 0; n < whole.size(); ++n) {
    put(path("c.bin"), whole.substr(0, n));
    ASSERT_NE(message(path("c.bin")), "") << n;
  }
  put(path("c.bin"), whole + "x");
  EXPECT_THAT(message(path("c.bin")), HasSubstr("is cut short or damaged"));
}

TEST_F(CheckpointFile, NamesAnotherVersionOrByteOrder) {
  write_checkpoint(path("c.bin"), sample(1));
  std::string whole = read_file(path("c.bin"));
  whole[12] = 9;
  put(path("c.bin"), whole);
  EXPECT_THAT(message(path("c.bin")), HasSubstr("is a checkpoint of version 9; this program reads version 1"));
  std::swap(whole[8], whole[11]);
  put(path("c.bin"), whole);
  EXPECT_THAT(message(path("c.bin")), HasSubstr("another byte order"));
  put(path("c.bin"), "step,time\n");
  EXPECT_THAT(message(path("c.bin")), HasSubstr("c.bin: is not a checkpoint"));
}

TEST_F(CheckpointFile, DamagedNewestFallsBackToPreviousWithNote) {
  write_checkpoint(path("c.bin"), sample(1));
  write_checkpoint(path("c.bin"), sample(2));
  NewestCheckpoint newest = read_newest_checkpoint(path("c.bin"));
  EXPECT_EQ(newest.checkpoint.integer("step"), 2);
  EXPECT_EQ(newest.note, "");

  std::string bytes = read_file(path("c.bin"));
  bytes[40] ^= 1;
  put(path("c.bin"), bytes);
  newest = read_newest_checkpoint(path("c.bin"));
  EXPECT_EQ(newest.checkpoint.integer("step"), 1);
  EXPECT_THAT(newest.note, HasSubstr("c.bin: is damaged"));
  EXPECT_THAT(newest.note, HasSubstr("continuing from c.previous.bin"));

  put(path("c.previous.bin"), "");
  EXPECT_THAT(message_of<InvalidInput>([&] { read_newest_checkpoint(path("c.bin")); }),
              HasSubstr("no readable checkpoint"));
}

// A program that is killed after storing the first of two checkpoints leaves both names on one file.
TEST_F(CheckpointFile, LeavesNothingBesideTheTwo) {
  write_checkpoint(path("c.bin"), sample(1));
  std::filesystem::create_hard_link(path("c.bin"), path("c.previous.bin"));
  write_checkpoint(path("c.bin"), sample(2));
  EXPECT_FALSE(std::filesystem::exists(path("c.previous.bin.new")));
  EXPECT_EQ(read_newest_checkpoint(path("c.bin")).checkpoint.integer("step"), 2);
}

TEST_F(CheckpointFile, FingerprintsAreThoseOfFnv1a) {
  EXPECT_EQ(fingerprint(""), "cbf29ce484222325");  // the reference values of FNV-1a, 64 bits
  EXPECT_EQ(fingerprint("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(fingerprint("foobar"), "85944171f73967e8");
}

}  // namespace
}  // namespace aspic
