#include "viewer/run_tables.h"

#include <algorithm>
#include <map>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "base/number_chars.h"
#include "dynamics/step_fields.h"
#include "io/csv_reader.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPotential = "potential_", kTotal = "potential_total";

[[noreturn]] void fail_order(const fs::path& file, int step) {
  throw InvalidInput(file.string() + ": the row of step " + std::to_string(step) + " is out of order");
}

// Reads the names of pins from columns such as reaction_beam.wall_x. Earlier versions did not write them.
std::vector<std::string> pins_of(const CsvReader& table) {
  constexpr std::string_view kForce = "reaction_", kMoment = "reaction_moment_", kEnd = "_x";
  std::vector<std::string> pins;
  for (const std::string& name : table.columns()) {
    if (pins.size() == StepRow::kMaxReactions) break;
    if (!name.starts_with(kMoment) || !name.ends_with(kEnd)) continue;
    const std::string pin = name.substr(kMoment.size(), name.size() - kMoment.size() - kEnd.size());
    const auto has_all = [&](std::string_view kind) {
      return table.has(std::string(kind) + pin + "_x") && table.has(std::string(kind) + pin + "_y") &&
             table.has(std::string(kind) + pin + "_z");
    };
    if (has_all(kForce) && has_all(kMoment)) pins.push_back(pin);
  }
  return pins;
}

Vec3d vector_of(CsvReader& table, const std::string& name) {
  return {{table.number(table.column(name + "_x")), table.number(table.column(name + "_y")),
           table.number(table.column(name + "_z"))}};
}

StepValue value_of(const CsvReader& table, size_t column, StepFieldType type) {
  if (type == StepFieldType::count) return table.integer(column);
  if (type == StepFieldType::real) return table.number(column);
  return table.text(column);
}

// Reads the fields of a StepReport from their columns.
class StepReader {
 public:
  explicit StepReader(const CsvReader& table) : table_(table) {
    for (const StepField& field : step_fields()) {
      if (!field.is_in(StepOutput::table) || !field.set) continue;
      if (field.is_optional && !table.has(field.name)) continue;
      columns_.emplace_back(&field, table.column(field.name));
    }
  }

  void read(StepReport& report) const {
    for (const auto& [field, column] : columns_)
      if (!field->set(report, value_of(table_, column, field->type)))
        throw InvalidInput(table_.where() + ": unknown " + std::string(field->name) + " '" + table_.text(column) +
                           "'; was the run written by another version?");
  }

 private:
  const CsvReader& table_;
  std::vector<std::pair<const StepField*, size_t>> columns_;
};

std::vector<StepRow> read_steps(const fs::path& file, int last_step, std::vector<std::string>& potentials) {
  CsvReader table(file);
  std::vector<size_t> potential_columns;
  for (size_t i = 0; i < table.columns().size(); ++i) {
    const std::string& name = table.columns()[i];
    if (!name.starts_with(kPotential) || name == kTotal) continue;
    potentials.push_back(name.substr(kPotential.size()));
    potential_columns.push_back(i);
  }
  const std::vector<std::string> pins = pins_of(table);
  const StepReader reader(table);
  const size_t step = table.column("step");
  std::vector<StepRow> steps;
  while (static_cast<int>(steps.size()) < last_step && table.next()) {
    if (table.integer(step) == 0) continue;  // the start, which earlier versions did not write
    StepRow& row = steps.emplace_back();
    StepReport& report = row.report;
    reader.read(report);
    if (report.step != static_cast<int>(steps.size())) fail_order(file, report.step);
    row.pin_work = report.pin_work;
    row.load_work = report.load_work;
    for (const size_t column : potential_columns) report.potential.push_back(table.number(column));
    row.pins = pins;
    for (const std::string& pin : pins)
      report.resultants.pins.push_back(
          {vector_of(table, "reaction_" + pin), vector_of(table, "reaction_moment_" + pin)});
  }
  if (static_cast<int>(steps.size()) < last_step)
    throw InvalidInput(file.string() + ": ends at step " + std::to_string(steps.size()) +
                       ", before the checkpoint at step " + std::to_string(last_step) + "; the file is damaged");
  return steps;
}

