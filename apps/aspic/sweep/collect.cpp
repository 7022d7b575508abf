// Collects the runs of a study in one table.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "aspic/sweep/sweep.h"
#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "io/csv_reader.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr size_t kShown = 10;  // failures on the terminal

StudyResults read_results(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / "cases.csv", error))
    throw InvalidInput(folder.string() + ": contains no study (cases.csv is missing); aspic sweep STUDY.toml -o " +
                       folder.string() + " writes one");
  StudyResults study{folder, {}, {}, {}};
  CsvReader table(folder / "cases.csv");
  if (table.column("case") != 0)
    throw InvalidInput((folder / "cases.csv").string() + ":1: begins with the column case");
  study.keys.assign(table.columns().begin() + 1, table.columns().end());
  while (table.next()) {
    const size_t index = study.cases.size();
    if (table.text(0) != case_name(index))
      throw InvalidInput(table.where() + ": case = " + shown(table.text(0)) + "; expected " + case_name(index) +
                         " (aspic sweep writes this table)");
    std::vector<std::string>& values = study.cases.emplace_back();
    for (size_t k = 0; k < study.keys.size(); ++k) values.push_back(table.text(k + 1));
    study.results.push_back(read_case(case_folder(folder, index)));
  }
  return study;
}

// The columns of all cases: runs differ, for example, in whether they have contact.
std::vector<std::string> value_columns(const StudyResults& study) {
  std::vector<std::string> columns;
  for (const CaseResult& result : study.results)
    for (const auto& [name, _] : result.values)
      if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
  return columns;
}

std::string results_table(const StudyResults& study) {
  const std::vector<std::string> columns = value_columns(study);
  CsvRow header;
  header.add("case");
  for (const std::string& key : study.keys) header.add(key);
  header.add("status").add("reason").add("steps");
  for (const std::string& column : columns) header.add(column);
  std::string text = header.text() + "\n";
  for (size_t i = 0; i < study.cases.size(); ++i) {
    const CaseResult& result = study.results[i];
    CsvRow row;
    row.add(case_name(i));
    for (const std::string& value : study.cases[i]) row.add(value);
    row.add(to_string(result.state)).add(result.reason).add(result.steps);
    for (const std::string& column : columns) row.add(result.value(column));
    text += row.text() + "\n";
  }
  return text;
}

void print_states(const StudyResults& study) {
  std::array<int, kCaseStates> counts{};
  for (const CaseResult& result : study.results) ++counts[static_cast<size_t>(result.state)];
  std::string line;
  for (int state = kCaseStates - 1; state >= 0; --state)
    if (counts[state] > 0)
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", counts[state], to_string(static_cast<CaseState>(state)));
  fmt::print("cases      {}\n", line);
  size_t shown_cases = 0, failures = 0;
  for (size_t i = 0; i < study.results.size(); ++i) {
    const CaseResult& result = study.results[i];
    if (result.state == CaseState::done || result.state == CaseState::not_begun) continue;
    ++failures;
    if (shown_cases < kShown) fmt::print("  {} {}: {}\n", case_name(i), to_string(result.state), result.reason);
    ++shown_cases;
  }
  if (failures > kShown) fmt::print("  ... and {} more\n", failures - kShown);
}

}  // namespace

ExitCode collect_study(const fs::path& folder) {
  const StudyResults study = read_results(folder);
  write_file(folder / "results.csv", results_table(study));
  const std::string missing = write_study_page(study);
  print_states(study);
  fmt::print("results    {}\n           browser: open {}\n", (folder / "results.csv").string(),
             (folder / "index.html").string());
  if (!missing.empty()) fmt::print(stderr, "note: no plots: {}\n", missing);
  const auto is_done = [](const CaseResult& result) { return result.state == CaseState::done; };
  return std::all_of(study.results.begin(), study.results.end(), is_done) ? exit_done : exit_unconverged;
}

}  // namespace aspic::cli
