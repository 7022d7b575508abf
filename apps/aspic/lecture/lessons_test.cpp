#include "aspic/lecture/lessons.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "aspic/lecture/course.h"
#include "io/atomic_file.h"
#include "io/external_program.h"

namespace aspic::cli::lecture {
namespace {

using nlohmann::json;
using viewer::Lesson;
using viewer::Message;
using viewer::Role;
using viewer::Session;

const std::vector<Lesson>& all_lessons() {
  static const TemporaryFolder cache;
  static const std::vector<Lesson> list = lessons(cache.path());
  return list;
}

constexpr char kOtherScene[] = "[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n";

// A session with an opened lesson, and the rows of its steps.
class Opened {
 public:
  explicit Opened(const std::string& id) {
    write_file(folder_.path() / "other.toml", kOtherScene);
    session_.emplace(folder_.path() / "other.toml", std::vector<std::string>{},
                     viewer::SessionOptions{.lessons = all_lessons()});
    reply_ = command({{"do", "lesson"}, {"lesson", id}});
  }

  json reply() const { return reply_; }
  json command(json message) {
    message["id"] = 1;
    viewer::Answer answer = session_->handle(message.dump(), Role::steers);
    hear(answer.to_all);
    return json::parse(answer.to_sender.at(0).bytes);
  }
  void step() { EXPECT_EQ(command({{"do", "step"}})["kind"], "reply"); }
  // Plays the recorded mouse to its end, or the given number of steps without one.
  void play(int steps) {
    if (!session_->is_playing()) command({{"do", "play"}});
    for (int i = 0; i < steps && session_->is_playing(); ++i) hear(session_->advance());
  }

  const std::string& field() const { return field_; }  // field for colors
  bool has(const std::string& side) const { return scenes_.contains(side); }
  const std::vector<json>& rows(const std::string& side) { return rows_[side]; }
  bool converged(const std::string& side) const {
    const auto& rows = rows_.at(side);
    return std::all_of(rows.begin(), rows.end(), [](const json& row) { return row.at("converged") == true; });
  }
  // Kinetic + potential [J]; infinity if not finite.
  double largest_energy(const std::string& side) const {
    double most = 0;
    for (const json& row : rows_.at(side)) {
      double energy = number(row.at("kinetic"));
      for (const json& term : row.at("potential")) energy += number(term);
      most = std::max(most, energy);
    }
    return most;
  }

 private:
  static double number(const json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::infinity();
  }

  void hear(const viewer::Messages& messages) {
    for (const Message& message : messages) {
      if (message.is_binary) continue;
      const json sent = json::parse(message.bytes);
      if (sent["kind"] == "scene") {
        scenes_.insert(sent["side"].get<std::string>());
        field_ = sent["field"].get<std::string>();
      }
      if (sent["kind"] != "steps") continue;
      auto& rows = rows_[sent["side"].get<std::string>()];
      rows.resize(std::min(rows.size(), sent["from"].get<size_t>()));
      for (const json& row : sent["steps"]) rows.push_back(row);
    }
  }

