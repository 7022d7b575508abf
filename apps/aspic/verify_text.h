// The findings of checks as text.
#pragma once
#include <string>
#include <vector>

#include "aspic/verify.h"

namespace aspic::cli {

void print_list(const std::vector<const verify::Check*>& checks);
void print_head(const verify::Check& check, size_t number, size_t count);  // before it is run
void print_rows(const Verification& result);

std::string how_text(const verify::Subject& subject, bool all, double seconds);  // what was run, in a sentence
// With as many digits as the tolerance asks for.
std::string value_text(double value, const verify::Row& row);
std::string tolerance_text(const verify::Row& row);  // "+- 1e-12 m"

}  // namespace aspic::cli
