// The page of a study: failures, final quantities over the varied keys, and all cases.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "aspic/plot.h"
#include "aspic/report_page.h"
#include "aspic/sweep/sweep.h"
#include "base/error.h"
#include "io/external_program.h"
#include "io/text_scanner.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxRows = 1000, kMaxCharts = 24, kMaxSeries = 8;
constexpr double kLogSpan = 50;  // ratio of the largest to the smallest value from which an axis is logarithmic

struct Quantity {
  std::string column, label;
};
const std::array kQuantities = {Quantity{"potential_total", "potential energy at the end [J]"},
                                Quantity{"kinetic", "kinetic energy at the end [J]"},
                                Quantity{"least_det_F", "smallest det F of the run"},
                                Quantity{"damping_loss", "damping loss of the last step [J]"},
                                Quantity{"max_pressure", "contact pressure at the end [Pa]"},
                                Quantity{"worst_residual", "largest residual / threshold"},
                                Quantity{"iterations", "iterations of the run"},
                                Quantity{"seconds", "wall time of the run [s]"}};

bool is_done(const CaseResult& result) { return result.state == CaseState::done; }

// The case, then the given cells, then the values of the keys.
std::vector<Cell> case_row(const StudyResults& study, size_t i, const std::vector<Cell>& more) {
  std::vector<Cell> cells = {{case_name(i)}};
  cells.insert(cells.end(), more.begin(), more.end());
  for (const std::string& value : study.cases[i]) cells.push_back({value});
  return cells;
}

std::vector<std::string> header(const StudyResults& study, std::vector<std::string> columns) {
  columns.insert(columns.begin(), "case");
  columns.insert(columns.end(), study.keys.begin(), study.keys.end());
  return columns;
}

void add_table(ReportPage& page, const std::vector<std::string>& columns, std::vector<std::vector<Cell>> rows) {
  const size_t count = rows.size();
  rows.resize(std::min(count, kMaxRows));
  page.table(columns, rows);
  if (count > kMaxRows) page.paragraph(fmt::format("{} more are in results.csv.", count - kMaxRows));
}

void add_failures(ReportPage& page, const StudyResults& study) {
  std::vector<size_t> order;
  for (size_t i = 0; i < study.results.size(); ++i)
    if (!is_done(study.results[i])) order.push_back(i);
  if (order.empty()) return page.verdict(Verdict::pass, "done", fmt::format("All {} cases.", study.cases.size()));
  page.verdict(Verdict::fail, "incomplete",
               fmt::format("{} of {} cases are done.", study.cases.size() - order.size(), study.cases.size()));
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return study.results[a].state < study.results[b].state; });
  std::vector<std::vector<Cell>> rows;
  for (const size_t i : order) {
    const CaseResult& result = study.results[i];
    const bool is_open = result.state == CaseState::running || result.state == CaseState::not_begun;
    const Cell state{to_string(result.state), is_open ? Verdict::neutral : Verdict::fail};
    rows.push_back(case_row(study, i, {state, {result.reason}}));
  }
  page.heading("Cases that are not done");
  add_table(page, header(study, {"status", "reason"}), std::move(rows));
}

// Numbers of a column of the done cases; empty unless all are finite numbers and two differ.
using Numbers = std::vector<double>;
template <class ValueOf>
Numbers numbers(const StudyResults& study, const ValueOf& value_of) {
  Numbers values;
  for (size_t i = 0; i < study.cases.size(); ++i) {
    if (!is_done(study.results[i])) continue;
    const std::optional<double> value = parse_number(value_of(i));
    if (!value) return {};
    values.push_back(*value);
  }
  const bool varies = std::any_of(values.begin(), values.end(), [&](double v) { return v != values.front(); });
  return varies ? values : Numbers();
}

AxisScale scale_of(const Numbers& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return *least > 0 && *most > kLogSpan * *least ? AxisScale::logarithmic : AxisScale::linear;
}

