// Invalid and random messages: no exception, no hang, no unrequested change.
#include <atomic>
#include <random>
#include <thread>

#include "viewer/session_test.h"

namespace aspic::viewer {
namespace {

std::string why(const Answer& answer) {
  EXPECT_EQ(answer.to_sender.size(), 1u);
  const Json json = Json::parse(answer.to_sender.at(0).bytes);
  EXPECT_EQ(json["kind"], "refused");
  return json.value("why", "");
}

TEST(Refusals, AnswerInvalidMessages) {
  Page page;
  const std::string deep(100'000, '[');
  std::string blank;
  blank.resize(40'000'000, ' ');
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("null"), std::string("3"), std::string("[]"), std::string("{}"),
        std::string("{\"do\": 3}"), std::string("{\"do\": \"\"}"), std::string("{\"id\": {}, \"do\": \"play\"}"),
        std::string("{\"do\": \"play\", \"x\": 1}"), std::string("{\"do\": \"speed\", \"value\": 1e999}"),
        std::string("{\"do\": \"speed\", \"value\": NaN}"), std::string("{\"ask\": \"worst\", \"side\": \"a\"}"),
        std::string("{\"do\": \"\xff\xfe\"}"), std::string("\0\0", 2), deep, "{\"do\": " + deep, blank})
    EXPECT_FALSE(why(page.session().handle(text, Role::steers)).empty());
  EXPECT_FALSE(page.session().is_playing());
}

TEST(Refusals, NameTheNearestKnownCommand) {
  Page page;
  EXPECT_NE(page.refused({{"do", "pley"}}).find("did you mean 'play'"), std::string::npos);
  EXPECT_NE(page.refused({{"ask", "worts"}, {"side", "a"}}).find("did you mean 'worst'"), std::string::npos);
}

TEST(Refusals, LimitWatchingPagesToQuestions) {
  Page page;
  EXPECT_NE(why(page.session().handle(R"({"do": "play"})", Role::watches)).find("only watches"), std::string::npos);
  EXPECT_FALSE(page.session().is_playing());
  const Answer answer = page.session().handle(R"({"id": 1, "ask": "worst", "side": "a"})", Role::watches);
  EXPECT_EQ(Json::parse(answer.to_sender.at(0).bytes)["kind"], "reply");
  EXPECT_EQ(page.session().handle(R"({"do": "take"})", Role::watches).to_sender.size(), 0u);
}

TEST(Refusals, OfInvalidScenesKeepTheCurrentScene) {
  Page page;
  page.steps(2);
  for (const char* path : {"", "/nowhere/at_all.toml", "/dev/zero", "/tmp", "/etc/hostname"})
    EXPECT_FALSE(page.refused({{"do", "load"}, {"scene", path}}).empty());
  page.refused({{"do", "load"}, {"scene", Page::scene_file("[[body]]\nmesh = \"../../../../etc/passwd\"\n")}});
  page.refused({{"do", "load"}, {"scene", Page::scene_file(kBeam)}, {"overrides", {"nonsense"}}});
  page.refused({{"do", "load"}, {"scene", Page::scene_file(kBeam)}, {"overrides", {1}}});
  EXPECT_EQ(page.side()["step"], 2);
  page.steps(1);
}

TEST(Session, LoadsAnotherScene) {
  Page page;
  page.steps(2);
  const int generation = page.scene()["generation"];
  page.send({{"do", "load"}, {"scene", Page::scene_file(kBeam)}, {"overrides", {"body.beam.shape.box.cells=[3,1,1]"}}});
  EXPECT_EQ(page.side()["step"], 0);
  EXPECT_TRUE(page.rows().empty());
  EXPECT_NE(page.scene()["generation"], generation);
  EXPECT_EQ(page.geometry().generation, page.scene()["generation"]);
  EXPECT_EQ(page.scene()["tets"], 18);
}

TEST(Session, AnExplicitSchemeThatBlowsUpStopsPlaying) {
  Page page(kBeam, {"time.integrator=symplectic_euler", "time.step=0.02"});
  page.send({{"do", "play"}});
  page.play_until_it_stops(100'000);
  EXPECT_FALSE(page.session().is_playing());
  EXPECT_EQ(page.side()["status"], "undefined");
  EXPECT_FALSE(page.side()["words"].is_null());
  page.send({{"do", "reset"}});
  page.send({{"do", "set"}, {"key", "time.step"}, {"value", 1e-4}});
  page.steps(3);
  EXPECT_TRUE(page.rows().back()["converged"].get<bool>());
}

TEST(Session, IgnoresAnInterruptionBetweenSteps) {
  Page page;
  page.send({{"do", "play"}});
  page.session().interrupt();
  page.advance();
  EXPECT_EQ(page.side()["step"], 1);
}

TEST(Session, DropsAnInterruptedStep) {
  // Each step would need a billion iterations.
  Page page(kBeam, {"solver.method=gradient_descent", "solver.max_iterations=1000000000", "solver.tolerance=0",
                    "material.young=1e7"});
  const Picture before = page.picture();
  page.send({{"do", "play"}});
  std::atomic<bool> has_begun = false, is_done = false;
  std::thread other([&] {
    for (has_begun = true; !is_done;) page.session().interrupt();
  });
  while (!has_begun) std::this_thread::yield();
  page.advance();
  is_done = true;
  other.join();
  EXPECT_EQ(page.side()["step"], 0);
  EXPECT_EQ(page.picture().positions, before.positions);
  EXPECT_TRUE(page.session().is_playing());
}

TEST(Session, OpensLessons) {
  const std::string scene = Page::scene_file(kBeam);
  Lesson lesson{.id = "33", .pages = "33", .title = "Mouse", .claim = "c", .exercise = "l", .scene = scene};
  lesson.overrides = {"time.step=0.02"};
  lesson.comparison = {{{"time.step=0.01"}, "h/2"}};
  lesson.function = R"({"name": "two_bump", "start": [0, 0], "settings": {}, "iteration": 0, "samples": 11})";
  Lesson missing{.id = "99", .title = "Contact", .missing = "contact is not simulated"};
  Page page(kBeam, {}, {.lessons = {lesson, missing}});
  page.send({{"do", "lesson"}, {"lesson", "33"}});
  EXPECT_EQ(page.scene("a")["h"], 0.02);
  EXPECT_EQ(page.scene("b")["h"], 0.01);
  EXPECT_EQ(page.refused({{"do", "lesson"}, {"lesson", "99"}}), "contact is not simulated");
  page.refused({{"do", "lesson"}, {"lesson", "1"}});
}

// ---------------------------------------------------------------- at random

const std::vector<Json>& valid_messages() {
  static const std::vector<Json> list = {
      {{"do", "play"}},
      {{"do", "pause"}},
      {{"do", "step"}},
      {{"do", "iterate"}},
      {{"do", "reset"}},
      {{"do", "rewind"}, {"step", 1}},
      {{"do", "speed"}, {"value", 2}},
      {{"do", "set"}, {"key", "material.young"}, {"value", 2e5}, {"side", "a"}},
      {{"do", "set"}, {"key", "solver.method"}, {"value", "lbfgs"}},
      {{"do", "set"}, {"key", "gravity"}, {"value", {0, 0, -9.81}}},
      {{"do", "grab"}, {"side", "a"}, {"triangle", 3}, {"weights", {0.2, 0.3, 0.5}}, {"target", {1, 1, 0}}},
      {{"do", "move"}, {"target", {0.5, 0.5, 0}}},
      {{"do", "release"}},
      {{"do", "stiffness"}, {"value", 100}},
      {{"do", "pin"}, {"side", "a"}, {"vertices", {1, 2, 3}}, {"pinned", true}},
      {{"do", "pin"}, {"side", "a"}, {"vertices", {1, 2, 3}}, {"pinned", false}},
      {{"do", "compare"}, {"overrides", {"time.step=0.005"}}, {"label", "b"}},
      {{"do", "end_compare"}},
      {{"do", "color"}, {"field", "von_mises"}},
      {{"do", "surface"}, {"which", "cage"}},
      {{"do", "replay"},
       {"recording",
        {{"scene", "x"}, {"overrides", Json::array()}, {"compare", nullptr}, {"events", Json::array()}, {"steps", 2}}}},
      {{"ask", "vertex"}, {"side", "a"}, {"vertex", 1}, {"id", 1}},
      {{"ask", "tet"}, {"side", "a"}, {"triangle", 1}, {"id", 2}},
      {{"ask", "iteration"}, {"side", "a"}, {"step", 1}, {"iteration", 0}, {"id", 3}},
      {{"ask", "worst"}, {"side", "a"}, {"id", 4}},
      {{"ask", "function"},
       {"name", "x^2 + y^2"},
       {"start", {1, 1}},
       {"settings", {{"method", "newton"}}},
       {"iteration", 0},
       {"samples", 5},
       {"id", 5}},
      {{"ask", "mesh"}, {"side", "a"}, {"format", "obj"}, {"id", 6}},
      {{"ask", "scene"}, {"side", "a"}, {"id", 7}},
      {{"ask", "recording"}, {"id", 8}}};
  return list;
}

class Mutations {
 public:
  explicit Mutations(unsigned seed) : random_(seed) {}

  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  Json odd_value() {
    const std::vector<Json> odd = {nullptr,
                                   true,
                                   -1,
                                   0,
                                   1,
                                   1e300,
                                   -1e-300,
                                   4294967296,
                                   2147483648,
                                   "",
                                   "b",
                                   "a\nb=1",
                                   std::string(5000, 'x'),
                                   Json::array(),
                                   {1, 2},
                                   {"x", {}, nullptr},
                                   Json::object(),
                                   {{"do", "play"}},
                                   0.5,
                                   "material.young",
                                   "1e5",
                                   "--",
                                   "\u00e9"};
    return odd[below(static_cast<int>(odd.size()))];
  }

  Json mutated(Json message) {
    auto member = message.begin();
    std::advance(member, below(static_cast<int>(message.size())));
    switch (below(5)) {
      case 0:
        member.value() = odd_value();
        break;
      case 1:
        message.erase(member);
        break;
      case 2:
        message["extra"] = odd_value();
        break;
      case 3:
        if (member.value().is_structured() && !member.value().empty()) {
          member.value().front() = odd_value();
          break;
        }
        [[fallthrough]];
      default:
        break;  // unchanged
    }
    return message;
  }

  std::string mutated_text(std::string text) {
    if (below(4) > 0 || text.empty()) return text;
    const size_t at = below(static_cast<int>(text.size()));
    if (below(2))
      text.erase(at, 1 + below(5));
    else
      text[at] = static_cast<char>(below(256));
    return text;
  }

 private:
  std::mt19937 random_;
};

TEST(Refusals, AnswerRandomMessagesWithoutStopping) {
  const std::string small = R"([[body]]
shape = { box = { upper = [1, 0.5, 0.5], cells = [2, 1, 1] } }
[[body.pin]]
where = "x < 0.1"
)";
  Page page(small);
  Mutations mutations(20);
  for (int i = 0; i < 3000; ++i) {
    const Json& valid = valid_messages()[mutations.below(static_cast<int>(valid_messages().size()))];
    const std::string text =
        mutations.mutated_text(mutations.mutated(valid).dump(-1, ' ', false, Json::error_handler_t::replace));
    const Role role = mutations.below(20) == 0 ? Role::watches : Role::steers;
    Answer answer;
    ASSERT_NO_THROW(answer = page.session().handle(text, role)) << text;
    for (const Message& message : answer.to_sender) ASSERT_TRUE(Json::accept(message.bytes)) << text;
    for (const Message& message : answer.to_all) ASSERT_TRUE(message.is_binary || Json::accept(message.bytes)) << text;
    ASSERT_NO_THROW(page.session().advance());
    ASSERT_FALSE(page.session().pictures().empty());
  }
  page.session().handle(R"({"do": "reset"})", Role::steers);
  const Messages greeting = page.session().greeting(Role::steers);
  EXPECT_EQ(last(greeting, "state")["a"]["step"], 0);
}

}  // namespace
}  // namespace aspic::viewer
