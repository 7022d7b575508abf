#include <algorithm>

#include "data/data_findings.h"
#include "data/surface_projection.h"

namespace aspic {

std::vector<DataFinding> DataFindings::take() {
  std::stable_sort(list_.begin(), list_.end(),
                   [](const DataFinding& a, const DataFinding& b) { return a.severity < b.severity; });
  return std::move(list_);
}

std::string factor_text(double factor) {
  return factor >= 1 ? three_digits(factor) + " times" : "1/" + three_digits(1 / factor) + " times";
}

Vec3d displacement(const Experiment& experiment, const MarkerReading& reading) {
  return reading.position - position(experiment.markers[reading.marker], experiment.mesh.rest);
}

std::vector<DataFinding> diagnose(const DataSet& data) {
  DataFindings findings;
  if (data.registration)
    for (const std::string& ambiguity : data.registration->ambiguities)
      findings.warning("registration", ambiguity,
                       "add points elsewhere, or give a vertex of the mesh to 3 markers in the table of markers");
  diagnose_loads(data, findings);
  diagnose_forces(data, findings);
  diagnose_positions(data, findings);
  diagnose_content(data, findings);
  return findings.take();
}

}  // namespace aspic
