#include "aspic/job_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "io/atomic_file.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::ptrdiff_t kMaxArray = 1000;  // tasks of a job array; the default limit of Slurm is 1001

std::string slurm_script(const JobList& jobs) {
  return fmt::format(R"(#!/bin/sh
#SBATCH --job-name={0}
#SBATCH --array=1-{1}
#SBATCH --cpus-per-task={2}
#SBATCH --output={4}
#SBATCH --open-mode=append
# Submit from the folder in which `aspic` ran. Further options: sbatch --time=1:00:00 --mem=2G SCRIPT
# Task I runs the lines I, I + {1}, ... of jobs.txt. Submit again to continue what was interrupted.
awk -v task="$SLURM_ARRAY_TASK_ID" 'NR % {1} == task % {1}' {3} | {{
  code=0
  while IFS= read -r line; do sh -c "$line" </dev/null || code=$?; done
  exit $code
}}
)",
                     shell_word(jobs.name), std::min(std::count(jobs.lines.begin(), jobs.lines.end(), '\n'), kMaxArray),
                     jobs.threads, shell_word(jobs.folder / "jobs.txt"),
                     shell_word(jobs.folder.string() + "/slurm-%a.log"));
}

}  // namespace

std::string shell_word(const std::string& word) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-+=./:,%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

std::string shell_word(const fs::path& path) {
  const std::string text = path.string();
  return shell_word(text.starts_with('-') ? "./" + text : text);
}

void write_jobs(const JobList& jobs) {
  write_file(jobs.folder / "jobs.txt", jobs.lines);
  write_file(jobs.folder / "slurm.sh", slurm_script(jobs));
}

void print_how_to_run(const JobList& jobs) {
  const std::string file = shell_word(jobs.folder / "jobs.txt");
  fmt::print("run it     tr '\\n' '\\0' < {} | xargs -0 -n 1 -P \"$(nproc)\" sh -c\n", file);
  fmt::print("       or  parallel < {}\n       or  sbatch {}\n", file, shell_word(jobs.folder / "slurm.sh"));
}

}  // namespace aspic::cli
