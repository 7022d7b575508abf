#include "commands/fit_check.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "aspic/plot.h"
#include "base/error.h"
#include "commands/commands.h"
#include "commands/fit_summary.h"
#include "data/case_table.h"
#include "data/data_set.h"
#include "data/surface_projection.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxSeries = 12;    // limit per chart
constexpr size_t kMaxPoints = 1000;  // limit per series

std::string_view word(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

// Returns the cases of each group in the order of the data.
std::vector<std::vector<const LoadCase*>> cases_by_group(const Experiment& experiment) {
  std::vector<std::vector<const LoadCase*>> groups;
  for (const LoadCase& load : experiment.cases) {
    if (groups.empty() || groups.back().front()->group != load.group) groups.emplace_back();
    groups.back().push_back(&load);
  }
  return groups;
}

Chart force_against_depth(const Experiment& experiment) {
  Chart chart{"Force over depth", {"depth [mm]"}, {"force [N]"}, {}};
  for (const auto& group : cases_by_group(experiment)) {
    Series series{group.front()->group, {0}, {0}, SeriesStyle::line_and_points};
    for (const LoadCase* load : group) {
      if ((!load->indenter && !load->grip) || !load->force) continue;
      series.x.push_back(1e3 * load_size(*load));
      series.y.push_back(norm(*load->force));
    }
    if (series.x.size() > 1 && chart.series.size() < kMaxSeries) chart.series.push_back(std::move(series));
  }
  return chart;
}

// Uses the case with the largest load of each group.
Chart motion_against_distance(const Experiment& experiment) {
  Chart chart{"Motion of the markers", {"distance from the touch at rest [mm]"}, {"motion [mm]"}, {}};
  for (const auto& group : cases_by_group(experiment)) {
    const LoadCase& load = *group.back();
    if (load.positions.empty() || chart.series.size() == kMaxSeries) continue;
    Series series{load.name, {}, {}, SeriesStyle::points};
    const size_t stride = (load.positions.size() + kMaxPoints - 1) / kMaxPoints;
    for (size_t i = 0; i < load.positions.size(); i += stride) {
      const MarkerReading& reading = load.positions[i];
      const Vec3d X = position(experiment.markers[reading.marker], experiment.mesh.rest);
      series.x.push_back(1e3 * norm(X - (load.grip ? load.grip->center : load.touch.center)));
      series.y.push_back(1e3 * norm(reading.position - X));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

// Charts are optional: without gnuplot the check continues.
void draw_charts(const DataSet& data, const fs::path& folder, std::FILE* human) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InvalidInput(fmt::format("{}: cannot be created ({})", folder.string(), error.message()));
  const std::pair<const char*, Chart> charts[] = {{"force_depth.svg", force_against_depth(data.experiment)},
                                                  {"motion.svg", motion_against_distance(data.experiment)}};
  for (const auto& [name, chart] : charts) {
    if (chart.series.empty()) continue;
    try {
      draw(folder / name, chart);
      fmt::print(human, "chart: {}\n", (folder / name).string());
    } catch (const InvalidInput& e) {
      fmt::print(human, "no chart {}: {}\n", name, e.what());
    }
  }
}

// Number of fixed vertices, without mid-edge nodes.
int fixed_corners(const Experiment& experiment) {
  std::set<int> corners;
  for (const Tet& tet : experiment.mesh.tets) corners.insert(tet.begin(), tet.end());
  return static_cast<int>(
      std::count_if(experiment.fixed.begin(), experiment.fixed.end(), [&](int v) { return corners.contains(v); }));
}

void print_content(const DataSet& data) {
  const Experiment& e = data.experiment;
  size_t positions = 0, forces = 0, torques = 0;
  for (const LoadCase& load : e.cases) {
    positions += load.positions.size();
    forces += load.force.has_value(), torques += load.torque.has_value();
  }
  fmt::print("{}: {}, {} vertices fixed; {} markers; {} cases in {} groups with {} positions, {} forces{}\n", data.name,
             mesh_text(e.mesh), fixed_corners(e), e.markers.size(), e.cases.size(), cases_by_group(e).size(), positions,
             forces, torques > 0 ? fmt::format(", {} torques", torques) : "");
  for (const std::string& note : data.notes) fmt::print("note: {}\n", note);
}

void print(const std::vector<DataFinding>& findings) {
  for (const DataFinding& f : findings)
    fmt::print("{}: {}: {}\n  remedy: {}\n", word(f.severity), f.where, f.what, f.remedy);
  if (findings.empty()) fmt::print("no suspicious values\n");
}

void print_json(const DataSet& data, const std::vector<DataFinding>& findings) {
  nlohmann::json list = nlohmann::json::array();
  for (const DataFinding& f : findings)
    list.push_back({{"severity", word(f.severity)}, {"where", f.where}, {"what", f.what}, {"remedy", f.remedy}});
  const auto replace = nlohmann::json::error_handler_t::replace;
  fmt::print("{}\n", nlohmann::json{{"name", data.name}, {"notes", data.notes}, {"findings", list}}.dump(2, ' ', false,
                                                                                                         replace));
}

}  // namespace

int check_data(const fs::path& path, const CheckDataOptions& options) {
  const DataSet data = read_data_set(path, options.registers);
  const std::vector<DataFinding> findings = diagnose(data);
  if (options.json) {
    print_json(data, findings);
  } else {
    print_content(data);
    print(findings);
  }
  const fs::path folder = fs::is_directory(path) ? path : path.parent_path();
  draw_charts(data, options.charts.empty() ? folder / "check" : options.charts, options.json ? stderr : stdout);
  const bool has_error =
      std::any_of(findings.begin(), findings.end(), [](const DataFinding& f) { return f.severity == Severity::error; });
  return has_error ? exit_bad_input : exit_done;
}

void add_check_data(CLI::App& app, Action& action) {
  struct Arguments {
    fs::path data;
    std::string registers;  // empty: none
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("check", "Reports errors and suspicious values of a data set");
  command->add_option("DATA", arguments->data, "Folder of a data set")->required();
  command->add_option("--register", arguments->registers, "Align markers or scan: rigid or similarity")
      ->check(CLI::IsMember({"rigid", "similarity"}));
  command->add_flag("--json", arguments->json, "Print findings as JSON");
  command->callback([arguments, &action] {
    action = [arguments] {
      CheckDataOptions options{.charts = {}, .json = arguments->json};
      if (!arguments->registers.empty())
        options.registers = arguments->registers == "rigid" ? RegistrationKind::rigid : RegistrationKind::similarity;
      return check_data(arguments->data, options);
    };
  });
}

}  // namespace aspic::cli
