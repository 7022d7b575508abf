#include "aspic/comparison_files.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "aspic/plot.h"
#include "aspic/report_page.h"
#include "base/error.h"
#include "io/atomic_file.h"
#include "io/csv.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

void write_methods(const fs::path& path, const Comparison& comparison) {
  CsvFile file = CsvFile::create(
      path, {"method", "status", "same_minimizer", "iterations", "gradients", "hessians", "factorizations",
             "linear_iterations", "trials", "seconds", "objective", "excess", "gradient_norm", "distance"});
  for (const MethodResult& result : comparison.results) {
    const StepReport& report = result.report;
    CsvRow row;
    row.add(result.method).add(to_string(report.status)).add(result.same_minimizer ? 1 : 0);
    row.add(report.iterations).add(report.gradients).add(report.hessians).add(report.factorizations);
    row.add(report.linear_iterations).add(report.trials).add(result.seconds).add(report.objective);
    file.append(row.add(result.excess).add(report.objective_gradient).add(result.distance));
  }
  file.close();
}

void write_work(const fs::path& path, const Comparison& comparison) {
  CsvFile file = CsvFile::create(
      path, {"method", "iteration", "gradients", "hessians", "seconds", "value", "excess", "gradient_norm"});
  for (const MethodResult& result : comparison.results)
    for (const WorkPoint& point : result.work) {
      CsvRow row;
      row.add(result.method).add(point.iteration).add(point.gradients).add(point.hessians).add(point.seconds);
      file.append(row.add(point.value).add(point.value - comparison.reference.objective).add(point.gradient_norm));
    }
  file.close();
}

nlohmann::ordered_json json_of(const MethodResult& result) {
  return {{"method", result.method},
          {"description", result.description},
          {"status", to_string(result.report.status)},
          {"same_minimizer", result.same_minimizer},
          {"iterations", result.report.iterations},
          {"gradients", result.report.gradients},
          {"hessians", result.report.hessians},
          {"factorizations", result.report.factorizations},
          {"linear_iterations", result.report.linear_iterations},
          {"trials", result.report.trials},
          {"seconds", result.seconds},
          {"objective", result.report.objective},
          {"excess", result.excess},
          {"gradient_norm", result.report.objective_gradient},
          {"distance", result.distance}};
}

void write_json(const fs::path& path, const std::string& scene, const Comparison& comparison) {
  nlohmann::ordered_json results = nlohmann::json::array();
  for (const MethodResult& result : comparison.results) results.push_back(json_of(result));
  const nlohmann::ordered_json json = {{"scene", scene},
                                       {"step", comparison.step},
                                       {"reference",
                                        {{"objective", comparison.reference.objective},
                                         {"gradient_norm", comparison.reference.objective_gradient},
                                         {"iterations", comparison.reference.iterations}}},
                                       {"methods", results}};
  write_file(path, json.dump(2) + "\n");
}

enum class Work { iterations, seconds };

// Distance of E from its minimum, down to the round-off floor of E.
Chart precision_chart(const Comparison& comparison, Work work) {
  const bool is_time = work == Work::seconds;
  Chart chart;
  chart.title = is_time ? "Accuracy over time" : "Accuracy over iterations";
  chart.x = {.label = is_time ? "time [s]" : "iteration (from 1)", .scale = AxisScale::logarithmic};
  chart.y = {.label = "E - E* [relative to the start]", .scale = AxisScale::logarithmic};
  const double end = comparison.reference.objective;
  for (const MethodResult& result : comparison.results) {
    if (result.work.empty()) continue;
    const double start = result.work.front().value - end;
    const double noise = std::numeric_limits<double>::epsilon() * std::abs(end);
    Series series{.label = result.method, .style = SeriesStyle::line_and_points};
    for (const WorkPoint& point : result.work) {
      if (point.iteration == 0) continue;  // zero has no place on a logarithmic axis
      series.x.push_back(is_time ? point.seconds : point.iteration);
      series.y.push_back(std::max(point.value - end, noise) / start);
    }
    if (series.x.size() > 60) series.style = SeriesStyle::line;
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::vector<Cell> row_of(const MethodResult& result) {
  const Verdict verdict = result.same_minimizer ? Verdict::pass : Verdict::fail;
  const StepReport& report = result.report;
  return {{result.method},
          {std::string(is_success(report.status) ? "same minimizer" : to_string(report.status)), verdict},
          {std::to_string(report.iterations)},
          {std::to_string(report.gradients)},
          {std::to_string(report.hessians)},
          {fmt::format("{:.3g}", 1e3 * result.seconds)},
          {fmt::format("{:.2e}", result.excess)},
          {fmt::format("{:.2e}", report.objective_gradient)},
          {fmt::format("{:.2e}", result.distance)}};
}

void write_page(const fs::path& folder, const std::string& scene, const Comparison& comparison, bool has_pictures) {
  ReportPage page("Methods compared", fmt::format("{}, step {}", scene, comparison.step));
  page.paragraph(
      "Every method solves the same time step from the same state. The reference is Newton's method at the limit of "
      "double precision, E* its objective. The excess of E is E - E*, relative to the start.");
  std::vector<std::vector<Cell>> rows;
  for (const MethodResult& result : comparison.results) rows.push_back(row_of(result));
  page.table(
      {"method", "reached", "iterations", "gradients", "Hessians", "time [ms]", "excess of E", "|g|", "distance [m]"},
      rows);
  if (has_pictures)
    page.figures({{folder / "time.svg", "Distance of E from its minimum over time."},
                  {folder / "iterations.svg", "The same over iterations."}});
  page.heading("Settings");
  for (const MethodResult& result : comparison.results) page.paragraph(result.method + ": " + result.description);
  page.write(folder / "index.html");
}

}  // namespace

std::string write_comparison(const fs::path& folder, const std::string& scene, const Comparison& comparison) {
  write_methods(folder / "methods.csv", comparison);
  write_work(folder / "work.csv", comparison);
  write_json(folder / "comparison.json", scene, comparison);
  std::string missing;
  try {
    draw(folder / "time.svg", precision_chart(comparison, Work::seconds));
    draw(folder / "iterations.svg", precision_chart(comparison, Work::iterations));
  } catch (const InvalidInput& reason) {
    missing = reason.what();
  }
  write_page(folder, scene, comparison, missing.empty());
  return missing;
}

}  // namespace aspic::cli