void read_iterations(const fs::path& file, std::vector<StepRow>& steps) {
  CsvReader table(file);
  const size_t step = table.column("step"), index = table.column("iteration"), value = table.column("value"),
               gradient_norm = table.column("gradient_norm"), decrement = table.column("decrement"),
               alpha = table.column("alpha"), trials = table.column("trials"),
               projected_elements = table.column("projected_elements"),
               linear_iterations = table.column("linear_iterations");
  int last = 1;
  while (table.next()) {
    const int at = table.integer(step);
    if (at < last) fail_order(file, at);
    if (at > static_cast<int>(steps.size())) break;
    last = at;
    Iteration& iteration = steps[static_cast<size_t>(at) - 1].iterations.emplace_back().iteration;
    iteration.index = table.integer(index);
    iteration.value = table.number(value);
    iteration.gradient_norm = table.number(gradient_norm);
    iteration.decrement = table.number(decrement);
    iteration.alpha = table.number(alpha);
    iteration.trials = table.integer(trials);
    iteration.direction.projected_elements = table.integer(projected_elements);
    iteration.direction.linear_iterations = table.integer(linear_iterations);
  }
}

// A folder written by a trace that began after a step.
struct TraceFolder {
  fs::path path;
  int after = 0;
};

std::vector<TraceFolder> trace_folders(const RunLayout& layout) {
  constexpr std::string_view kAfter = "trace_after_";
  std::error_code error;
  std::vector<TraceFolder> folders;
  for (fs::directory_iterator entry(layout.root(), error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    int after = 0;
    if (name.starts_with(kAfter)) from_chars(name.data() + kAfter.size(), name.data() + name.size(), after);
    if (fs::is_regular_file(layout.trace(after) / "trials.csv", error) && layout.trace(after).filename() == name)
      folders.push_back({entry->path(), after});
  }
  std::sort(folders.begin(), folders.end(), [](const auto& a, const auto& b) { return a.after < b.after; });
  return folders;
}

// Finds the iteration of a row of a trace. Each minimization of a step counts from 0.
class IterationFinder {
 public:
  explicit IterationFinder(const StepRow& step) {
    int solve = 0;
    for (size_t i = 0; i < step.iterations.size(); ++i) {
      if (step.iterations[i].iteration.index == 0) ++solve;
      place_[{solve, step.iterations[i].iteration.index}] = i;
    }
  }
  std::optional<size_t> find(int solve, int iteration) const {
    const auto found = place_.find({solve, iteration});
    return found == place_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<std::pair<int, int>, size_t> place_;
};

// Reads the trials of the steps after `first` up to `last`.
void read_trials(const fs::path& file, std::vector<StepRow>& steps, int first, int last) {
  CsvReader table(file);
  const size_t step = table.column("step"), solve = table.column("solve"), iteration = table.column("iteration"),
               alpha = table.column("alpha"), value = table.column("value"), bound = table.column("bound"),
               by_slope = table.column("by_slope"), accepted = table.column("accepted");
  std::optional<IterationFinder> finder;
  int known = 0;
  while (table.next()) {
    const int at = table.integer(step);
    if (at <= first || at > last) continue;
    StepRow& row = steps[static_cast<size_t>(at) - 1];
    if (at != known) finder.emplace(row), known = at;
    const std::optional<size_t> place = finder->find(table.integer(solve), table.integer(iteration));
    if (!place)
      throw InvalidInput(file.string() + ": step " + std::to_string(at) +
                         " has no such iteration in iterations.csv; the trace is of another run, or damaged");
    row.iterations[*place].tried.push_back({table.number(alpha), table.number(value), table.number(bound),
                                            table.integer(by_slope) != 0, table.integer(accepted) != 0});
  }
}

}  // namespace

RunTables read_run_tables(const RunLayout& layout, int last_step) {
  RunTables tables;
  tables.steps = read_steps(layout.steps(), last_step, tables.potentials);
  read_iterations(layout.iterations(), tables.steps);
  const std::vector<TraceFolder> folders = trace_folders(layout);
  for (size_t i = 0; i < folders.size(); ++i) {
    const int last = i + 1 < folders.size() ? std::min(folders[i + 1].after, last_step) : last_step;
    read_trials(folders[i].path / "trials.csv", tables.steps, folders[i].after, last);
  }
  return tables;
}

}  // namespace aspic::viewer
