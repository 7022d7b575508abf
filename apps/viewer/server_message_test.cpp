#include "viewer/server_message.h"

#include <gtest/gtest.h>

namespace aspic::viewer {
namespace {

TEST(MessageHead, HasTheCommandOfAMessage) {
  const MessageHead play = parse_head(R"({"do":"play","id":7})");
  EXPECT_TRUE(play.is_message);
  EXPECT_EQ(play.does, "play");
  EXPECT_EQ(play.id, "7");
  const MessageHead question = parse_head(R"({"ask":"worst","side":"a","id":1})");
  EXPECT_TRUE(question.is_message);
  EXPECT_EQ(question.does, "");
}

TEST(MessageHead, ReadsOnlyTheOutermostObject) {
  EXPECT_EQ(parse_head(R"({"recording":{"do":"pause","id":9},"do":"replay"})").does, "replay");
  EXPECT_EQ(parse_head(R"({"recording":{"do":"pause","id":9},"do":"replay"})").id, "null");
}

TEST(MessageHead, OfAnInvalidMessageIsEmpty) {
  for (const char* text : {"", "{", "7", "null", "[]", R"(["do"])", R"({"do":7})", R"({"do":""})", "{\"do\":\"\xff\"}"})
    EXPECT_FALSE(parse_head(text).is_message) << text;
  EXPECT_EQ(parse_head(R"({"do":"play","id":"7"})").id, "null");
  EXPECT_FALSE(parse_head(std::string(1000000, '[')).is_message);
}

}  // namespace
}  // namespace aspic::viewer
