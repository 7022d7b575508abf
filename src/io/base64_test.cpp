#include "io/base64.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

std::string encoded(std::string_view bytes) {
  std::string text;
  append_base64(bytes, text);
  return text;
}

TEST(Base64, MatchesVectorsOfRfc4648) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Base64, DecodesItsOwnEncoding) {
  std::string bytes;
  for (int i = 0; i < 300; ++i) bytes += static_cast<char>(i * 37);
  const std::string text = encoded(bytes);
  std::string_view rest = text;
  std::string decoded;
  EXPECT_TRUE(decode_base64(rest, bytes.size(), decoded));
  EXPECT_EQ(decoded, bytes);
  EXPECT_TRUE(rest.empty());
}

TEST(Base64, ContinuesAfterPadding) {
  const std::string text = encoded("head") + " \n" + encoded("data");
  std::string_view rest = text;
  std::string decoded;
  EXPECT_TRUE(decode_base64(rest, 4, decoded));
  EXPECT_EQ(decoded, "head");
  EXPECT_TRUE(decode_base64(rest, 4, decoded));
  EXPECT_EQ(decoded, "headdata");
}

TEST(Base64, RejectsInvalidCharactersAndIncompleteGroups) {
  for (std::string_view text : {"Zm9*", "Zg=v", "====", "Zm9", "Z\x80\xff\x01"}) {
    std::string decoded;
    EXPECT_FALSE(decode_base64(text, 3, decoded)) << text;
  }
}

}  // namespace
}  // namespace aspic
