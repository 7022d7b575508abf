#include "viewer/fibre_lines.h"

#include <array>
#include <cmath>

namespace aspic::viewer {
namespace {

constexpr double kLength = 0.6;  // of a line, relative to the size of its triangle

// Shares of the edges from the first corner in the tangential part of a.
std::array<double, 2> edge_shares(const std::array<Vec3d, 3>& X, const Vec3d& a) {
  const Vec3d e = X[1] - X[0], f = X[2] - X[0], n = cross(e, f);
  const double squared = dot(n, n);
  if (!(squared > 0)) return {0, 0};
  const double size = kLength * std::sqrt(std::sqrt(squared)) / squared;
  return {size * dot(cross(a, f), n), size * dot(cross(e, a), n)};
}

}  // namespace

bool has_fibres(const Model& model) { return tet_field(model, "fibre_x") != nullptr; }

Json fibre_lines(const Model& model, const Surface& surface) {
  std::array<const std::vector<double>*, 3> of_axis{};
  for (int r = 0; r < 3; ++r) of_axis[r] = tet_field(model, std::string("fibre_") + static_cast<char>('x' + r));
  Json lines = Json::array();
  for (int t = 0; of_axis[0] && t < surface.triangle_count(); ++t) {
    Vec3d a;
    for (int r = 0; r < 3; ++r) a[r] = (*of_axis[r])[surface.tet[t]];
    if (norm(a) == 0) continue;
    const auto [i, j, k] = surface.triangles[t];
    const auto& X = surface.rest;
    const std::array<double, 2> shares = edge_shares({X[i], X[j], X[k]}, a);
    lines.insert(lines.end(), {t, static_cast<float>(shares[0]), static_cast<float>(shares[1])});
  }
  return lines;
}

}  // namespace aspic::viewer
