// `aspic sweep`: writes the cases of a study as a list of shell commands, and collects their results.
#include "aspic/sweep/sweep.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <sstream>

#include "aspic/job_list.h"
#include "aspic/sweep/study.h"
#include "base/error.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "io/csv.h"
#include "scene/scene.h"
#include "scene/scene_document.h"
#include "scene/toml_reader.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct SweepArguments {
  fs::path study, out, collected;
  std::string program = "aspic";
};

// Overrides that turn off what the scene writes besides its tables.
std::vector<std::string> tables_only(const fs::path& scene) {
  const Table document = read_scene_document(read_toml_text(scene), scene.string());
  std::vector<std::string> overrides;
  for (const char* format : {"vtu", "obj", "ply", "pc2", "usd", "report"})
    if ((*document.find("output"))[format].boolean()) overrides.push_back(fmt::format("output.{}=false", format));
  return overrides;
}

struct StudyFiles {
  std::string cases, jobs;
  std::string scene;  // resolved scene of the first case; it changes with the scene of the study and its meshes
};

std::string cases_table(const Study& study) {
  CsvRow header;
  header.add("case");
  for (const std::string& key : study.keys) header.add(key);
  std::string text = header.text() + "\n";
  for (size_t i = 0; i < study.cases.size(); ++i) {
    CsvRow row;
    row.add(case_name(i));
    for (const std::string& value : study.cases[i]) row.add(value);
    text += row.text() + "\n";
  }
  return text;
}

StudyFiles make_files(const SweepArguments& arguments, const Study& study) {
  StudyFiles files{cases_table(study), "", ""};
  const std::vector<std::string> formats = study.frames ? std::vector<std::string>() : tables_only(study.scene);
  for (size_t i = 0; i < study.cases.size(); ++i) {
    std::vector<std::string> overrides = formats;
    for (const std::string& text : study.overrides(i)) overrides.push_back(text);
    files.jobs += fmt::format("{} run {}", arguments.program, shell_word(study.scene));
    for (const std::string& text : overrides) files.jobs += " --set " + shell_word(text);
    files.jobs += fmt::format(" --threads {} --out {} --continue --quiet\n", study.threads,
                              shell_word(case_folder(arguments.out, i)));
    if (i == 0) files.scene = load_scene(study.scene, {.overrides = overrides}).resolved;
  }
  return files;
}

// "study/cases.csv:2: '...' before, '...' now"; empty if nothing changed.
std::string change(const fs::path& file, const std::string& now) {
  std::istringstream old_lines(read_file(file)), new_lines(now);
  for (int line = 1;; ++line) {
    std::string before, after;
    const bool has_before = !!std::getline(old_lines, before), has_after = !!std::getline(new_lines, after);
    if (!has_before && !has_after) return "";
    if (before != after || has_before != has_after)
      return fmt::format("{}:{}: {} before, {} now", file.string(), line, shown(before), shown(after));
  }
}

void refuse_other_study(const fs::path& folder, const StudyFiles& files) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::is_empty(folder, error)) return;
  if (!fs::is_directory(folder, error)) throw InvalidInput(folder.string() + ": is a file; a study needs a folder");
  if (!fs::exists(folder / "jobs.txt", error))
    throw InvalidInput(folder.string() + ": is not empty and contains no study; choose another folder with -o");
  if (!fs::exists(folder / "runs", error) || fs::is_empty(folder / "runs", error)) return;
  for (const auto& [name, text] : {std::pair("cases.csv", files.cases), std::pair("scene.toml", files.scene)})
    if (const std::string difference = change(folder / name, text); !difference.empty())
      throw InvalidInput(
          fmt::format("{}; {} has results of the earlier study: choose another folder with -o, or remove it",
                      difference, (folder / "runs").string()));
}

int write_study(SweepArguments arguments) {
  if (arguments.study.empty())
    throw InvalidInput("a study file is missing: aspic sweep STUDY.toml, or aspic sweep collect FOLDER");
  if (arguments.out.empty()) arguments.out = fs::path("out") / arguments.study.stem();
  const Study study = read_study(arguments.study);
  const StudyFiles files = make_files(arguments, study);
  refuse_other_study(arguments.out, files);
  std::error_code error;
  fs::create_directories(arguments.out, error);
  if (error) throw InvalidInput(arguments.out.string() + ": cannot be created: " + error.message());
  const JobList jobs{arguments.out, arguments.study.stem().string(), files.jobs, study.threads};
  write_jobs(jobs);
  write_file(arguments.out / "scene.toml", files.scene);
  write_file(arguments.out / "cases.csv", files.cases);
  fmt::print("study      {} cases in {}\n", study.cases.size(), (arguments.out / "cases.csv").string());
  print_how_to_run(jobs);
  fmt::print("results    aspic sweep collect {}\n", shell_word(arguments.out));
  return exit_done;
}

}  // namespace

std::string case_name(size_t index) { return fmt::format("{:06}", index + 1); }
fs::path case_folder(const fs::path& study, size_t index) { return study / "runs" / case_name(index); }

void add_sweep(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command = app.add_subcommand("sweep", "Writes the cases of a study as commands; collects their results");
  command->footer(R"(
Examples:
  aspic sweep drop_study.toml -o study            write study/cases.csv, study/jobs.txt and study/slurm.sh
  tr '\n' '\0' < study/jobs.txt | xargs -0 -n 1 -P 4 sh -c
                                                  run all cases, four at a time; GNU parallel and sbatch do, too
  aspic sweep collect study                       write study/results.csv and study/index.html

A study (docs/ensembles.md):
  scene = "drop.toml"
  sample = { method = "latin_hypercube", count = 100, seed = 1 }
  [vary]
  material.model = ["neo_hookean", "stvk"]        # a list or a grid: all combinations
  material.young = { from = 1e4, to = 1e6, scale = "log" }    # drawn; with count = 5 a grid

Each line of jobs.txt begins its case, resumes it, or does nothing if it is done. So the same file runs again after
any failure.

Exit codes: 0 written; collect: every case is done, 2 bad input, 3 collect: a case is missing or failed.)");
  command->add_option("STUDY", arguments->study, "Study (.toml)");
  command->add_option("-o,--out", arguments->out, "Folder of the study; out/NAME by default");
  command->add_option("--program", arguments->program, "Program in the commands; aspic by default");
  CLI::App* collect = command->add_subcommand("collect", "Writes the results of a study: results.csv and index.html");
  collect->footer("");
  collect->add_option("FOLDER", arguments->collected, "Folder of the study")->required();
  command->callback([arguments, &action] {
    if (arguments->collected.empty()) action = [arguments] { return write_study(*arguments); };
  });
  collect->callback(
      [arguments, &action] { action = [arguments] { return int{collect_study(arguments->collected)}; }; });
}

}  // namespace aspic::cli
