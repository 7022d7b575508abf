#include "aspic/sweep/case_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "aspic/sweep/outcome.h"
#include "base/error.h"
#include "dynamics/step_fields.h"
#include "io/atomic_file.h"
#include "io/csv_reader.h"
#include "results/run_directory_layout.h"
#include "results/run_lock.h"
#include "scene/scene_builder.h"
#include "scene/scene_document.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

// Steps of a run that ended in a way that is no success.
struct BadSteps {
  int count = 0, first = 0, out_of_time = 0;
  std::string first_status;

  void add(int step, const std::string& status) {
    if (status == to_string(Status::budget)) ++out_of_time;
    if (status == to_string(Status::budget) || status == to_string(Status::converged) ||
        status == to_string(Status::round_off))
      return;
    if (count++ == 0) first = step, first_status = status;
  }
};

// Counts and names describe the work of a step; the other columns are its result.
bool is_result(const std::string& column) {
  if (column.starts_with("element_")) return false;
  for (const StepField& field : step_fields())
    if (field.name == column)
      return field.name == "contacts" || (field.type != StepFieldType::count && field.type != StepFieldType::name);
  return true;
}

double total_seconds(const fs::path& timings) {
  CsvReader table(timings);
  const size_t seconds = table.column("seconds");
  double sum = 0;
  while (table.next()) sum += table.number(seconds);
  return sum;
}

BadSteps read_steps(const RunLayout& layout, CaseResult& result) {
  CsvReader table(layout.steps());
  const size_t step = table.column("step"), status = table.column("status"), det_F = table.column("min_det_F");
  const size_t residual = table.column("residual"), threshold = table.column("residual_threshold");
  const size_t iterations = table.column("iterations");
  BadSteps bad;
  long total = 0;
  double worst = 0, least = std::numeric_limits<double>::infinity();
  std::vector<std::string> last;
  while (table.next()) {
    last.clear();
    for (size_t c = 0; c < table.columns().size(); ++c) last.push_back(table.text(c));
    least = std::min(least, table.number(det_F));
    if (table.integer(step) == 0) continue;
    result.steps = table.integer(step);
    total += table.integer(iterations);
    if (table.number(threshold) > 0) worst = std::max(worst, table.number(residual) / table.number(threshold));
    bad.add(result.steps, table.text(status));
  }
  result.values = {{"iterations", fmt::format("{}", total)},
                   {"worst_residual", fmt::format("{}", worst)},
                   {"least_det_F", fmt::format("{}", least)},
                   {"seconds", fmt::format("{:.6g}", total_seconds(layout.timings()))}};
  for (size_t c = 0; c < last.size(); ++c)
    if (is_result(table.columns()[c])) result.values.emplace_back(table.columns()[c], last[c]);
  return bad;
}

std::string after_colon(const std::string& outcome) {
  const size_t colon = outcome.find(": ");
  return colon == std::string::npos ? "" : outcome.substr(colon + 2);
}

// Sets state and reason of a run that did not end.
void judge_unfinished(const std::string& process, const std::string& outcome, CaseResult& result) {
  const std::string progress = result.all_steps > 0 ? fmt::format("after step {} of {}", result.steps, result.all_steps)
                                                    : "before its first step";
  if (!process.empty()) {
    result.state = CaseState::running;
    result.reason = fmt::format("{}, {}", process, progress);
  } else if (outcome.starts_with(kRunning) && outcome != running_here()) {
    result.state = CaseState::running;
    result.reason = fmt::format("{}, {}; killed if its job has ended", after_colon(outcome), progress);
  } else if (outcome.starts_with(kStopped)) {
    result.state = CaseState::stopped;
    result.reason = fmt::format("{} {}; run the jobs again", after_colon(outcome), progress);
  } else {
    result.state = CaseState::killed;
    result.reason = progress + "; run the jobs again";
  }
}

void judge_complete(const BadSteps& bad, CaseResult& result) {
  result.state = bad.count > 0 ? CaseState::unconverged : CaseState::done;
  if (bad.count > 0)
    result.reason = fmt::format("{} of {} steps did not converge, the first is step {} ({})", bad.count, result.steps,
                                bad.first, bad.first_status);
  else if (bad.out_of_time > 0)
    result.reason = fmt::format("{} steps ended by solver.time_budget", bad.out_of_time);
}

void read(const fs::path& run, CaseResult& result) {
  const RunLayout layout(run);
  const std::string process = RunLock::holder(run);  // first: without one, the outcome is final
  const std::string outcome = read_outcome(run);
  std::error_code error;
  BadSteps bad;
  if (layout.holds_run() && fs::exists(layout.scene(), error)) {
    const Table scene = read_scene_document(read_file(layout.scene()), layout.scene().string());
    result.all_steps = steps_of(*scene.find("time"));
    bad = read_steps(layout, result);
  }
  const bool is_at_end = result.all_steps > 0 && result.steps == result.all_steps;
  if (outcome.starts_with(kFailed)) {
    result.state = CaseState::failed;
    result.reason = after_colon(outcome);
  } else if (!is_at_end && (outcome.starts_with(kDone) || outcome.starts_with(kUnconverged))) {
    result.state = CaseState::failed;
    result.reason = fmt::format("its tables end after step {}; remove its folder and run the jobs again", result.steps);
  } else if (!is_at_end || outcome.starts_with(kRunning)) {
    judge_unfinished(process, outcome, result);
  } else {
    judge_complete(bad, result);
  }
}

}  // namespace

std::string to_string(CaseState state) {
  constexpr std::array kNames = {"failed", "unconverged", "killed", "stopped", "running", "not begun", "done"};
  return kNames[static_cast<size_t>(state)];
}

std::string CaseResult::value(const std::string& name) const {
  for (const auto& [key, text] : values)
    if (key == name) return text;
  return "";
}

CaseResult read_case(const fs::path& run) {
  CaseResult result;
  std::error_code error;
  if (!fs::exists(run, error) || fs::is_empty(run, error)) return result;
  try {
    read(run, result);
  } catch (const std::exception& unreadable) {
    result.state = CaseState::failed;
    result.reason = unreadable.what();
  }
  return result;
}

}  // namespace aspic::cli
