#include "scene/trace.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.h"
#include "optimize/landscape.h"

namespace aspic {
namespace {

const std::vector<std::string> kTracedIterationColumns = {"step",
                                                          "solve",
                                                          "iteration",
                                                          "value",
                                                          "gradient_norm",
                                                          "decrement",
                                                          "alpha",
                                                          "trials",
                                                          "fallbacks",
                                                          "gradients",
                                                          "hessians",
                                                          "projected",
                                                          "projected_elements",
                                                          "factorizations",
                                                          "linear_iterations",
                                                          "products",
                                                          "cycles"};
const std::vector<std::string> kTrialColumns = {"step",  "solve", "iteration", "trial",   "alpha",
                                                "value", "bound", "by_slope",  "accepted"};
const std::vector<std::string> kTracedTimingColumns = {"step",      "solve",        "iteration",   "hessian",
                                                       "factorize", "solve_linear", "line_search", "gradient"};

CsvRow row_of(int step, int solve, int iteration) {
  CsvRow row;
  row.add(step).add(solve).add(iteration);
  return row;
}

nlohmann::ordered_json json_of(const Trial& trial) {
  return {{"alpha", trial.alpha},
          {"value", trial.value},
          {"bound", trial.bound},
          {"by_slope", trial.by_slope},
          {"accepted", trial.accepted}};
}

nlohmann::ordered_json json_of(int step, int solve, const LiveIteration& iteration) {
  const DirectionReport& direction = iteration.direction;
  nlohmann::ordered_json trials = nlohmann::json::array();
  for (const Trial& trial : iteration.tried) trials.push_back(json_of(trial));
  return {{"step", step},
          {"solve", solve},
          {"iteration", iteration.index},
          {"value", iteration.value},
          {"gradient_norm", iteration.gradient_norm},
          {"decrement", iteration.decrement},
          {"alpha", iteration.alpha},
          {"fallbacks", iteration.fallbacks},
          {"gradients", iteration.gradients},
          {"hessians", direction.hessians},
          {"projected", direction.projected},
          {"projected_elements", direction.projected_elements},
          {"factorizations", direction.factorizations},
          {"linear_iterations", direction.linear_iterations},
          {"products", direction.products},
          {"cycles", direction.cycles},
          {"trials", trials},
          {"seconds",
           {{"hessian", direction.hessian_seconds},
            {"factorize", direction.factorize_seconds},
            {"solve_linear", direction.solve_seconds},
            {"line_search", iteration.line_search_seconds},
            {"gradient", iteration.gradient_seconds}}}};
}

void write_curve(const std::filesystem::path& path, const std::vector<CurvePoint>& curve) {
  CsvFile file = CsvFile::create(path, {"alpha", "value", "model", "textbook_bound", "slide_bound"});
  for (const CurvePoint& point : curve) {
    CsvRow row;
    row.add(point.alpha).add(point.value).add(point.model).add(point.textbook_bound).add(point.slide_bound);
    file.append(row);
  }
  file.close();
}

void write_slice(const std::filesystem::path& path, const Slice& slice) {
  CsvFile file = CsvFile::create(path, {"s", "t", "value", "model"});
  for (const SlicePoint& point : slice.point)
    file.append(CsvRow().add(point.s).add(point.t).add(point.value).add(point.model));
  file.close();
}

bool read_number(std::string_view text, int least, int& number) {
  const auto end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end && number >= least;
}

}  // namespace

LandscapeAt parse_landscape(const std::string& text) {
  LandscapeAt at;
  const size_t colon = text.find(':');
  const bool has_iteration = colon != std::string::npos;
  if (!read_number(std::string_view(text).substr(0, colon), 1, at.step) ||
      (has_iteration && !read_number(std::string_view(text).substr(colon + 1), 0, at.iteration)))
    throw InvalidInput("landscape '" + text + "': write STEP or STEP:ITERATION, such as 12 or 12:3; steps count from " +
                       "1, iterations from 0");
  return at;
}

std::string landscape_name(const LandscapeAt& at) {
  return std::to_string(at.step) + "_" + std::to_string(at.iteration);
}

Trace::Trace(std::filesystem::path folder, TraceOptions options)
    : folder_(std::move(folder)), options_(std::move(options)), met_(options_.landscapes.size(), 0) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw InvalidInput(folder_.string() + ": cannot be created: " + error.message());
  iterations_ = CsvFile::create(folder_ / "iterations.csv", kTracedIterationColumns);
  trials_ = CsvFile::create(folder_ / "trials.csv", kTrialColumns);
  timings_ = CsvFile::create(folder_ / "timings.csv", kTracedTimingColumns);
  json_ = OutputFile::create(folder_ / "trace.jsonl");
}

void Trace::on_iteration(int step, const LiveIteration& iteration) {
  if (step != step_) step_ = step, solve_ = 0;
  if (iteration.index == 0) ++solve_;
  add_rows(step, iteration);
  for (size_t i = 0; i < met_.size(); ++i) {
    const LandscapeAt& at = options_.landscapes[i];
    if (met_[i] || at.step != step || at.iteration != iteration.index) continue;
    add_landscape(at, iteration);
    met_[i] = 1;
  }
}

void Trace::add_rows(int step, const LiveIteration& iteration) {
  const DirectionReport& direction = iteration.direction;
  CsvRow row = row_of(step, solve_, iteration.index);
  row.add(iteration.value).add(iteration.gradient_norm).add(iteration.decrement).add(iteration.alpha);
  row.add(iteration.trials).add(iteration.fallbacks).add(iteration.gradients).add(direction.hessians);
  row.add(direction.projected ? 1 : 0).add(direction.projected_elements).add(direction.factorizations);
  row.add(direction.linear_iterations).add(direction.products).add(direction.cycles);
  iterations_.append(row);

  for (size_t i = 0; i < iteration.tried.size(); ++i) {
    const Trial& trial = iteration.tried[i];
    CsvRow tried = row_of(step, solve_, iteration.index);
    tried.add(static_cast<int>(i)).add(trial.alpha).add(trial.value).add(trial.bound);
    trials_.append(tried.add(trial.by_slope ? 1 : 0).add(trial.accepted ? 1 : 0));
  }

  CsvRow times = row_of(step, solve_, iteration.index);
  times.add(direction.hessian_seconds).add(direction.factorize_seconds).add(direction.solve_seconds);
  timings_.append(times.add(iteration.line_search_seconds).add(iteration.gradient_seconds));

  json_.append(json_of(step, solve_, iteration).dump() + "\n");
}

void Trace::add_landscape(const LandscapeAt& at, const LiveIteration& iteration) {
  const Landscape& made =
      landscapes_.emplace_back(Landscape{.at = at,
                                         .value = iteration.value,
                                         .alpha = iteration.alpha,
                                         .tried = {iteration.tried.begin(), iteration.tried.end()},
                                         .curve = curve_along(iteration, options_.sufficient_decrease),
                                         .slice = slice_through(iteration)});
  write_curve(folder_ / ("curve_" + landscape_name(at) + ".csv"), made.curve);
  write_slice(folder_ / ("slice_" + landscape_name(at) + ".csv"), made.slice);
}

void Trace::close() {
  for (CsvFile* file : {&iterations_, &trials_, &timings_}) file->sync(), file->close();
  json_.sync();
  json_.close();
}

std::vector<LandscapeAt> Trace::missed() const {
  std::vector<LandscapeAt> missed;
  for (size_t i = 0; i < met_.size(); ++i)
    if (!met_[i]) missed.push_back(options_.landscapes[i]);
  return missed;
}

}  // namespace aspic
