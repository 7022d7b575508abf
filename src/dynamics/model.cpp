#include "dynamics/model.h"

namespace aspic {

std::vector<double> angle_masses(const Model& model, const BodyRange* body) {
  std::vector<double> masses;
  for (const AngleRow& row : model.angle_rows) {
    const int in_body = body ? row.vertex - body->first_vertex : 0;
    masses.push_back(!body || (0 <= in_body && in_body < body->vertex_count) ? row.mass : 0);
  }
  return masses;
}

}  // namespace aspic
