// `aspic verify`: solves problems with known answers.
#include "aspic/verify.h"
#include "aspic/method_text.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <system_error>

#include "aspic/commands.h"
#include "aspic/progress.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "dynamics/simulation.h"
#include "material/registry.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct VerifyArguments {
  std::vector<std::string> only, instead;
  fs::path out = fs::path("out") / "verify";
  bool list = false, quick = false;
  int threads = 0;
};

// The full name of a check selects only that check.
bool is_meant(const verify::Check& check, const std::string& word) {
  const auto& all = verify::checks();
  if (std::any_of(all.begin(), all.end(), [&](const verify::Check& c) { return c.key() == word; }))
    return check.key() == word;
  return check.key().find(word) != std::string::npos || check.title.find(word) != std::string::npos;
}

std::vector<const verify::Check*> chosen(const std::vector<std::string>& words) {
  std::vector<const verify::Check*> found;
  for (const verify::Check& check : verify::checks())
    if (words.empty() || std::any_of(words.begin(), words.end(), [&](const auto& w) { return is_meant(check, w); }))
      found.push_back(&check);
  if (found.empty()) throw InvalidInput(fmt::format("no check matches '{}'; see --list", words.front()));
  return found;
}

// Replaces a material by a material, or an integrator by an integrator.
void add_replacement(const std::string& text, verify::Subject& subject) {
  const size_t at = text.find('=');
  const std::string name = text.substr(0, at), other = at == std::string::npos ? "" : text.substr(at + 1);
  std::vector<std::string> material_names;
  for (const MaterialInfo& info : materials()) material_names.push_back(info.name);
  for (const auto& list : {material_names, integrator_names()})
    if (contains(list, name) && contains(list, other)) {
      subject.instead[name] = other;
      return;
    }
  throw InvalidInput(
      fmt::format("--instead {}: give two materials or two integrators, for example "
                  "bdf2=backward_euler",
                  text));
}

int run(const VerifyArguments& arguments) {
  const auto checks = chosen(arguments.only);
  if (arguments.list) {
    print_list(checks);
    return exit_done;
  }
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  verify::Subject subject{.quick = arguments.quick, .instead = {}};
  for (const std::string& text : arguments.instead) add_replacement(text, subject);
  return verify_all(checks, subject, arguments.out);
}

}  // namespace

void print_list(const std::vector<const verify::Check*>& checks) {
  for (const verify::Check* check : checks) fmt::print("{:<34} {}\n", check->key(), check->title);
}

void print_head(const verify::Check& check, size_t number, size_t count) {
  fmt::print("\n[{}/{}] {}: {}\n", number, count, check.key(), check.title);
  std::fflush(stdout);
}

std::string value_text(double value, const verify::Row& row) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  if (row.reference == 0 || !(row.tolerance > 0)) return fmt::format("{:.3g}", value);
  const double digits = std::log10(std::abs(row.reference) / row.tolerance);
  return fmt::format("{:#.{}g}", value, std::clamp(static_cast<int>(std::ceil(digits)) + 2, 3, 15));
}

std::string tolerance_text(const verify::Row& row) {
  return fmt::format("{} {:.2g}{}{}", "+-", row.tolerance, row.unit.empty() ? "" : " ", row.unit);
}

// Prints the reason above the rows that share it.
void print_rows(const Verification& result) {
  size_t width = 0;
  for (const verify::Row& row : result.findings.rows) width = std::max(width, row.quantity.size());
  std::string reason;
  for (const verify::Row& row : result.findings.rows) {
    if (row.reason != reason) fmt::print("      ({})\n", row.reason);
    reason = row.reason;
    fmt::print("{}  {:<{}}  {:>14}  {:>14}  {}\n", row.passes() ? "pass" : "FAIL", row.quantity, width,
               value_text(row.measured, row), value_text(row.reference, row), tolerance_text(row));
  }
  fmt::print("      {:.1f} s\n", result.seconds);
  std::fflush(stdout);
}

std::string how_text(const verify::Subject& subject, bool all, double seconds) {
  std::string text = all ? "All checks" : "Selected checks";
  text += subject.quick ? ", the coarse cases (--quick)" : "";
  for (const auto& [name, other] : subject.instead) text += fmt::format(", {} in place of {}", other, name);
  return text + fmt::format(", in {}.", duration_text(seconds));
}

std::string count_text(const std::vector<Verification>& results) {
  size_t rows = 0, failed = 0;
  for (const Verification& result : results) {
    rows += result.findings.rows.size();
    for (const verify::Row& row : result.findings.rows) failed += row.passes() ? 0 : 1;
  }
  return fmt::format("{} check{}, {} rows: {}", results.size(), results.size() == 1 ? "" : "s", rows,
                     failed == 0 ? "all pass" : fmt::format("{} FAIL", failed));
}

int verify_all(const std::vector<const verify::Check*>& checks, const verify::Subject& subject,
               const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InvalidInput(folder.string() + ": cannot be created: " + error.message());
  std::vector<Verification> results;
  Stopwatch whole;
  for (const verify::Check* check : checks) {
    print_head(*check, results.size() + 1, checks.size());
    Stopwatch stopwatch;
    verify::Findings findings = verify::run_check(*check, subject);
    results.push_back({check, std::move(findings), stopwatch.lap()});
    print_rows(results.back());
  }
  write_verification(folder, results, how_text(subject, checks.size() == verify::checks().size(), whole.lap()));
  fmt::print("\n{}\n{}\n", count_text(results), (folder / "index.html").string());
  const auto passes = [](const Verification& result) { return result.findings.passes(); };
  return std::all_of(results.begin(), results.end(), passes) ? exit_done : exit_unconverged;
}

void add_verify(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<VerifyArguments>();
  CLI::App* command = app.add_subcommand("verify", "Solves problems with known answers and checks the errors");
  command->footer(R"(
Examples:
  aspic verify                                all checks: minutes; results in out/verify/index.html
  aspic verify --quick                        fewer and coarser cases: seconds
  aspic verify --list                         the checks
  aspic verify --only orders --only cook      checks with one of these words in name or title
  aspic verify --quick --instead bdf2=backward_euler   fails

Exit codes: 0 all rows pass, 2 bad input, 3 a row fails or cannot be computed.)");
  command
      ->add_option("--only", arguments->only,
                   "Check of this name, or checks with this word in name or title; can be repeated")
      ->type_name("WORD");
  command->add_flag("--list", arguments->list, "List the checks without running them");
  command->add_flag("--quick", arguments->quick, "Run fewer and coarser cases: seconds instead of minutes");
  command
      ->add_option("--instead", arguments->instead, "Replace a material or integrator by another, to see checks fail")
      ->type_name("NAME=OTHER");
  command->add_option("--out", arguments->out, "Folder for the page and the JSON file")->capture_default_str();
  command->add_option("--threads", arguments->threads, "Threads; all cores by default; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace aspic::cli
