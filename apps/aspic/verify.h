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

void print_list(const std::vector<const verify::Check*>& checks);
void print_head(const verify::Check& check, size_t number, size_t count);  // printed before the check
void print_rows(const Verification& result);

std::string how_text(const verify::Subject& subject, bool all, double seconds);  // settings of the run, in a sentence
// Formats with as many digits as the tolerance needs.
std::string value_text(double value, const verify::Row& row);
std::string tolerance_text(const verify::Row& row);  // "+- 1e-12 m"

// Writes index.html with embedded plots, and verify.json. Prints to stderr if plots are not possible.
void write_verification(const std::filesystem::path& folder, const std::vector<Verification>& results,
                        const std::string& how);
std::string count_text(const std::vector<Verification>& results);  // "12 checks, 120 rows: all pass"

// Prints results, writes them to `folder` and returns the exit code: 0 if all rows pass, 3 otherwise.
int verify_all(const std::vector<const verify::Check*>& checks, const verify::Subject& subject,
               const std::filesystem::path& folder);

}  // namespace aspic::cli
