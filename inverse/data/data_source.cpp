#include "data/data_set.h"

namespace aspic {
namespace {

std::string line_in(const std::string& file, const std::vector<int>& lines, int i) {
  return i < static_cast<int>(lines.size()) ? file + ":" + std::to_string(lines[i]) : file;
}

}  // namespace

std::string DataSource::marker(int m) const { return line_in(markers, marker_line, m); }
std::string DataSource::load_case(int c) const { return line_in(cases, case_line, c); }
std::string DataSource::position(int c, int i) const {
  return c < static_cast<int>(position_line.size()) ? line_in(positions, position_line[c], i) : positions;
}

}  // namespace aspic