// Of two keys, each value of the other one has its own series, if there are few. Otherwise all cases are points of one.
std::vector<Series> series_of(const StudyResults& study, size_t key, const Numbers& x, const Numbers& y) {
  std::vector<std::pair<std::string, std::vector<Point2>>> parts;  // in the order of the cases
  size_t at = 0;
  for (size_t i = 0; i < study.cases.size(); ++i) {
    if (!is_done(study.results[i])) continue;
    const std::string label = study.keys.size() == 2 ? study.keys[1 - key] + " = " + study.cases[i][1 - key] : "";
    auto part = std::find_if(parts.begin(), parts.end(), [&](const auto& known) { return known.first == label; });
    if (part == parts.end()) part = parts.insert(part, {label, {}});
    part->second.push_back({x[at], y[at]});
    ++at;
  }
  if (study.keys.size() > 2 || parts.size() > kMaxSeries || 2 * parts.size() > x.size())
    return {{"", x, y, SeriesStyle::points}};
  std::vector<Series> series;
  for (auto& [label, points] : parts) {
    std::sort(points.begin(), points.end());
    Series& line = series.emplace_back(Series{label, {}, {}, SeriesStyle::line_and_points});
    for (const Point2& point : points) line.x.push_back(point[0]), line.y.push_back(point[1]);
  }
  return series;
}

// The largest component of the force of each pin.
std::vector<Quantity> reactions(const StudyResults& study) {
  constexpr std::string_view kForce = "reaction_", kMoment = "reaction_moment_";
  std::map<std::string, std::pair<double, std::string>> largest;  // of each pin: its size and its column
  for (const CaseResult& result : study.results)
    for (const auto& [column, text] : result.values) {
      if (!column.starts_with(kForce) || column.starts_with(kMoment)) continue;
      auto& [size, name] = largest[column.substr(0, column.size() - 2)];
      if (const std::optional<double> value = parse_number(text); value && std::abs(*value) > size)
        size = std::abs(*value), name = column;
    }
  std::vector<Quantity> list;
  for (const auto& [pin, found] : largest)
    if (found.first > 0)
      list.push_back({found.second, fmt::format("reaction of {} along {} in the last step [N]",
                                                pin.substr(kForce.size()), found.second.back())});
  return list;
}

void add_charts(ReportPage& page, const StudyResults& study) {
  const TemporaryFolder pictures;
  std::vector<Quantity> quantities = reactions(study);
  quantities.insert(quantities.end(), kQuantities.begin(), kQuantities.end());
  size_t count = 0;
  for (size_t key = 0; key < study.keys.size(); ++key) {
    const Numbers x = numbers(study, [&](size_t i) { return study.cases[i][key]; });
    if (x.empty()) continue;
    std::vector<Figure> row;
    for (const auto& [column, label] : quantities) {
      const Numbers y = numbers(study, [&, &name = column](size_t i) { return study.results[i].value(name); });
      if (y.empty() || count == kMaxCharts) continue;
      const fs::path picture = pictures.path() / fmt::format("{}.svg", count++);
      draw(picture, Chart{"", {study.keys[key], scale_of(x)}, {label, scale_of(y)}, series_of(study, key, x, y)});
      row.push_back({picture, fmt::format("{} over {}", label, study.keys[key])});
    }
    if (row.empty()) continue;
    page.heading("Over " + study.keys[key]);
    page.figures(row);
  }
}

void add_cases(ReportPage& page, const StudyResults& study) {
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < study.cases.size(); ++i) {
    if (!is_done(study.results[i])) continue;
    std::vector<Cell> values;
    for (const char* column :
         {"time", "kinetic", "potential_total", "least_det_F", "iterations", "seconds", "state_hash"})
      values.push_back({study.results[i].value(column)});
    rows.push_back(case_row(study, i, values));
  }
  if (rows.empty()) return;
  page.heading("Cases that are done");
  page.paragraph(
      "Values of the last step; least det F, iterations and seconds of the whole run. results.csv has more columns.");
  add_table(
      page,
      header(study, {"time [s]", "kinetic [J]", "potential [J]", "least det F", "iterations", "seconds", "state"}),
      std::move(rows));
}

}  // namespace

std::string write_study_page(const StudyResults& study) {
  const std::string name = fs::absolute(study.folder).lexically_normal().filename().string();
  ReportPage page(fmt::format("Study \"{}\", {} cases", name, study.cases.size()));
  add_failures(page, study);
  std::string missing;
  try {
    add_charts(page, study);
  } catch (const InvalidInput& reason) {
    missing = reason.what();
    page.paragraph("No plots: " + missing);
  }
  add_cases(page, study);
  page.write(study.folder / "index.html");
  return missing;
}

}  // namespace aspic::cli
