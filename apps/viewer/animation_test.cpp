// Animations that a session sends to its page.
#include <gmock/gmock.h>

#include "io/base64.h"
#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string exported(Page& page, const std::string& format, const Json& camera = {}) {
  Json question = {{"ask", "animation"}, {"side", "a"}, {"format", format}};
  if (!camera.is_null()) question["camera"] = camera;
  const std::string text = page.send(question)["base64"];
  std::string_view rest = text;
  std::string bytes;
  EXPECT_TRUE(decode_base64(rest, text.size(), bytes));
  return bytes;
}

TEST(AnimationOfASession, HasAFrameForEachStep) {
  Page page(kBeam, {"time.step=0.02"});
  page.grab_end({1, 0.4, 0.1});
  page.steps(4);
  const std::string usd = exported(page, "usd");
  EXPECT_THAT(usd, StartsWith("#usda 1.0"));
  EXPECT_THAT(usd, HasSubstr("timeCodesPerSecond = 50"));
  EXPECT_THAT(usd, HasSubstr("endTimeCode = 4"));
  EXPECT_THAT(exported(page, "pc2"), StartsWith("PK"));
  EXPECT_THAT(exported(page, "glb"), StartsWith("glTF"));
}

TEST(AnimationOfASession, EndsAtTheCurrentPositions) {
  Page page(kBeam, {"time.step=0.02"});
  page.steps(2);
  const std::string bytes = exported(page, "glb");
  const size_t length = take<uint32_t>(bytes, 12);
  const Json json = Json::parse(bytes.substr(20, length));
  const Json& targets = json["meshes"][0]["primitives"][0]["targets"];
  ASSERT_EQ(targets.size(), 2u);
  const auto floats = [&](const Json& accessor) {
    const Json& a = json["accessors"][accessor.get<size_t>()];
    const Json& view = json["bufferViews"][a["bufferView"].get<size_t>()];
    return take<float>(bytes, 28 + length + view["byteOffset"].get<size_t>(), view["byteLength"].get<size_t>() / 4);
  };
  const auto first = floats(json["meshes"][0]["primitives"][0]["attributes"]["POSITION"]);
  const auto last = floats(targets[1]["POSITION"]);
  const Picture picture = page.picture();
  ASSERT_EQ(first.size(), picture.positions.size());
  for (size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(first[i] + last[i], picture.positions[i], 1e-6F);
  const auto times = floats(json["animations"][0]["samplers"][0]["input"]);
  EXPECT_THAT(times, testing::ElementsAre(testing::FloatEq(0), testing::FloatEq(0.02F), testing::FloatEq(0.04F)));
}

TEST(AnimationOfASession, ContainsTheCamera) {
  Page page(kBeam, {"time.step=0.02"});
  page.steps(1);
  Json camera = {{"eye", {0, 0, 5}}, {"right", {1, 0, 0}}, {"up", {0, 1, 0}}, {"slope", 0.5}, {"nearest", 0.01}};
  const std::string usd = exported(page, "usd", camera);
  EXPECT_THAT(usd, HasSubstr("xformOp:transform = ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 5, 1))"));
  EXPECT_THAT(usd, HasSubstr("verticalAperture = 50\n"));
  EXPECT_THAT(exported(page, "glb", camera),
              HasSubstr(R"({"camera":0,"name":"view","matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]})"));
  camera["up"] = {0, 2, 0};
  EXPECT_THAT(page.refused({{"ask", "animation"}, {"side", "a"}, {"format", "usd"}, {"camera", camera}}),
              HasSubstr("orthonormal right and up"));
}

TEST(AnimationOfASession, NeedsMotion) {
  Page page;
  EXPECT_THAT(page.refused({{"ask", "animation"}, {"side", "a"}, {"format", "usd"}}), HasSubstr("play first"));
  page.steps(1);
  EXPECT_THAT(page.refused({{"ask", "animation"}, {"side", "a"}, {"format", "avi"}}), HasSubstr("'glb'"));
}

}  // namespace
}  // namespace aspic::viewer
