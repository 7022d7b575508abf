#include "contact/contact_mesh.h"

#include <algorithm>
#include <limits>
#include <map>

namespace aspic {

std::string ContactMesh::pair_name(const std::array<int, 2>& pair) const {
  return parts[pair[0]].name + " and " + (pair[0] == pair[1] ? "itself" : parts[pair[1]].name);
}

double ContactMesh::area_at_rest(const Triangle& t) const {
  if (t[1] == t[2]) return 2 * parts[part[t[0]]].offset * norm(rest[t[1]] - rest[t[0]]);
  return norm(cross(rest[t[1]] - rest[t[0]], rest[t[2]] - rest[t[0]])) / 2;
}

void ContactMesh::add(const ContactPart& given, std::span<const Vec3d> X, std::span<const Triangle> surface,
                      std::span<const int> rows) {
  ContactPart own = given;
  const int number = static_cast<int>(parts.size());
  own.first_point = point_count();
  std::vector<int> point(X.size(), -1);
  for (const Triangle& t : surface)
    for (const int v : t) point[v] = 0;
  for (size_t v = 0; v < X.size(); ++v) {
    if (point[v] < 0) continue;
    point[v] = point_count();
    rest.push_back(X[v]);
    row.push_back(rows.empty() ? -1 : rows[v]);
    part.push_back(number);
  }
  own.point_count = point_count() - own.first_point;
  area.resize(rest.size(), 0.0);
  point_share.resize(rest.size(), 1);

  std::map<Edge, int> number_of;
  for (const Triangle& t : surface) {
    const Triangle corners = {point[t[0]], point[t[1]], point[t[2]]};
    const double size = area_at_rest(triangles.emplace_back(corners));
    own.mean_triangle += size / static_cast<double>(surface.size());
    for (const int p : corners) area[p] += size / 3, --point_share[p];
    auto& own_edges = edges_of.emplace_back();
    for (int k = 0; k < 3; ++k) {
      Edge edge = {corners[(k + 1) % 3], corners[(k + 2) % 3]};
      if (edge[0] > edge[1]) std::swap(edge[0], edge[1]);
      const auto [found, is_new] = number_of.try_emplace(edge, edge_count());
      if (is_new) {
        edges.push_back(edge);
        edge_area.push_back(0);
        edge_share.push_back(1);
      }
      --edge_share[found->second];
      edge_area[found->second] += size / 3;
      own_edges[k] = found->second;
    }
  }
  for (const auto& [edge, index] : number_of) {
    own.mean_edge += norm(rest[edge[1]] - rest[edge[0]]) / static_cast<double>(number_of.size());
    for (const int p : edge) point_share[p] -= edge_share[index];
  }
  parts.push_back(own);
}

void ContactMesh::add_rod(const ContactPart& given, std::span<const Vec3d> X, std::span<const Segment> segments,
                          std::span<const int> rows) {
  ContactPart own = given;
  own.is_rod = own.is_hollow = true;
  own.first_point = point_count();
  std::vector<int> number(X.size(), -1);
  for (const Segment& segment : segments)
    for (const int v : segment) number[v] = 0;
  for (size_t v = 0; v < X.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = point_count();
    rest.push_back(X[v]);
    row.push_back(rows[v]);
    part.push_back(static_cast<int>(parts.size()));
  }
  own.point_count = point_count() - own.first_point;
  area.resize(rest.size(), 0.0);
  point_share.resize(rest.size(), 1);
  for (const Segment& segment : segments) {
    const auto [a, b] = std::minmax(number[segment[0]], number[segment[1]]);
    const double length = norm(rest[b] - rest[a]), band = 2 * own.offset * length;
    own.mean_edge += length / static_cast<double>(segments.size());
    own.mean_triangle += band / static_cast<double>(segments.size());
    for (const int p : {a, b}) area[p] += band / 2, --point_share[p];
    triangles.push_back({a, b, b});
    edges_of.push_back({-1, -1, -1});
    edges.push_back({a, b});
    edge_share.push_back(0);
    edge_area.push_back(band);
  }
  parts.push_back(own);
}

// Represents the capsule by a triangle without area whose corners are the ends.
void ContactMesh::add_capsule(const ContactPart& given, const std::array<Vec3d, 2>& ends) {
  ContactPart own = given;
  own.is_obstacle = own.is_round = true;
  own.first_point = point_count();
  own.point_count = norm(ends[1] - ends[0]) > 0 ? 2 : 1;
  own.mean_edge = own.mean_triangle = std::numeric_limits<double>::infinity();
  for (int k = 0; k < own.point_count; ++k) {
    rest.push_back(ends[k]);
    row.push_back(-1);
    part.push_back(static_cast<int>(parts.size()));
    area.push_back(0);
    point_share.push_back(0);
  }
  const int a = own.first_point, b = point_count() - 1;
  triangles.push_back({a, b, b});
  edges_of.push_back({-1, -1, -1});
  if (a < b) {
    edges.push_back({a, b});
    edge_share.push_back(0);
    edge_area.push_back(0);
  }
  parts.push_back(own);
}

void ContactMesh::add_plane(const ContactPart& given, const Vec3d& origin, const Vec3d& normal) {
  ContactPart own = given;
  own.is_obstacle = true;
  own.first_point = point_count();
  own.mean_edge = own.mean_triangle = std::numeric_limits<double>::infinity();
  planes.push_back({origin, (1 / norm(normal)) * normal, static_cast<int>(parts.size()), point_count()});
  rest.push_back(origin);
  row.push_back(-1);
  part.push_back(static_cast<int>(parts.size()));
  area.push_back(0);
  point_share.push_back(0);
  parts.push_back(own);
}

}  // namespace aspic
