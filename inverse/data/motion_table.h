// Measured marker positions over time: a table with the columns time [s], marker, x, y, z [m] and optionally sigma [m].
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "estimate/motion_objective.h"

namespace aspic {

struct MotionRow {
  double time = 0;
  int marker = 0;  // index into MotionTable::markers
  Vec3d position{};
  double sigma = 1;
  int line = 0;
};

struct MotionTable {
  std::string file;  // name for messages
  std::vector<std::string> markers;
  std::vector<MotionRow> rows;
  bool has_sigma = false;
};

// Reads a table. Throws InvalidInput with file, line, value and remedy.
MotionTable read_motion_table(const std::filesystem::path& path);

// Attaches each marker to the surface point that is nearest to its position at the start. `h`: time step [s]. Adds
// notes about markers off the surface. Throws InvalidInput for a marker without a row at the start or far off the
// surface, and for rows before the start.
MotionData attach_markers(const MotionTable& table, const TetMesh& mesh, const State& start, double h,
                          std::vector<std::string>& notes);

}  // namespace aspic
