#include <gmock/gmock.h>

#include "base/error.h"
#include "recording/c3d_example_test.h"
#include "recording/formats.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string c3d_refusal(const std::string& bytes) {
  try {
    parse_c3d("walk.c3d", bytes);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

void expect_example(const Recording& recording, double scale) {
  EXPECT_THAT(recording.names, ElementsAre("A", "B"));
  ASSERT_EQ(recording.frames.size(), 2u);
  EXPECT_EQ(recording.unit, 1e-3);
  EXPECT_EQ(recording.frames[1].time, 0.02);
  EXPECT_EQ(recording.frames[1].number, 2);
  EXPECT_EQ(recording.frames[0].positions[1][0], 10 * scale);
  EXPECT_EQ(recording.frames[1].positions[0][0], 1 * scale);
  EXPECT_EQ(recording.frames[1].positions[0][2], -30 * scale);
  EXPECT_FALSE(is_seen(recording.frames[1].positions[1]));
}

TEST(C3d, ReadsFloatingPointPoints) { expect_example(parse_c3d("a.c3d", C3dExample{}.bytes()), 1); }

TEST(C3d, ScalesIntegerPoints) { expect_example(parse_c3d("a.c3d", C3dExample{.scale = 0.5F}.bytes()), 0.5); }

TEST(C3d, HidesPointsThatAreNotFinite) {
  std::string bytes = C3dExample{}.bytes();
  bytes.replace(1024, 4, "\xff\xff\xff\xff");
  EXPECT_FALSE(is_seen(parse_c3d("a.c3d", bytes).frames[0].positions[0]));
}

TEST(C3d, SkipsComputedQuantities) {
  const C3dExample file{.further = C3dExample::parameter("ANGLES", -1, "\x04\x01", "B   ")};
  const Recording recording = parse_c3d("a.c3d", file.bytes());
  EXPECT_THAT(recording.names, ElementsAre("A"));
  EXPECT_THAT(recording.notes, ElementsAre(HasSubstr("1 points are angles")));
}

TEST(C3d, NumbersRepeatedLabels) {
  EXPECT_THAT(parse_c3d("a.c3d", C3dExample{.labels = "A   A   "}.bytes()).names, ElementsAre("A", "A (2)"));
}

TEST(C3d, CountsLongRecordingsByTrialFields) {
  const C3dExample file{
      .first = 65535,
      .last = 65535,
      .further = C3dExample::parameter("ACTUAL_START_FIELD", 2, "\x02", std::string("\x01\0\x01\0", 4)) +
                 C3dExample::parameter("ACTUAL_END_FIELD", 2, "\x02", std::string("\x02\0\x01\0", 4))};
  std::string bytes = file.bytes();
  // The two parameters belong to group 2, TRIAL.
  for (const char* name : {"ACTUAL_START_FIELD", "ACTUAL_END_FIELD"}) bytes[bytes.find(name) - 1] = 2;
  const size_t end = bytes.find("ACTUAL_END_FIELD") + 16 + 2 + 2 + 1 + 4 + 1;
  const std::string group("\x05\xfeTRIAL\x03\x00\x00", 10);
  bytes.replace(end, group.size(), group);
  const Recording recording = parse_c3d("a.c3d", bytes);
  ASSERT_EQ(recording.frames.size(), 2u);
  EXPECT_EQ(recording.frames[0].number, 65537);
}

TEST(C3d, RefusesOtherFiles) {
  EXPECT_THAT(c3d_refusal("no C3D file at all"), HasSubstr("byte 1: is 111; a C3D file has 80 there"));
  EXPECT_THAT(c3d_refusal(""), HasSubstr("byte 0: the file ends before byte 1"));
  EXPECT_THAT(c3d_refusal(C3dExample{.processor = 7}.bytes()), HasSubstr("byte 515: the processor is 7; known are 84"));
}

TEST(C3d, RefusesTruncatedFile) {
  const std::string bytes = C3dExample{}.bytes();
  EXPECT_THAT(c3d_refusal(bytes.substr(0, bytes.size() - 1)), HasSubstr("ends after 1 of 2 frames; it is cut short"));
  for (size_t size = 0; size < bytes.size(); ++size) EXPECT_NE(c3d_refusal(bytes.substr(0, size)), "") << size;
}

TEST(C3d, RefusesCountsBeyondFile) {
  EXPECT_THAT(c3d_refusal(C3dExample{.points = 60000}.bytes()), HasSubstr("ends after 0 of 2 frames"));
  EXPECT_THAT(c3d_refusal(C3dExample{.last = 65535}.bytes()), HasSubstr("ends after 2 of 65535 frames"));
  EXPECT_THAT(c3d_refusal(C3dExample{.first = 9}.bytes()), HasSubstr("the last frame, 2, is before the first, 9"));
  EXPECT_THAT(c3d_refusal(C3dExample{.points = 0}.bytes()), HasSubstr("the file has no points"));
  EXPECT_THAT(c3d_refusal(C3dExample{.data_block = 1}.bytes()), HasSubstr("inside the header"));
  EXPECT_THAT(c3d_refusal(C3dExample{.further = C3dExample::parameter("X", 2, "\xff\xff\xff\xff\xff\xff", "")}.bytes()),
              HasSubstr("more values than the file has bytes"));
}

TEST(C3d, RefusesWrongEndian) {
  // Intel words that the file declares as those of a MIPS processor: 2 points become 512.
  EXPECT_THAT(c3d_refusal(C3dExample{.processor = 86}.bytes()), HasSubstr("walk.c3d: byte "));
}

}  // namespace
}  // namespace aspic
