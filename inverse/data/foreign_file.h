// Recordings in the files of other programs, which the Python package converts to tables.
#pragma once
#include <string>

namespace aspic {

// "converted by: python3 -m aspic.recordings FILE OUTPUT"
std::string conversion(const std::string& file, const std::string& output);

// Throws InvalidInput for the name of a recording or of a sequence of files. `output`: folder or table to write.
void require_table(const std::string& file, const std::string& output);

}  // namespace aspic
