#include "viewer/server_access.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "viewer/server.h"

namespace aspic::viewer {
namespace {

TEST(Access, CreatesANew128BitTokenEachTime) {
  const Access a(80), b(80);
  EXPECT_EQ(a.token().size(), 32u);
  EXPECT_EQ(a.token().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(a.token(), b.token());
}

TEST(Access, RequiresTheWholeToken) {
  const Access access(80);
  EXPECT_TRUE(access.is_token(access.token()));
  EXPECT_FALSE(access.is_token(""));
  EXPECT_FALSE(access.is_token(access.token().substr(1)));
  EXPECT_FALSE(access.is_token(access.token() + "0"));
  std::string wrong = access.token();
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  EXPECT_FALSE(access.is_token(wrong));
}

TEST(Access, AcceptsOnlyNamesOfThisMachine) {
  const Access access(8080);
  EXPECT_TRUE(access.is_host("127.0.0.1:8080"));
  EXPECT_TRUE(access.is_host("localhost:8080"));
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:80", "localhost.evil.org:8080", "evil.org:8080", "[::1]:8080"})
    EXPECT_FALSE(access.is_host(host)) << host;
}

TEST(Access, AcceptsItsOwnPages) {
  const Access access(8080);
  EXPECT_TRUE(access.is_origin("http://127.0.0.1:8080"));
  EXPECT_TRUE(access.is_origin("http://localhost:8080"));
  for (const char* origin : {"", "null", "https://127.0.0.1:8080", "http://127.0.0.1:8081", "http://evil.org:8080"})
    EXPECT_FALSE(access.is_origin(origin)) << origin;
}

TEST(Site, IsSchemeHostAndPort) {
  for (const char* site : {"http://localhost:8888", "https://hub.example.org", "http://127.0.0.1:80"})
    EXPECT_TRUE(is_site(site)) << site;
  for (const char* text :
       {"", "*", "'self'", "localhost:8888", "http://", "http://*", "http://a:", "http://a:x", "http://a/",
        "http://a b", "http://a;script-src *", "http://a\r\nX: y", "ftp://a", "http://u@a"})
    EXPECT_FALSE(is_site(text)) << text;
}

TEST(Target, SplitsPathAndToken) {
  EXPECT_EQ(parse_target("/").path, "/");
  EXPECT_EQ(parse_target("/").token, "");
  EXPECT_EQ(parse_target("/session?token=ab").path, "/session");
  EXPECT_EQ(parse_target("/session?token=ab").token, "ab");
  EXPECT_EQ(parse_target("/?x=1&token=ab&y=2").token, "ab");
  EXPECT_EQ(parse_target("/?mytoken=ab&&").token, "");
  EXPECT_EQ(parse_target("").path, "");
}

TEST(Access, RefusesToBeFramedByAnythingElse) {
  for (const std::string text : {"*", "localhost:8888", "http://localhost:8888/tree", "http://a; script-src *"})
    EXPECT_THROW(Server({.page = "", .embed = text}), InvalidInput) << text;
}

}  // namespace
}  // namespace aspic::viewer
