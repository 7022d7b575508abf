#include <gmock/gmock.h>

#include "base/error.h"
#include "recording/formats.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kHead =
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
    "50\t50\t2\t2\tmm\t50\t1\t2\n"
    "Frame#\tTime\tA\t\t\tB\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n";

std::string trc_refusal(const std::string& text) {
  try {
    parse_trc("walk.trc", text);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Trc, ReadsFramesNamesAndUnit) {
  const Recording recording = parse_trc("walk.trc", kHead + "1\t0.00\t1\t2\t3\t4\t5\t6\n2\t0.02\t1.5\t2\t3\t4\t5\t6\n");
  EXPECT_THAT(recording.names, ElementsAre("A", "B"));
  ASSERT_EQ(recording.frames.size(), 2u);
  EXPECT_EQ(recording.unit, 1e-3);
  EXPECT_EQ(recording.frames[1].number, 2);
  EXPECT_EQ(recording.frames[1].time, 0.02);
  EXPECT_EQ(recording.frames[1].where, "walk.trc:8");
  EXPECT_EQ(recording.frames[1].positions[0][0], 1.5);
  EXPECT_TRUE(recording.notes.empty());
}

TEST(Trc, BlankNanAndOriginAreNotSeen) {
  const Recording recording = parse_trc(
      "walk.trc", kHead + "1\t0\t\t\t\t4\t5\t6\r\n2\t0.02\tNaN\tNaN\tNaN\t0.000\t0.0\t0\r\n3\t0.04\t1\t2\t3\r\n");
  EXPECT_FALSE(is_seen(recording.frames[0].positions[0]));
  EXPECT_TRUE(is_seen(recording.frames[0].positions[1]));
  EXPECT_FALSE(is_seen(recording.frames[1].positions[0]));
  EXPECT_FALSE(is_seen(recording.frames[1].positions[1]));
  EXPECT_FALSE(is_seen(recording.frames[2].positions[1]));  // trailing blank cells are often missing
  EXPECT_THAT(recording.notes,
              ElementsAre(HasSubstr("NumFrames is 2, but the file has 3"), HasSubstr("exactly 0 0 0")));
}

TEST(Trc, ReadsBlanksInsteadOfTabs) {
  const std::string text =
      "PathFileType 4 (X/Y/Z) a.trc\nDataRate CameraRate NumFrames NumMarkers Units\n50 50 1 1 m\nFrame# Time A\n"
      "X1 Y1 Z1\n1 0.0 1 2 3\n";
  EXPECT_EQ(parse_trc("a.trc", text).frames[0].positions[0][2], 3);
}

TEST(Trc, RefusesDamage) {
  EXPECT_THAT(trc_refusal("time,marker\n"), HasSubstr("walk.trc:1: does not begin with 'PathFileType'"));
  EXPECT_THAT(trc_refusal(""), HasSubstr("does not begin with 'PathFileType'"));
  EXPECT_THAT(trc_refusal(kHead.substr(0, 60)), HasSubstr("get a complete copy"));
  EXPECT_THAT(trc_refusal(kHead), HasSubstr("has no frames"));
  EXPECT_THAT(trc_refusal(kHead + "1\t0\t1\t2\t3\t4\t5"),
              HasSubstr("walk.trc:7: has 7 cells; a frame of 2 markers has 8"));
  EXPECT_THAT(trc_refusal(kHead + "1\t0\t1\t2\t3\t4\t5\t6\t7\n"), HasSubstr("'7' follows the last marker"));
  EXPECT_THAT(trc_refusal(kHead + "1\t0\t1\t2\tx\t4\t5\t6\n"), HasSubstr("walk.trc:7: 'x' is not a number"));
  EXPECT_THAT(trc_refusal(kHead + "1\t\t1\t2\t3\t4\t5\t6\n"), HasSubstr("Time is blank"));
  EXPECT_THAT(trc_refusal(kHead + "1\t0\t1\t2\t3\t4\t5\t6\n2\t0\t1\t2\t3\t4\t5\t6\n"),
              HasSubstr("walk.trc:8: time = 0 s follows 0 s"));
}

TEST(Trc, RefusesMoreMarkersThanNamed) {
  std::string text = kHead;
  text.replace(text.find("50\t50\t2\t2"), 9, "50\t50\t2\t2000000000");
  EXPECT_THAT(trc_refusal(text), HasSubstr("walk.trc:4: names 2 markers, but NumMarkers is 2000000000"));
}

TEST(Trc, RefusesRowsFarShorterThanTheirMarkers) {
  std::string names, rows;
  for (int i = 0; i < 3000; ++i) names += "m" + std::to_string(i) + "\t\t\t";
  for (int i = 1; i < 3000; ++i) rows += std::to_string(i) + "\t" + std::to_string(i) + "\n";
  std::string text = kHead.substr(0, kHead.find("Frame#"));
  text.replace(text.find("50\t50\t2\t2"), 9, "50\t50\t2\t3000");
  EXPECT_THAT(trc_refusal(text + "Frame#\tTime\t" + names + "\n" + rows), HasSubstr("most points would never be seen"));
}

}  // namespace
}  // namespace aspic
