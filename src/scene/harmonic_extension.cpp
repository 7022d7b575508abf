#include "scene/harmonic_extension.h"

#include <algorithm>

#include "base/error.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

std::vector<char> on_boundary(const TetMesh& mesh) {
  std::vector<char> flags(mesh.rest.size(), 0);
  for (const Triangle& triangle : boundary_triangles(mesh, 0, mesh.tet_count()))
    for (const int v : triangle) flags[v] = 1;
  return flags;
}

}  // namespace

HarmonicExtension::HarmonicExtension(const TetMesh& mesh) : HarmonicExtension(mesh, on_boundary(mesh)) {}

HarmonicExtension::HarmonicExtension(const TetMesh& mesh, const std::vector<char>& is_given) {
  std::vector<char> is_inner(mesh.rest.size(), 0);
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) is_inner[v] = !is_given[v];
  std::vector<int> row(mesh.rest.size(), -1);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (is_inner[v]) row[v] = static_cast<int>(inner_.size());
    (is_inner[v] ? inner_ : given_).push_back(v);
  }
  if (inner_.empty()) return;
  std::vector<MatrixPlace> places;
  std::vector<double> values;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const Tet& tet = mesh.tets[t];
    const TetCorners X = corners(mesh, t);
    const std::array<Vec3d, 4> gradients = shape_gradients(X);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const int a = row[tet[i]], b = row[tet[j]];
        const double k = signed_volume(X) * dot(gradients[i], gradients[j]);
        if (a >= 0 && b < 0) couplings_.push_back({a, tet[j], k});
        if (a >= 0 && b >= 0 && b <= a) places.push_back({a, b}), values.push_back(k);
      }
  }
  matrix_.analyze(static_cast<int>(inner_.size()), places);
  if (!matrix_.factorize(values))
    throw InvalidInput(
        "a harmonic field cannot be computed, because tets are too flat, a separate part of the body has no given "
        "values, or memory is too small; use a better or coarser mesh");
}

void HarmonicExtension::extend(std::span<double> values) {
  if (inner_.empty()) return;
  std::vector<double> b(inner_.size(), 0.0);
  for (const auto& [inner, given, value] : couplings_) b[inner] -= value * values[given];
  matrix_.solve(b, b);
  double least = values[given_[0]], largest = least;
  for (const int v : given_) least = std::min(least, values[v]), largest = std::max(largest, values[v]);
  for (size_t i = 0; i < inner_.size(); ++i) values[inner_[i]] = std::clamp(b[i], least, largest);
}

}  // namespace aspic
