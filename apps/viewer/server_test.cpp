#include "viewer/server.h"

#include <gmock/gmock.h>

#include <mutex>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/external_program.h"
#include "viewer/server_page_test.h"
#include "viewer/session.h"

namespace aspic::viewer {
namespace {

using namespace test;
using testing::Contains;
using testing::HasSubstr;

constexpr char kScene[] = R"(
[time]
step = 0.01
[[body]]
name = "box"
shape = { box = { upper = [0.2, 0.2, 0.2], cells = [2, 2, 2] } }
material = { young = 1e5, poisson = 0.3, density = 1000 }
)";

// A step of several hours: gradient descent on a stiff beam.
constexpr char kSlowScene[] = R"(
[time]
step = 1.0
[solver]
method = "gradient_descent"
max_iterations = 1000000000
tolerance = 0
[[body]]
name = "beam"
shape = { box = { upper = [2, 0.2, 0.2], cells = [20, 2, 2] } }
material = { young = 1e9, poisson = 0.3, density = 1000 }
[[body.pin]]
name = "clamp"
where = "x < 1e-6"
)";

class Lines {
 public:
  void add(const std::string& line) {
    const std::lock_guard lock(mutex_);
    lines_.push_back(line);
  }
  std::vector<std::string> all() const {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

class ServerTest : public testing::Test {
 protected:
  ServerTest() {
    write_file(folder_.path() / "box.toml", kScene);
    session_.emplace(folder_.path() / "box.toml", std::vector<std::string>{});
    start();
  }

  void start() {
    server_.emplace(ServerOptions{
        .page = "<p>the page</p>", .session = &*session_, .log = [this](const std::string& line) { log_.add(line); }});
  }

  std::string with_token(const std::string& path) const { return path + "?token=" + token_of(*server_); }

  TemporaryFolder folder_;
  Lines log_;
  std::optional<Session> session_;
  std::optional<Server> server_;
};

// Returns the first message to a new page.
json hello(TestPage& page) {
  const json message = page.next("hello");
  EXPECT_FALSE(message.is_null());
  return message;
}

TEST_F(ServerTest, ServesThePageWithTheToken) {
  const HttpAnswer answer = ask(*server_, {.target = with_token("/")});
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "<p>the page</p>");
  for (const std::string target : {"/", "/?token=", "/?token=0123456789abcdef0123456789abcdef"}) {
    const HttpAnswer refused = ask(*server_, {.target = target});
    EXPECT_EQ(refused.status, 403);
    EXPECT_THAT(refused.body, HasSubstr("open the whole address that aspic printed"));
  }
}

TEST_F(ServerTest, ForbidsOtherConnectionsOfThePage) {
  const http::fields fields = ask(*server_, {.target = with_token("/")}).fields;
  EXPECT_THAT(std::string(fields["Content-Security-Policy"]), HasSubstr("default-src 'none'"));
  EXPECT_EQ(fields["Referrer-Policy"], "no-referrer");
  EXPECT_EQ(fields["X-Content-Type-Options"], "nosniff");
  EXPECT_EQ(fields["Cache-Control"], "no-store");
}

TEST_F(ServerTest, OnlyTheNamedSiteMayFrameThePage) {
  const std::string site = "http://localhost:8888";
  const auto ancestors = [](const Server& server) {
    const std::string policy(ask(server, {.target = "/?token=" + token_of(server)}).fields["Content-Security-Policy"]);
    const size_t begin = policy.find("frame-ancestors ");
    return policy.substr(begin, policy.find(';', begin) - begin);
  };
  EXPECT_EQ(ancestors(*server_), "frame-ancestors 'none'");
  server_.reset();
  server_.emplace(ServerOptions{.page = "<p>the page</p>", .session = &*session_, .embed = site});
  EXPECT_EQ(ancestors(*server_), "frame-ancestors " + site);
  // The frame is a page of this server. The site around it gets nothing.
  EXPECT_EQ(ask(*server_, {.target = with_token("/"), .origin = site}).status, 403);
  EXPECT_EQ(ask(*server_, {.target = with_token("/session"), .origin = site, .upgrade = true}).status, 403);
  EXPECT_FALSE(TestPage(*server_).is_refused());
}

TEST_F(ServerTest, RefusesOtherNamesAndOtherSites) {
  const std::string port = std::to_string(server_->port());
  EXPECT_EQ(ask(*server_, {.target = with_token("/"), .host = "localhost:" + port}).status, 200);
  EXPECT_EQ(ask(*server_, {.target = with_token("/"), .host = "evil.org:" + port}).status, 403);
  EXPECT_EQ(ask(*server_, {.target = with_token("/"), .origin = "http://evil.org"}).status, 403);
}

TEST_F(ServerTest, ServesNothingElse) {
  EXPECT_EQ(ask(*server_, {.target = with_token("/etc/passwd")}).status, 404);
  EXPECT_EQ(ask(*server_, {.target = with_token("/../server.h")}).status, 404);
  EXPECT_EQ(ask(*server_, {.verb = http::verb::delete_, .target = with_token("/")}).status, 405);
  EXPECT_EQ(ask(*server_, {.verb = http::verb::post, .target = with_token("/"), .body = "x"}).status, 405);
  EXPECT_EQ(ask(*server_, {.target = with_token("/" + std::string(10'000, 'x'))}).status, 431);
}

TEST_F(ServerTest, OpensTheSessionToItsOwnPagesAlone) {
  const std::string own = "http://127.0.0.1:" + std::to_string(server_->port());
  const auto status = [&](const std::string& target, const std::string& origin) {
    return ask(*server_, {.target = target, .origin = origin, .upgrade = true}).status;
  };
  EXPECT_EQ(status(with_token("/session"), own), 101);
  EXPECT_EQ(status(with_token("/session"), "http://evil.org"), 403);
  EXPECT_EQ(status(with_token("/session"), ""), 403);
  EXPECT_EQ(status("/session", own), 403);
  EXPECT_EQ(status("/session?token=wrong", own), 403);
  EXPECT_EQ(status(with_token("/"), own), 404);
}

TEST_F(ServerTest, LetsOnlyTheFirstPageSteer) {
  TestPage first(*server_);
  EXPECT_EQ(hello(first)["steers"], true);
  TestPage second(*server_);
  EXPECT_EQ(hello(second)["steers"], false);
  second.send(R"({"do":"step","id":1})");
  EXPECT_EQ(second.next("refused")["id"], 1);
  first.send(R"({"do":"step"})");
  EXPECT_EQ(second.next("steps")["steps"].size(), 1u);
}

TEST_F(ServerTest, GivesTheRoleToARequestingPage) {
  TestPage first(*server_), second(*server_);
  hello(first);
  hello(second);
  second.send(R"({"do":"take","id":3})");
  EXPECT_EQ(first.next("role")["steers"], false);
  EXPECT_EQ(second.next("role")["steers"], true);
  EXPECT_EQ(second.next("reply")["id"], 3);
  first.send(R"({"do":"step","id":4})");
  EXPECT_EQ(first.next("refused")["id"], 4);
  second.send(R"({"do":"step"})");
  EXPECT_FALSE(first.next("steps").is_null());
}

TEST_F(ServerTest, PassesTheRoleOfAClosedPageOn) {
  std::optional<TestPage> first(*server_);
  TestPage second(*server_), third(*server_);
  hello(*first);
  hello(second);
  hello(third);
  first->drop();
  EXPECT_EQ(second.next("role")["steers"], true);
  second.drop();
  EXPECT_EQ(third.next("role")["steers"], true);
}

TEST_F(ServerTest, SendsNewPicturesToReadyPages) {
  constexpr std::chrono::milliseconds kNothingCame(150);
  TestPage page(*server_);
  EXPECT_TRUE(page.next_picture());  // the first one needs no request
  page.ready();
  EXPECT_FALSE(page.next_picture(kNothingCame));  // nothing has moved
  page.send(R"({"do":"step"})");
  EXPECT_TRUE(page.next_picture());
  page.send(R"({"do":"step"})");
  EXPECT_FALSE(page.next_picture(kNothingCame));  // the page is not ready
  page.ready();
  EXPECT_TRUE(page.next_picture());
}

TEST_F(ServerTest, ContinuesWithoutADroppedPage) {
  TestPage stays(*server_);
  hello(stays);
  stays.send(R"({"do":"play"})");
  for (int i = 0; i < 5; ++i) {
    TestPage leaving(*server_);
    hello(leaving);
    leaving.ready();
    EXPECT_FALSE(leaving.next("steps").is_null());
    leaving.drop();
  }
  EXPECT_FALSE(stays.next("steps").is_null());
  stays.ready();
  EXPECT_TRUE(stays.next_picture());
}

TEST_F(ServerTest, GreetsAPageThatReloads) {
  for (int i = 0; i < 20; ++i) {
    TestPage page(*server_);
    EXPECT_EQ(hello(page)["steers"], true) << i;
    page.drop();
    // The next page only watches until the server detects the end of the first one.
    TestPage next(*server_);
    if (!hello(next)["steers"]) {
      EXPECT_EQ(next.next("role")["steers"], true);
    }
    next.drop();
    while (ask(*server_, {.target = with_token("/")}).status != 200) {
    }
    server_.reset();
    start();
  }
}

TEST_F(ServerTest, RefusesMalformedMessagesAndLogsThem) {
  TestPage page(*server_);
  hello(page);
  for (const std::string text : {"{", "", "7", "[]", R"({"do":7})", "\"ready\"", R"({"do":"fly"})"}) {
    page.send(text);
    EXPECT_FALSE(page.next("refused").is_null()) << text;
  }
  EXPECT_THAT(log_.all(), Contains(HasSubstr("does not follow the viewer's protocol")));
  page.send(R"({"do":"step"})");
  EXPECT_FALSE(page.next("steps").is_null());
}

TEST_F(ServerTest, LimitsTheLogOfRefusedMessages) {
  TestPage page(*server_);
  hello(page);
  for (int i = 0; i < 500; ++i) page.send("{");
  for (int i = 0; i < 500; ++i) ASSERT_FALSE(page.next("refused").is_null());
  EXPECT_LT(log_.all().size(), 100u);
}

TEST_F(ServerTest, RefusesLongMessagesAndClosesOnLongerOnes) {
  TestPage page(*server_);
  hello(page);
  page.send(R"({"do":"load","id":5,"scene":")" + std::string(2 << 20, 'x') + R"("})");
  EXPECT_EQ(page.next("refused")["id"], 5);
  page.send(std::string(17 << 20, ' '));
  EXPECT_TRUE(page.next("refused").is_null());
  EXPECT_TRUE(page.has_ended());
  TestPage another(*server_);
  hello(another);
}

TEST_F(ServerTest, ClosesOnBinaryWithAReason) {
  TestPage page(*server_);
  hello(page);
  page.send_binary("\x01\x02");
  EXPECT_TRUE(page.next("refused").is_null());
  EXPECT_EQ(page.reason(), "only text is understood here");
}

TEST_F(ServerTest, DoesNotWaitForUnreadMessages) {
  constexpr size_t kMoreThanSocketsHold = size_t{16} << 20;
  TestPage slow(*server_), quick(*server_);
  hello(quick);
  quick.send(R"({"do":"take"})");
  quick.send(R"({"do":"speed","value":1000})");
  quick.send(R"({"do":"play"})");
  for (size_t received = 0; received < kMoreThanSocketsHold;) {
    const auto frame = quick.read();
    ASSERT_TRUE(frame);
    received += frame->size();
  }
}

TEST_F(ServerTest, InterruptsASlowStepForUrgentCommands) {
  write_file(folder_.path() / "slow.toml", kSlowScene);
  TestPage page(*server_);
  hello(page);
  page.send(json{{"do", "load"}, {"scene", (folder_.path() / "slow.toml").string()}, {"id", 1}}.dump());
  ASSERT_EQ(page.next("reply")["id"], 1);
  page.send(R"({"do":"step"})");
  page.send(R"({"do":"pause","id":2})");
  EXPECT_EQ(page.next("reply")["id"], 2);
  page.send(R"({"do":"step"})");
  EXPECT_TRUE(server_->stop(kTooLong));
}

TEST_F(ServerTest, SurvivesInvalidHttp) {
  for (const std::string& garbage : {std::string("\0\1\2\r\n\r\n", 7), std::string("GET\r\n\r\n"),
                                     std::string(20'000, 'a'), std::string("\x16\x03\x01\x02\x00\x01", 6)}) {
    asio::io_context network;
    tcp::socket socket(network);
    socket.connect(endpoint_of(*server_));
    error_code ignored;
    asio::write(socket, asio::buffer(garbage), ignored);
    socket.shutdown(tcp::socket::shutdown_send, ignored);
    std::string answer;
    asio::read(socket, asio::dynamic_buffer(answer), ignored);  // until the server closes
  }
  EXPECT_EQ(ask(*server_, {.target = with_token("/")}).status, 200);
}

TEST_F(ServerTest, BoundsConnectionsAndPages) {
  {
    asio::io_context network;
    std::vector<tcp::socket> idle;
    for (int i = 0; i < 200; ++i) idle.emplace_back(network).connect(endpoint_of(*server_));
    TestPage page(*server_);
    EXPECT_FALSE(page.is_refused());  // the server closes an idle connection instead
    EXPECT_EQ(ask(*server_, {.target = with_token("/")}).status, 200);
  }
  std::vector<std::unique_ptr<TestPage>> pages;
  while (pages.size() < 16) {
    auto page = std::make_unique<TestPage>(*server_);
    if (page->is_refused()) continue;  // the idle connections are not closed yet
    hello(*page);
    pages.push_back(std::move(page));
  }
  EXPECT_TRUE(TestPage(*server_).is_refused());
  pages.back()->drop();
  while (TestPage(*server_).is_refused()) {
  }
}

TEST_F(ServerTest, ServesABrowserBesideSlowConnections) {
  asio::io_context network;
  std::vector<tcp::socket> slow;
  for (int i = 0; i < 64; ++i) {
    slow.emplace_back(network).connect(endpoint_of(*server_));
    asio::write(slow.back(), asio::buffer(std::string("GET / HTTP/1.1\r\nHost: ")));
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(ask(*server_, {.target = with_token("/")}).status, 200);
    TestPage page(*server_);
    EXPECT_FALSE(page.is_refused());
    hello(page);
  }
}

TEST_F(ServerTest, SendsAReasonAtItsEnd) {
  TestPage page(*server_);
  hello(page);
  page.send(R"({"do":"play"})");
  EXPECT_FALSE(page.next("steps").is_null());
  EXPECT_TRUE(server_->stop(std::chrono::seconds(20)));
  while (page.read()) {
  }
  EXPECT_EQ(page.reason(), "aspic has ended");
}

TEST_F(ServerTest, ReportsAPortInUse) {
  EXPECT_THAT([&] { Server({.port = server_->port(), .page = ""}); },
              testing::ThrowsMessage<InvalidInput>(HasSubstr("leave --port out")));
}

TEST(ServerWithoutSession, ServesThePageAndItsUploads) {
  std::vector<std::string> received;
  Server server({.page = "recorded", .post = [&](const std::string& path, std::string_view body) -> std::string {
                   if (path != "/frame") throw InvalidInput(path + ": nothing is expected there");
                   received.emplace_back(body);
                   return std::to_string(received.size());
                 }});
  const std::string token = "?token=" + token_of(server);
  EXPECT_EQ(ask(server, {.target = "/" + token}).body, "recorded");
  EXPECT_TRUE(TestPage(server).is_refused());
  const std::string frame(5 << 20, '\xfe');
  EXPECT_EQ(ask(server, {.verb = http::verb::post, .target = "/frame" + token, .body = frame}).body, "1");
  EXPECT_EQ(ask(server, {.verb = http::verb::post, .target = "/frame" + token, .body = "b"}).body, "2");
  const HttpAnswer wrong = ask(server, {.verb = http::verb::post, .target = "/x" + token});
  EXPECT_EQ(wrong.status, 400);
  EXPECT_EQ(wrong.body, "/x: nothing is expected there");
  EXPECT_NE(ask(server, {.verb = http::verb::post, .target = "/frame", .body = "no token"}).status, 200);
  EXPECT_NE(
      ask(server, {.verb = http::verb::post, .target = "/frame" + token, .body = std::string(65 << 20, 'x')}).status,
      200);
  EXPECT_EQ(received.size(), 2u);
  EXPECT_EQ(received[0], frame);
}

}  // namespace
}  // namespace aspic::viewer
