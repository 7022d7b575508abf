// Results of checks as text.
#pragma once
#include <string>
#include <vector>

#include "aspic/verify.h"

namespace aspic::cli {

void print_list(const std::vector<const verify::Check*>& checks);
void print_head(const verify::Check& check, size_t number, size_t count);  // printed before the check
void print_rows(const Verification& result);

std::string how_text(const verify::Subject& subject, bool all, double seconds);  // settings of the run, in a sentence
// Formats with as many digits as the tolerance needs.
std::string value_text(double value, const verify::Row& row);
std::string tolerance_text(const verify::Row& row);  // "+- 1e-12 m"

}  // namespace aspic::cli
