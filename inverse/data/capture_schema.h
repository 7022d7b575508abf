// Keys of capture.toml.
#pragma once
#include "scene/schema.h"

namespace aspic {

const Schema& capture_schema();  // the document is the section "capture"

// Aspic's names of the columns of each table.
const std::vector<std::string>& marker_columns();
const std::vector<std::string>& case_columns();
const std::vector<std::string>& position_columns();
const std::vector<std::string>& series_columns();

}  // namespace aspic
