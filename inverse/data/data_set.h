// Measurements in a folder: capture.toml with the rest mesh and tables of markers, cases and positions
// (inverse/docs/capture_format.md).
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data/registration.h"
#include "mesh/doctor.h"
#include "mesh/numbering.h"
#include "model/load_history.h"
#include "model/misfit.h"

namespace aspic {

// Source of each part of a data set, for messages. Lines count from 1; empty for data that were not read from files.
struct DataSource {
  std::string settings = "capture.toml", markers = "markers.csv", cases = "cases.csv", positions = "positions.csv";
  std::vector<int> marker_line, case_line;
  std::vector<std::vector<int>> position_line;  // line per case and position

  std::string marker(int m) const;           // "markers.csv:12"
  std::string load_case(int c) const;        // "cases.csv:3"
  std::string position(int c, int i) const;  // "positions.csv:40"
};

// Tets of the largest mesh that is simulated with quadratic tets by default, and whose histories are fitted without a
// warning of hours; a fit also solves on eight times as many. Chosen: such fits take minutes.
inline constexpr int kMaxQuadratic = 2000;

struct DataSet {
  std::string name;
  Measured experiment;                      // the mesh is renumbered for locality
  std::vector<LoadHistory> histories = {};  // on the same body
  bool histories_end_static = false;        // all cases are the last states of histories
  bool is_order_reduced = false;            // tets are linear because there are more than kMaxQuadratic
  Numbering numbering;                      // maps to the user's vertices and tets
  std::vector<std::string> marker_names;
  std::vector<double> marker_gap;                // original distance of each marker from the surface [m]
  std::vector<std::optional<double>> case_time;  // one per case [s]
  std::optional<Registration> registration;      // if it was requested
  DataSource source;
  std::vector<std::string> notes;  // assumptions, conversions and corrections of the reader
};

// Reads a data set. `path`: the folder, or its capture.toml. `registers`: the motion of the markers to the mesh is
// found first. Throws InvalidInput with file, line, value and remedy, one line per error.
DataSet read_data_set(const std::filesystem::path& path, std::optional<RegistrationKind> registers = {});
// Writes a data set, which reads back exactly if the axis of each pose is that of the touch, rotated by the pose.
// Replaces an existing data set atomically. `beside` writes further files to the given folder, which appear together
// with the data. Throws InvalidInput.
using WriteBeside = std::function<void(const std::filesystem::path& folder)>;
void write_data_set(const std::filesystem::path& folder, const DataSet& data, const WriteBeside& beside = {});

struct DataFinding {
  Severity severity = Severity::note;
  std::string where;  // "positions.csv:12", "poke 3"
  std::string what;   // suspicious value and its size
  std::string remedy;
};

// Finds inconsistent units (forces in grams, lengths in mm), outliers, remaining rigid motion, markers off the surface,
// missing forces, and insufficient data. Errors first, then warnings, then notes.
std::vector<DataFinding> diagnose(const DataSet& data);

}  // namespace aspic
