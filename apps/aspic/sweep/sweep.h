// The folder of a study: cases.csv, jobs.txt and slurm.sh by `aspic sweep`, results.csv and index.html by its
// `collect`.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "aspic/commands.h"
#include "aspic/sweep/case_result.h"

namespace aspic::cli {

std::string case_name(size_t index);                                                  // "000001" of the first case
std::filesystem::path case_folder(const std::filesystem::path& study, size_t index);  // "study/runs/000001"

struct StudyResults {
  std::filesystem::path folder;
  std::vector<std::string> keys;                // that vary
  std::vector<std::vector<std::string>> cases;  // values of the keys
  std::vector<CaseResult> results;              // of the cases
};

ExitCode collect_study(const std::filesystem::path& folder);  // done or unconverged; throws InvalidInput

// Writes index.html. Returns why it has no plots; empty if it has them or there are none. Throws InvalidInput.
std::string write_study_page(const StudyResults& study);

}  // namespace aspic::cli
