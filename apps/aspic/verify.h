// Runs checks of the library `verify` and writes a table, a page and JSON.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "verification/check.h"

namespace aspic::cli {

struct Verification {
  const verify::Check* check;
  verify::Findings findings;
  double seconds = 0;
};

// Writes index.html with embedded plots, and verify.json. Prints to stderr if plots are not possible.
void write_verification(const std::filesystem::path& folder, const std::vector<Verification>& results,
                        const std::string& how);
std::string count_text(const std::vector<Verification>& results);  // "12 checks, 120 rows: all pass"

// Prints results, writes them to `folder` and returns the exit code: 0 if all rows pass, 3 otherwise.
int verify_all(const std::vector<const verify::Check*>& checks, const verify::Subject& subject,
               const std::filesystem::path& folder);

}  // namespace aspic::cli
