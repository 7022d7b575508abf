#include "results/trace.h"

#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.h"
#include "base/number_chars.h"
#include "optimize/landscape.h"

namespace aspic {
namespace {

using Json = nlohmann::ordered_json;

// The columns of a table, which are also the members of a JSON object.
template <class T>
using Columns = std::vector<std::pair<std::string, Json (*)(const T&)>>;

const Columns<LiveIteration> kTraceIterationColumns = {
    {"value", [](const LiveIteration& i) -> Json { return i.value; }},
    {"gradient_norm", [](const LiveIteration& i) -> Json { return i.gradient_norm; }},
    {"decrement", [](const LiveIteration& i) -> Json { return i.decrement; }},
    {"alpha", [](const LiveIteration& i) -> Json { return i.alpha; }},
    {"trials", [](const LiveIteration& i) -> Json { return i.trials; }},
    {"fallbacks", [](const LiveIteration& i) -> Json { return i.fallbacks; }},
    {"gradients", [](const LiveIteration& i) -> Json { return i.gradients; }},
    {"hessians", [](const LiveIteration& i) -> Json { return i.direction.hessians; }},
    {"projected", [](const LiveIteration& i) -> Json { return i.direction.projected; }},
    {"projected_elements", [](const LiveIteration& i) -> Json { return i.direction.projected_elements; }},
    {"factorizations", [](const LiveIteration& i) -> Json { return i.direction.factorizations; }},
    {"linear_iterations", [](const LiveIteration& i) -> Json { return i.direction.linear_iterations; }},
    {"products", [](const LiveIteration& i) -> Json { return i.direction.products; }},
    {"cycles", [](const LiveIteration& i) -> Json { return i.direction.cycles; }}};
const Columns<Trial> kTraceTrialColumns = {{"alpha", [](const Trial& t) -> Json { return t.alpha; }},
                                           {"value", [](const Trial& t) -> Json { return t.value; }},
                                           {"bound", [](const Trial& t) -> Json { return t.bound; }},
                                           {"by_slope", [](const Trial& t) -> Json { return t.by_slope; }},
                                           {"accepted", [](const Trial& t) -> Json { return t.accepted; }}};
const Columns<LiveIteration> kTraceTimingColumns = {
    {"hessian", [](const LiveIteration& i) -> Json { return i.direction.hessian_seconds; }},
    {"factorize", [](const LiveIteration& i) -> Json { return i.direction.factorize_seconds; }},
    {"solve_linear", [](const LiveIteration& i) -> Json { return i.direction.solve_seconds; }},
    {"line_search", [](const LiveIteration& i) -> Json { return i.line_search_seconds; }},
    {"gradient", [](const LiveIteration& i) -> Json { return i.gradient_seconds; }}};

template <class T>
CsvFile table(const std::filesystem::path& path, std::vector<std::string> names, const Columns<T>& columns) {
  for (const auto& column : columns) names.push_back(column.first);
  return CsvFile::create(path, names);
}

template <class T>
void append(const T& source, const Columns<T>& columns, CsvRow row, CsvFile& file) {
  for (const auto& column : columns) {
    const Json value = column.second(source);
    if (value.is_number_float())
      row.add(value.template get<double>());
    else
      row.add(value.template get<int>());  // false: 0, true: 1
  }
  file.append(row);
}

template <class T>
Json json_of(const T& source, const Columns<T>& columns) {
  Json object;
  for (const auto& [name, value] : columns) object[name] = value(source);
  return object;
}

CsvRow row_of(int step, int solve, int iteration) {
  CsvRow row;
  row.add(step).add(solve).add(iteration);
  return row;
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
  const auto [stop, error] = from_chars(text.data(), end, number);
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
  iterations_ = table(folder_ / "iterations.csv", {"step", "solve", "iteration"}, kTraceIterationColumns);
  trials_ = table(folder_ / "trials.csv", {"step", "solve", "iteration", "trial"}, kTraceTrialColumns);
  timings_ = table(folder_ / "timings.csv", {"step", "solve", "iteration"}, kTraceTimingColumns);
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
  const CsvRow row = row_of(step, solve_, iteration.index);
  append(iteration, kTraceIterationColumns, row, iterations_);
  append(iteration, kTraceTimingColumns, row, timings_);
  Json trials = Json::array();
  for (const Trial& trial : iteration.tried) {
    CsvRow tried = row;
    append(trial, kTraceTrialColumns, tried.add(static_cast<int>(trials.size())), trials_);
    trials.push_back(json_of(trial, kTraceTrialColumns));
  }

  Json line = {{"step", step}, {"solve", solve_}, {"iteration", iteration.index}};
  line.update(json_of(iteration, kTraceIterationColumns));
  line["trials"] = std::move(trials);
  line["seconds"] = json_of(iteration, kTraceTimingColumns);
  json_.append(line.dump() + "\n");
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
