// Tables of programs for digital image correlation, recognized by their columns.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace aspic {

// Columns of a program. Coordinates and displacements are three columns, or two of an image.
struct DicDialect {
  const char* program;
  std::vector<const char*> coordinates, displacements;
  const char* name = "";    // column with the name of a point; "": no such column
  const char* failed = "";  // column that is negative, or 0 for `is_flag`, where the correlation failed; may be missing
  bool is_flag = false;
  bool is_current = false;  // the coordinates are those after the displacement
  double unit = 0;          // [m]; 0: not stated
};

// Returns the dialect of a table with these columns; null if there is none.
const DicDialect* dialect_of(const std::vector<std::string>& columns);

}  // namespace aspic
