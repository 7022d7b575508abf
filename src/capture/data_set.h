// Measurements in a folder: capture.toml beside the rest mesh and tables of markers, cases and positions
// (docs/capture_format.md).
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "fit/misfit.h"
#include "mesh/numbering.h"

namespace aspic {

struct DataSet {
  std::string name;
  Experiment experiment;        // its mesh is renumbered for speed
  Numbering numbering;          // back to what the user calls vertices and tets
  std::vector<int> marker_row;  // line of each marker in its table, for messages
  std::vector<std::string> marker_names;
  std::vector<std::string> notes;  // what was assumed, converted or corrected on reading
};

// `path`: the folder, or its capture.toml. Throws InvalidInput with file, line, value and remedy.
DataSet read_data_set(const std::filesystem::path& path);
void write_data_set(const std::filesystem::path& folder, const DataSet& data);

enum class Severity { note, warning, error };

struct DataFinding {
  Severity severity = Severity::note;
  std::string where;  // "positions.csv:12", "poke 3"
  std::string what;   // what is odd about it, and by how much
  std::string remedy;
};

// Units that do not fit (forces in grams, lengths in mm), outliers, rigid motion left in, markers off the surface,
// missing forces, too little data for what is to be known.
std::vector<DataFinding> diagnose(const DataSet& data);

}  // namespace aspic