  TemporaryFolder folder_;
  std::optional<Session> session_;
  json reply_;
  std::set<std::string> scenes_;
  std::string field_;
  std::map<std::string, std::vector<json>> rows_;
};

std::vector<const Lesson*> lessons_of(const Demonstration& demonstration) {
  std::vector<const Lesson*> found;
  for (const Lesson& lesson : all_lessons())
    if (lesson.id.starts_with(demonstration.key)) found.push_back(&lesson);
  return found;
}

TEST(Lessons, StandForEveryDemonstrationInItsWords) {
  for (const Demonstration& demonstration : demonstrations()) {
    EXPECT_FALSE(lessons_of(demonstration).empty()) << demonstration.key;
    for (const Lesson* lesson : lessons_of(demonstration)) {
      EXPECT_EQ(lesson->claim, demonstration.claim);
      EXPECT_THAT(lesson->title, testing::StartsWith(demonstration.title));
      EXPECT_EQ(lesson->missing, "") << lesson->id;
      EXPECT_TRUE(lesson->scene.empty() != lesson->function.empty()) << lesson->id;
    }
  }
}

TEST(Lessons, HaveNamesOfTheirOwnAndAPanel) {
  std::set<std::string> names;
  for (const Lesson& lesson : all_lessons()) {
    EXPECT_TRUE(names.insert(lesson.id).second) << lesson.id;
    EXPECT_THAT(lesson.panel, testing::AnyOf("energy", "microscope", "landscape", "functions")) << lesson.id;
  }
}

TEST(Lessons, OpenAndStep) {
  for (const Lesson& lesson : all_lessons()) {
    Opened opened(lesson.id);
    EXPECT_EQ(opened.reply()["kind"], "reply") << lesson.id << opened.reply();
    if (!lesson.function.empty()) {
      json asked = json::parse(lesson.function);
      asked["ask"] = "function";
      const json answer = opened.command(asked);
      EXPECT_EQ(answer["kind"], "reply") << lesson.id << answer;
      continue;
    }
    EXPECT_EQ(opened.has("b"), !lesson.comparison.empty()) << lesson.id;
    opened.step();
    EXPECT_EQ(opened.rows("a").size(), 1u) << lesson.id;
    EXPECT_TRUE(opened.converged("a")) << lesson.id;
    if (opened.has("b")) {
      EXPECT_GE(opened.rows("b").size(), 1u) << lesson.id;
    }
  }
}

TEST(Lessons, SpringsAndElementsConverge) {
  Opened opened("08-10_springs_beside_elements");
  opened.play(20);
  EXPECT_TRUE(opened.converged("a"));
}

TEST(Lessons, ExplicitAndImplicitAgreeWithShortSteps) {
  Opened opened("19-22_explicit_or_implicit");
  opened.play(400);
  EXPECT_NEAR(opened.largest_energy("b") / opened.largest_energy("a"), 1, 0.05);
}

TEST(Lessons, ClassicalForwardEulerExplodesUnlikePrintedOne) {
  Opened opened("23_printed_forward_euler");
  opened.play(2000);
  const double first = [&] {
    double energy = opened.rows("a")[0]["kinetic"].get<double>();
    for (const json& term : opened.rows("a")[0]["potential"]) energy += term.get<double>();
    return energy;
  }();
  EXPECT_LT(opened.largest_energy("a"), 1.2 * first);
  EXPECT_GT(opened.largest_energy("b"), 1e3 * first);
}

TEST(Lessons, BackwardEulerSurvivesStepOfExplodingExplicitScheme) {
  Opened opened("24_backward_euler");
  opened.play(80);
  EXPECT_TRUE(opened.converged("a"));
  EXPECT_GT(opened.largest_energy("b"), 1e3 * opened.largest_energy("a"));
}

TEST(Lessons, TheRecordedMousePullsTheBody) {
  Opened opened("25_drag");
  opened.play(1000);
  EXPECT_TRUE(opened.converged("a"));
  double work = 0;
  for (const json& row : opened.rows("a")) work += row["mouse_work"].get<double>();
  EXPECT_GT(work, 0.01);
  EXPECT_EQ(opened.rows("a").size(), 150u);
}

TEST(Lessons, NoTextDeniesCaptureAndFitting) {
  for (const Lesson& lesson : all_lessons())
    for (const std::string* text : {&lesson.title, &lesson.claim, &lesson.exercise})
      EXPECT_THAT(*text, testing::Not(testing::HasSubstr("not part of Aspic"))) << lesson.id;
}

TEST(Lessons, TissueShowsItsStiffnessAndStiffens) {
  Opened opened("03_tissue");
  EXPECT_EQ(opened.field(), "young");
  opened.play(10);
  const auto energy = [&](int step) { return opened.rows("a").at(step - 1)["potential"][0].get<double>(); };
  EXPECT_GT(energy(10), 1.05 * 4 * energy(5));  // at twice the depth
}

TEST(Lessons, TenfoldStepEndsOnlyTheExplicitScheme) {
  Opened opened("19-22_explicit_or_implicit");
  opened.command({{"do", "set"}, {"key", "time.step"}, {"value", 5e-3}});
  opened.play(60);
  EXPECT_TRUE(opened.converged("a"));
  EXPECT_GT(opened.largest_energy("b"), 1e3 * opened.largest_energy("a"));
}

TEST(Lessons, HardStepWithoutLineSearchLeavesTheNumbers) {
  Opened opened("53+62_pure_newton");
  opened.step();
  const json row = opened.rows("b")[0];
  EXPECT_EQ(row["status"], "undefined");
  EXPECT_GT(row["iterations"][1]["value"].get<double>(), 1e3 * row["iterations"][0]["value"].get<double>());
}

TEST(Lessons, HardStepStartsInTheSameDirectionOnBothSides) {
  Opened opened("53+62_pure_newton");
  opened.step();
  const json a = opened.rows("a")[0]["iterations"][0], b = opened.rows("b")[0]["iterations"][0];
  for (const char* key : {"value", "gradient_norm", "decrement", "projected_elements"})
    EXPECT_EQ(a[key], b[key]) << key;
  EXPECT_LT(a["alpha"], b["alpha"]);
}

class Explosion : public testing::TestWithParam<std::string> {};

TEST_P(Explosion, OccursWithOtherSchemeUnderSameMouse) {
  Opened opened("33-34_explosion_" + GetParam());
  opened.play(18);
  EXPECT_TRUE(opened.converged("a"));
  if (GetParam() == "explicit") {
    EXPECT_GT(opened.rows("a").size(), 2 * opened.rows("b").size());  // it continues after the other has ended
  }
  EXPECT_GT(opened.largest_energy("b"), 1e3 * opened.largest_energy("a"));
}

INSTANTIATE_TEST_SUITE_P(Lessons, Explosion, testing::Values("explicit", "linearized"));

TEST(Lessons, GradientDescentTakesMoreIterations) {
  Opened opened("38-42_gradient_descent_a step of a body");
  for (int i = 0; i < 3; ++i) opened.step();
  ASSERT_TRUE(opened.converged("a"));
  EXPECT_GT(opened.rows("b")[2]["iterations"].size(), 10 * opened.rows("a")[2]["iterations"].size());
}

TEST(Lessons, NewtonNeedsLineSearchOnTheHardStep) {
  Opened opened("53+62_pure_newton");
  opened.step();
  EXPECT_TRUE(opened.converged("a"));
  EXPECT_FALSE(opened.converged("b"));
}

TEST(Lessons, BacktrackingRejectsTrials) {
  Opened opened("60-61_backtracking");
  opened.step();
  size_t most = 0;
  for (const json& iteration : opened.rows("a")[0]["iterations"]) most = std::max(most, iteration["trials"].size());
  EXPECT_GE(most, 2u);
}

}  // namespace
}  // namespace aspic::cli::lecture
