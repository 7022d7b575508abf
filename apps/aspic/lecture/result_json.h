// JSON of a result: measures with their verdicts, remarks and pictures.
#pragma once
#include <nlohmann/json.hpp>

#include "aspic/lecture/results.h"

namespace aspic::cli::lecture {

nlohmann::ordered_json to_json(const Result& result);

}  // namespace aspic::cli::lecture
