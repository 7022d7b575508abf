// Lists of shell commands that xargs, GNU parallel or Slurm run.
#pragma once
#include <filesystem>
#include <string>

namespace aspic::cli {

std::string shell_word(const std::string& word);            // quoted for a POSIX shell
std::string shell_word(const std::filesystem::path& path);  // also if it begins with -

struct JobList {
  std::filesystem::path folder;
  std::string name;   // of the Slurm job
  std::string lines;  // each ends with a line break
  int threads = 1;    // of each command
};

void write_jobs(const JobList& jobs);  // writes jobs.txt and slurm.sh; throws InvalidInput
void print_how_to_run(const JobList& jobs);

}  // namespace aspic::cli
