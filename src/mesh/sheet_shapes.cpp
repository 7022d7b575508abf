#include "mesh/sheet_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aspic {
namespace {

constexpr double kRowPerEdge = 0.86602540378443865;  // height of an equilateral triangle

double count_along(double length, double size, double least = 1) { return std::max(least, std::round(length / size)); }

// Joins two rows of vertices, given their distances along the rows, by triangles. Each next one has the
// shorter of the two possible edges across.
void join_rows(const std::vector<std::pair<int, double>>& low, const std::vector<std::pair<int, double>>& high,
               std::vector<Triangle>& triangles) {
  size_t i = 0, j = 0;
  while (i + 1 < low.size() || j + 1 < high.size()) {
    const bool is_low = j + 1 == high.size() ||
                        (i + 1 < low.size() &&
                         std::abs(low[i + 1].second - high[j].second) <= std::abs(low[i].second - high[j + 1].second));
    triangles.push_back({low[i].first, is_low ? low[i + 1].first : high[j + 1].first, high[j].first});
    ++(is_low ? i : j);
  }
}

using Row = std::vector<std::pair<int, double>>;

double rings_in(double radius, double size) { return count_along(radius, kRowPerEdge * size); }

struct TubeCounts {
  double around, rows;
};
TubeCounts counts_in(double radius, double height, double size) {
  return {count_along(2 * std::numbers::pi * radius, size, 3), count_along(height, kRowPerEdge * size)};
}

}  // namespace

TriMesh make_rectangle(double width, double height, double size) {
  const int columns = static_cast<int>(count_along(width, size)),
            rows = static_cast<int>(count_along(height, kRowPerEdge * size));
  TriMesh mesh;
  const auto add_row = [&](int r) {
    Row row;
    const auto add = [&](double along) {
      row.emplace_back(mesh.vertex_count(), along);
      mesh.vertices.push_back({{width * (along / columns - 0.5), height * (double(r) / rows - 0.5), 0}});
    };
    if (r % 2 == 1) add(0);
    for (int c = 0; c < columns + (r + 1) % 2; ++c) add(r % 2 == 1 ? c + 0.5 : c);
    if (r % 2 == 1) add(columns);
    return row;
  };
  Row last = add_row(0);
  for (int r = 1; r <= rows; ++r) {
    Row next = add_row(r);
    join_rows(last, next, mesh.triangles);
    last = std::move(next);
  }
  return mesh;
}

TriMesh make_disc(double radius, double size) {
  const int rings = static_cast<int>(rings_in(radius, size));
  TriMesh mesh;
  mesh.vertices.push_back({});
  Row last = {{0, 0}, {0, 1}};
  for (int k = 1; k <= rings; ++k) {
    Row next;
    const int first = mesh.vertex_count();
    for (int i = 0; i <= 6 * k; ++i) {
      const double turn = double(i) / (6 * k), angle = 2 * std::numbers::pi * turn, r = radius * k / rings;
      next.emplace_back(i < 6 * k ? first + i : first, turn);
      if (i < 6 * k) mesh.vertices.push_back({{r * std::cos(angle), r * std::sin(angle), 0}});
    }
    join_rows(next, last, mesh.triangles);
    last = std::move(next);
  }
  std::erase_if(mesh.triangles, [](const Triangle& t) { return t[1] == t[2] || t[0] == t[1] || t[0] == t[2]; });
  return mesh;
}

TriMesh make_tube(double radius, double height, double size) {
  const auto [around, rows] = counts_in(radius, height, size);
  const int n = static_cast<int>(around), count = static_cast<int>(rows);
  TriMesh mesh;
  for (int r = 0; r <= count; ++r)
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + (r % 2) / 2.0) / n;
      mesh.vertices.push_back({{radius * std::cos(angle), radius * std::sin(angle), height * r / count}});
    }
  for (int r = 0; r < count; ++r)
    for (int i = 0; i < n; ++i) {
      const int a = r * n + i, b = r * n + (i + 1) % n, above = (r + 1) * n;
      const int c = above + (r % 2 == 0 ? i : (i + 1) % n), d = above + (r % 2 == 0 ? (i + n - 1) % n : i);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

double triangles_in_rectangle(double width, double height, double size) {
  return count_along(height, kRowPerEdge * size) * (2 * count_along(width, size) + 1);
}

double triangles_in_disc(double radius, double size) {
  const double rings = rings_in(radius, size);
  return 6 * rings * rings;
}

double triangles_in_tube(double radius, double height, double size) {
  const auto [around, rows] = counts_in(radius, height, size);
  return 2 * around * rows;
}

}  // namespace aspic
