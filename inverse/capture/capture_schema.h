// Every key of capture.toml.
#pragma once
#include "scene/schema.h"

namespace aspic {

const Schema& capture_schema();  // its document is the section "capture"

// The names of columns that a table may have, by Aspic's names.
const std::vector<std::string>& marker_columns();
const std::vector<std::string>& case_columns();
const std::vector<std::string>& position_columns();

}  // namespace aspic
