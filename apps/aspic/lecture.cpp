// `aspic lecture`: demonstrations of the lecture's pages with measured checks.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "aspic/commands.h"
#include "aspic/interrupt.h"
#include "aspic/lecture/course.h"
#include "aspic/lecture/result_json.h"
#include "aspic/lecture/results.h"
#include "base/error.h"
#include "base/number_chars.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "io/atomic_file.h"

namespace aspic::cli {
namespace lecture {
namespace {

namespace fs = std::filesystem;

struct LectureArguments {
  std::string page;
  fs::path mesh, out = fs::path("out") / "lecture";
  int threads = 0;
};

void list_pages() {
  for (int page = 1; page <= kPages; ++page) {
    std::string titles;
    for (const Demonstration* d : demonstrations_of(page)) titles += (titles.empty() ? "" : "; ") + d->title;
    const std::string reason = reason_for_none(page);
    if (!reason.empty()) titles = fmt::format("(nothing: {})", reason);
    fmt::print("{:>2}  {}\n", page, titles);
  }
}

int parse_page(const std::string& text) {
  int page = 0;
  const auto [end, error] = from_chars(text.data(), text.data() + text.size(), page);
  if (error != std::errc() || end != text.data() + text.size() || page < 1 || page > kPages)
    throw InvalidInput(fmt::format("'{}' is not a page of the lecture; give 1 to {}, or 'all'", text, kPages));
  return page;
}

// Returns the exit code if Ctrl-C interrupted the drawing.
std::optional<int> draw_meshes(std::vector<Result>& results) {
  std::vector<Sheet*> sheets;
  for (Result& result : results) sheets.push_back(&result.sheet);
  catch_interrupts();
  if (Sheet::draw_meshes(sheets, StopToken([] { return interrupt_signal() != 0; }))) return std::nullopt;
  return exit_signal + interrupt_signal();
}

Result run_one(const Demonstration& demonstration, const Stage& stage, const fs::path& out) {
  Stopwatch stopwatch;
  Sheet sheet(out / demonstration.key);
  run_demonstration(demonstration, stage, sheet);
  return {&demonstration, std::move(sheet), stopwatch.lap()};
}

int run_page(int page, const LectureArguments& arguments) {
  if (const std::string reason = reason_for_none(page); !reason.empty()) {
    fmt::print("page {}: nothing to check: {}\n", page, reason);
    return exit_done;
  }
  const Stage stage(arguments.mesh, arguments.out / "meshes");
  fmt::print("{}\n", stage.mesh_note());
  std::fflush(stdout);
  std::vector<Result> results;
  for (const Demonstration* demonstration : demonstrations_of(page))
    results.push_back(run_one(*demonstration, stage, arguments.out));
  if (const auto stopped = draw_meshes(results)) return *stopped;
  bool passes = true;
  for (const Result& result : results) {
    write_file(result.sheet.folder() / "result.json", to_json(result).dump(2) + "\n");
    print(result);
    const fs::path file = result.sheet.folder() / "index.html";
    write_page(file, stage.mesh_note(), result);
    fmt::print("browser: open {}\n", file.string());
    passes = passes && result.sheet.passes();
  }
  return passes ? exit_done : exit_unconverged;
}

int run_all(const LectureArguments& arguments) {
  const Stage stage(arguments.mesh, arguments.out / "meshes");
  fmt::print("{}\n", stage.mesh_note());
  std::vector<Result> results;
  bool passes = true;
  for (const Demonstration& demonstration : demonstrations()) {
    const std::string head =
        fmt::format("[{:>2}/{}] {:<30}", results.size() + 1, demonstrations().size(), demonstration.key);
    fmt::print("{} ...", head);
    std::fflush(stdout);
    const Result& result = results.emplace_back(run_one(demonstration, stage, arguments.out));
    passes = passes && result.sheet.passes();
    fmt::print(" {} ({:.1f} s)\n", result.sheet.passes() ? "pass" : "FAIL", result.seconds);
  }
  fmt::print("pictures of meshes             ...");
  std::fflush(stdout);
  Stopwatch stopwatch;
  if (const auto stopped = draw_meshes(results)) return *stopped;
  fmt::print(" done ({:.1f} s)\n", stopwatch.lap());
  for (const Result& result : results)
    if (!result.sheet.passes()) print(result);
  write_summary(arguments.out, stage.mesh_note(), results);
  fmt::print("{}\n{}\n", count_text(results), (arguments.out / "index.html").string());
  return passes ? exit_done : exit_unconverged;
}

int run(const LectureArguments& arguments) {
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  if (arguments.page.empty()) {
    list_pages();
    return exit_done;
  }
  return arguments.page == "all" ? run_all(arguments) : run_page(parse_page(arguments.page), arguments);
}

}  // namespace
}  // namespace lecture

void add_lecture(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<lecture::LectureArguments>();
  CLI::App* command = app.add_subcommand("lecture", "Demonstrates the pages of the lecture with measured checks");
  command->footer(R"(
Examples:
  aspic lecture                       list of the 62 pages
  aspic lecture 53                    claim of page 53, measurement, pass or fail, as text and as a web page
  aspic lecture all                   all pages; results in out/lecture/index.html
  aspic lecture 33 --mesh bunny.mesh  on another mesh of tets or closed surface

Exit codes: 0 all checks pass or a page has none, 2 no such page, one that
is not available, or bad input, 3 a check fails.)");
  command->add_option("PAGE", arguments->page, "Page, 1 to 62, or 'all'; without it, the list of pages");
  command->add_option("--mesh", arguments->mesh, "Tet mesh or closed surface for the demonstrations on a real mesh")
      ->check(CLI::ExistingFile);
  command->add_option("--out", arguments->out, "Folder for data, pictures and summary")->capture_default_str();
  command->add_option("--threads", arguments->threads, "Threads; all cores by default; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  command->callback([arguments, &action] { action = [arguments] { return lecture::run(*arguments); }; });
}

}  // namespace aspic::cli
