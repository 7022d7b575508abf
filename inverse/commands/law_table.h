// Comparison of laws as a table on the terminal and as JSON.
#pragma once
#include <cstdio>
#include <nlohmann/json.hpp>

#include "pipeline/law_choice.h"

namespace aspic::cli {

void print_laws(std::FILE* stream, const LawChoice& choice);
nlohmann::ordered_json json_of(const LawChoice& choice);

}  // namespace aspic::cli
