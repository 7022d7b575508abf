// The scalar fields that color a surface.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contact/barrier.h"
#include "viewer/surface.h"

namespace aspic::viewer {

struct Field {
  std::string name, label, unit;
  bool is_diverging = false;
  double center = 0;    // center of a diverging color map
  bool is_log = false;  // displayed on a logarithmic scale
};
// The density of the estimated error of the mesh. A model alone does not determine it.
inline constexpr std::string_view kMeshError = "mesh_error";
inline constexpr std::string_view kBendingDensity = "bending_density";  // of models with sheets or rods
std::vector<Field> fields_of(const Model& model, bool has_mesh_error = false);
const std::vector<double>* tet_field(const Model& model, std::string_view name);  // null: none

// The displayed state of a simulation: between steps, or at an iterate of the current step.
struct View {
  const Simulation& simulation;
  std::span<const double> x;
  std::span<const double> mesh_error = {};  // of each tet [J/m^3]; empty: not estimated
  // Of each element [J/m^3]; empty: that at x with the internal variables of the state. Needs all rows of x.
  std::span<const double> bending = {};
};

class FieldValues {
 public:
  // Computes a field of the model, one value per vertex of the surface. Averages values of tets by volume.
  void evaluate(const std::string& field, const View& view, const Surface& surface, std::span<float> values);

 private:
  std::span<const double> tet_values(const std::string& field, const View& view);

  TetFields fields_;
  std::vector<double> tet_, pressure_;
};

std::vector<ContactPoint> contact_points(const View& view);  // empty without contact
TetFields tet_fields_at(const View& view);
Vec3d stretches(const Mat3d& F);  // in descending order, never negative
// The largest stretch by the cosine formula for eigenvalues of F'F [Smith 1961]. Accurate to 1e-8, six times faster.
double largest_stretch(const Mat3d& F);

}  // namespace aspic::viewer
