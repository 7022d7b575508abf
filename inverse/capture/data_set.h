// Measurements in a folder: capture.toml beside the rest mesh and tables of markers, cases and positions
// (docs/capture_format.md).
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fit/misfit.h"
#include "mesh/doctor.h"
#include "mesh/numbering.h"

namespace aspic {

// Where each part of a data set was written, for messages. Lines count from 1; empty for data that were not read.
struct DataSource {
  std::string settings = "capture.toml", markers = "markers.csv", cases = "cases.csv", positions = "positions.csv";
  std::vector<int> marker_line, case_line;
  std::vector<std::vector<int>> position_line;  // of each case, of each of its positions

  std::string marker(int m) const;           // "markers.csv:12"
  std::string load_case(int c) const;        // "cases.csv:3"
  std::string position(int c, int i) const;  // "positions.csv:40"
};

struct DataSet {
  std::string name;
  Experiment experiment;  // its mesh is renumbered for speed
  Numbering numbering;    // back to what the user calls vertices and tets
  std::vector<std::string> marker_names;
  std::vector<double> marker_gap;  // how far each lay off the surface of the mesh [m]
  DataSource source;
  std::vector<std::string> notes;  // what was assumed, converted or corrected on reading
};

// `path`: the folder, or its capture.toml. Throws InvalidInput with file, line, value and remedy; of several errors,
// one per line.
DataSet read_data_set(const std::filesystem::path& path);
// Reading gives the same data to the last bit, when the axis of each pose is that of the touch, turned by the rotation
// of the pose. A data set that is there already is replaced as a whole, or kept. `beside` writes further files into the
// folder that it is given, which appear together with the data. Throws InvalidInput.
using WriteBeside = std::function<void(const std::filesystem::path& folder)>;
void write_data_set(const std::filesystem::path& folder, const DataSet& data, const WriteBeside& beside = {});

struct DataFinding {
  Severity severity = Severity::note;
  std::string where;  // "positions.csv:12", "poke 3"
  std::string what;   // what is odd about it, and by how much
  std::string remedy;
};

// Units that do not fit (forces in grams, lengths in mm), outliers, rigid motion left in, markers off the surface,
// missing forces, too little data for what is to be known. Errors first, then warnings, then notes.
std::vector<DataFinding> diagnose(const DataSet& data);

}  // namespace aspic
