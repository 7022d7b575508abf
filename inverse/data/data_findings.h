// Collects findings about a data set.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "data/data_set.h"
#include "scene/value.h"

namespace aspic {

// Implausible ratio of a modulus or of gravity to the usual one. Chosen: units of forces and lengths usually differ by
// 1000.
inline constexpr double kUnlike = 30;

class DataFindings {
 public:
  void error(std::string where, std::string what, std::string remedy) {
    add({Severity::error, std::move(where), std::move(what), std::move(remedy)});
  }
  void warning(std::string where, std::string what, std::string remedy) {
    add({Severity::warning, std::move(where), std::move(what), std::move(remedy)});
  }
  void note(std::string where, std::string what, std::string remedy) {
    add({Severity::note, std::move(where), std::move(what), std::move(remedy)});
  }
  std::vector<DataFinding> take();  // errors first

 private:
  void add(DataFinding finding) { list_.push_back(std::move(finding)); }
  std::vector<DataFinding> list_;
};

void diagnose_loads(const DataSet& data, DataFindings& findings);      // poses, pressures, gravity, supports
void diagnose_forces(const DataSet& data, DataFindings& findings);     // units, signs, outliers, missing forces
void diagnose_positions(const DataSet& data, DataFindings& findings);  // units, outliers, markers off the surface
void diagnose_content(const DataSet& data, DataFindings& findings);    // rigid motion, insufficient data, repetitions

std::string factor_text(double factor);                                          // "1000 times", "1/100 times"
Vec3d displacement(const Experiment& experiment, const MarkerReading& reading);  // [m]

}  // namespace aspic
