#include "results/trace.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "linalg/linear_solver.h"
#include "optimize/newton.h"
#include "optimize/test_functions.h"

namespace aspic {
namespace {

using Traces = FolderTest;
using Table = std::vector<std::map<std::string, std::string>>;  // rows by column

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::stringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

Table read_table(const std::filesystem::path& path) {
  const std::vector<std::string> lines = split(read_file(path), '\n');
  const std::vector<std::string> head = split(lines.at(0), ',');
  Table table;
  for (size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> cells = split(lines[i], ',');
    EXPECT_EQ(cells.size(), head.size());
    for (size_t c = 0; c < head.size(); ++c) (c == 0 ? table.emplace_back() : table.back())[head[c]] = cells.at(c);
  }
  return table;
}

struct Recorded {
  Iteration iteration;
  std::vector<Trial> trials;
};

// Newton's method on Rosenbrock's function, traced as step 3.
std::vector<Recorded> traced_minimization(Trace& trace) {
  Rosenbrock f;
  Newton direction(make_linear_solver("cholesky"));
  std::vector<double> x = {-0.8, 0.6, 0};
  std::vector<Recorded> recorded;
  Minimizer().minimize(f, direction, x, {}, [&](const LiveIteration& iteration) {
    trace.on_iteration(3, iteration);
    recorded.push_back({iteration, {iteration.tried.begin(), iteration.tried.end()}});
  });
  trace.close();
  return recorded;
}

TEST_F(Traces, TablesReadBackToSameBits) {
  Trace trace(path("trace"));
  const std::vector<Recorded> recorded = traced_minimization(trace);
  const Table iterations = read_table(path("trace") / "iterations.csv");
  const Table trials = read_table(path("trace") / "trials.csv");
  ASSERT_EQ(iterations.size(), recorded.size());
  ASSERT_GT(recorded.size(), 5u);
  size_t t = 0;
  for (size_t i = 0; i < recorded.size(); ++i) {
    EXPECT_EQ(iterations[i].at("step"), "3");
    EXPECT_EQ(iterations[i].at("solve"), "1");
    EXPECT_EQ(std::stod(iterations[i].at("value")), recorded[i].iteration.value);
    EXPECT_EQ(std::stod(iterations[i].at("decrement")), recorded[i].iteration.decrement);
    EXPECT_EQ(std::stoi(iterations[i].at("trials")), static_cast<int>(recorded[i].trials.size()));
    for (const Trial& trial : recorded[i].trials) {
      EXPECT_EQ(std::stoul(trials.at(t).at("iteration")), i);
      EXPECT_EQ(std::stod(trials[t].at("alpha")), trial.alpha);
      EXPECT_EQ(std::stod(trials[t].at("value")), trial.value);
      EXPECT_EQ(std::stod(trials[t].at("bound")), trial.bound);
      EXPECT_EQ(trials[t++].at("accepted"), trial.accepted ? "1" : "0");
    }
  }
  EXPECT_EQ(t, trials.size());
  EXPECT_EQ(read_table(path("trace") / "timings.csv").size(), recorded.size());
}

TEST_F(Traces, JsonLinesMatchIterations) {
  Trace trace(path("trace"));
  const std::vector<Recorded> recorded = traced_minimization(trace);
  std::ifstream file(path("trace") / "trace.jsonl");
  size_t i = 0;
  for (std::string line; std::getline(file, line); ++i) {
    const nlohmann::json json = nlohmann::json::parse(line);
    const Recorded& wanted = recorded.at(i);
    EXPECT_EQ(json["iteration"], wanted.iteration.index);
    EXPECT_EQ(json["value"].get<double>(), wanted.iteration.value);
    EXPECT_EQ(json["gradient_norm"].get<double>(), wanted.iteration.gradient_norm);
    ASSERT_EQ(json["trials"].size(), wanted.trials.size());
    for (size_t t = 0; t < wanted.trials.size(); ++t) {
      EXPECT_EQ(json["trials"][t]["value"].get<double>(), wanted.trials[t].value);
      EXPECT_EQ(json["trials"][t]["accepted"].get<bool>(), wanted.trials[t].accepted);
    }
    double seconds = 0;
    for (const auto& [stage, time] : json["seconds"].items()) seconds += time.get<double>();
    EXPECT_GT(seconds, 0);
  }
  EXPECT_EQ(i, recorded.size());
}

TEST_F(Traces, LandscapeIsWrittenOnRequest) {
  Trace trace(path("trace"), {.landscapes = {{3, 1}, {3, 999}}});
  const std::vector<Recorded> recorded = traced_minimization(trace);
  const Table curve = read_table(path("trace") / "curve_3_1.csv");
  EXPECT_EQ(curve.size(), 101u);
  const Table slice = read_table(path("trace") / "slice_3_1.csv");
  EXPECT_EQ(slice.size(), 41u * 41u);
  for (const auto& row : slice) {
    if (std::stod(row.at("s")) == 0 && std::stod(row.at("t")) == 0) {
      EXPECT_DOUBLE_EQ(std::stod(row.at("value")), recorded[1].iteration.value);
    }
  }
  ASSERT_EQ(trace.missed().size(), 1u);
  EXPECT_EQ(trace.missed()[0].iteration, 999);
}

TEST_F(Traces, FailedIterationIsTracedWithAllTrials) {
  Rosenbrock f;
  Newton direction(make_linear_solver("cholesky"));
  std::vector<double> x = {-0.8, 0.6, 0};
  Trace trace(path("trace"), {.landscapes = {{1, 0}}});
  MinimizeOptions options;
  options.line_search.test = DecreaseTest::slide;  // requires the decrease of a full step
  options.line_search.sufficient_decrease = 0.99;
  const auto observe = [&](const LiveIteration& iteration) { trace.on_iteration(1, iteration); };
  ASSERT_EQ(Minimizer().minimize(f, direction, x, options, observe).status, Status::stuck);
  trace.close();
  const Table iterations = read_table(path("trace") / "iterations.csv");
  EXPECT_EQ(std::stod(iterations.back().at("alpha")), 0);
  EXPECT_GT(std::stoi(iterations.back().at("trials")), 30);
}

TEST(ParseLandscape, ReadsStepWithOptionalIteration) {
  EXPECT_EQ(parse_landscape("12").step, 12);
  EXPECT_EQ(parse_landscape("12").iteration, 0);
  EXPECT_EQ(parse_landscape("12:3").iteration, 3);
  for (const char* text : {"", "0", "-1", "x", "1:", "1:-1", "1:2:3", "1.5", "99999999999"})
    EXPECT_THAT([&] { parse_landscape(text); }, testing::ThrowsMessage<InvalidInput>(testing::HasSubstr("STEP")))
        << text;
}

}  // namespace
}  // namespace aspic
