#include "mesh/elements.h"

#include <cmath>
#include <numbers>

#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

// The edges of a triangle and its unit normal.
Mat3d with_normal(const Vec3d& a, const Vec3d& b) {
  const Vec3d n = cross(a, b);
  return from_columns(a, b, (1 / norm(n)) * n);
}

// Returns the smallest rotation of the unit vector s to the unit vector t.
Mat3d rotation(const Vec3d& s, const Vec3d& t) {
  const Vec3d c = cross(s, t);
  const Mat3d K = {{0, c[2], -c[1], -c[2], 0, c[0], c[1], -c[0], 0}};
  const double cosine = dot(s, t);
  if (!(cosine > -1)) return identity3<double>();  // undefined
  return identity3<double>() + K + (1 / (1 + cosine)) * (K * K);
}

// Returns the edges of the pattern of a triangle and a unit normal, in the plane of its corners: the first edge keeps
// its direction.
Mat3d rest_with_normal(const TetMesh& mesh, int triangle) {
  const auto& [i, j, k] = mesh.sheet[triangle];
  const Vec3d p = mesh.rest[j] - mesh.rest[i], q = mesh.rest[k] - mesh.rest[i];
  if (mesh.pattern.empty()) return with_normal(p, q);
  const auto& [A, B, C] = mesh.pattern[triangle];
  const Vec3d n = cross(p, q), across = cross(n, p), a = B - A, c = C - A;
  const double length = norm(a);
  const Vec3d s = (1 / norm(p)) * p, m = (1 / norm(across)) * across;
  return with_normal(length * s, (dot(a, c) / length) * s + (norm(cross(a, c)) / length) * m);
}

struct Offsets {
  int tets, vertices;
};

void append_mids(const TetMesh& body, const Offsets& offsets, TetMesh& all) {
  constexpr MidNodes kLinear = {-1, -1, -1, -1, -1, -1};
  if (body.mids.empty() && all.mids.empty()) return;
  all.mids.resize(offsets.tets, kLinear);
  for (MidNodes mids : body.mids) {
    for (int& node : mids) node += offsets.vertices;
    all.mids.push_back(mids);
  }
  all.mids.resize(all.tets.size(), kLinear);
}

// Triangles without a pattern get their corners. Precedes the triangles of the body.
void append_pattern(const TetMesh& body, TetMesh& all) {
  if (body.pattern.empty() && all.pattern.empty()) return;
  std::vector<std::array<Vec3d, 3>> pattern;
  for (const TetMesh* mesh : {static_cast<const TetMesh*>(&all), &body})
    for (size_t t = 0; t < mesh->sheet.size(); ++t) pattern.push_back(rest_corners(*mesh, static_cast<int>(t)));
  all.pattern = std::move(pattern);
}

}  // namespace

std::array<Vec3d, 3> rest_corners(const TetMesh& mesh, int triangle) {
  if (!mesh.pattern.empty()) return mesh.pattern[triangle];
  const auto& [a, b, c] = mesh.sheet[triangle];
  return {mesh.rest[a], mesh.rest[b], mesh.rest[c]};
}

double element_volume(const TetMesh& mesh, int element) {
  if (mesh.is_tet(element)) return volume(mesh, element);
  if (!mesh.is_triangle(element)) {
    const auto& [p, q] = mesh.segment(element);
    const double r = mesh.radius[element - mesh.first_segment()];
    return std::numbers::pi * r * r * norm(mesh.rest[q] - mesh.rest[p]);
  }
  const int triangle = element - mesh.tet_count();
  const auto [A, B, C] = rest_corners(mesh, triangle);
  return mesh.thickness[triangle] * norm(cross(B - A, C - A)) / 2;
}

Vec3d element_center(const TetMesh& mesh, int element) {
  if (mesh.is_tet(element)) return centroid(mesh, element);
  if (!mesh.is_triangle(element))
    return 0.5 * (mesh.rest[mesh.segment(element)[0]] + mesh.rest[mesh.segment(element)[1]]);
  const auto& [a, b, c] = mesh.triangle(element);
  return (1.0 / 3) * (mesh.rest[a] + mesh.rest[b] + mesh.rest[c]);
}

double element_quality(const TetMesh& mesh, int element) {
  if (mesh.is_tet(element)) return mean_ratio(corners(mesh, element));
  if (!mesh.is_triangle(element)) return 1;
  const auto& [a, b, c] = mesh.triangle(element);
  const auto& X = mesh.rest;
  const Vec3d ab = X[b] - X[a], ac = X[c] - X[a];
  const double squares = squared_norm(ab) + squared_norm(ac) + squared_norm(X[c] - X[b]);
  return squares > 0 ? 2 * std::sqrt(3.0) * norm(cross(ab, ac)) / squares : 0;
}

Mat3d deformation_gradient(const TetMesh& mesh, int element, std::span<const double> x) {
  if (mesh.is_tet(element)) {
    const auto [a, b, c, d] = center_corners(mesh, element, x);
    return from_columns(b - a, c - a, d - a) * inverse(edge_matrix(mesh, element));
  }
  const auto at = [&](int v) { return Vec3d{{x[3 * v], x[3 * v + 1], x[3 * v + 2]}}; };
  const auto& X = mesh.rest;
  if (!mesh.is_triangle(element)) {
    const auto& [p, q] = mesh.segment(element);
    const Vec3d rest = X[q] - X[p], now = at(q) - at(p);
    const double l0 = norm(rest), l = norm(now);
    const Vec3d s = (1 / l0) * rest;
    return rotation(s, (1 / l) * now) * (identity3<double>() + (l / l0 - 1) * outer(s, s));
  }
  const auto& [i, j, k] = mesh.triangle(element);
  return with_normal(at(j) - at(i), at(k) - at(i)) * inverse(rest_with_normal(mesh, element - mesh.tet_count()));
}

std::string size_text(const TetMesh& mesh) {
  std::string text = std::to_string(mesh.vertex_count()) + " vertices";
  if (!mesh.tets.empty() || (mesh.sheet.empty() && mesh.rods.empty()))
    text += ", " + std::to_string(mesh.tet_count()) + " tets";
  if (!mesh.sheet.empty()) text += ", " + std::to_string(mesh.sheet.size()) + " triangles";
  if (!mesh.rods.empty()) text += ", " + std::to_string(mesh.rods.size()) + " segments";
  return text;
}

void append(const TetMesh& body, TetMesh& all) {
  const int offset = all.vertex_count(), first_tet = all.tet_count();
  all.rest.insert(all.rest.end(), body.rest.begin(), body.rest.end());
  all.tets.reserve(all.tets.size() + body.tets.size());
  for (const Tet& t : body.tets) all.tets.push_back({t[0] + offset, t[1] + offset, t[2] + offset, t[3] + offset});
  append_mids(body, {first_tet, offset}, all);
  append_pattern(body, all);
  for (const Triangle& t : body.sheet) all.sheet.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  all.thickness.insert(all.thickness.end(), body.thickness.begin(), body.thickness.end());
  for (const Segment& s : body.rods) all.rods.push_back({s[0] + offset, s[1] + offset});
  all.radius.insert(all.radius.end(), body.radius.begin(), body.radius.end());
  if (body.region.empty() && all.region.empty()) return;
  all.region.resize(first_tet, 0);
  all.region.insert(all.region.end(), body.region.begin(), body.region.end());
  all.region.resize(all.tets.size(), 0);
}

}  // namespace aspic
