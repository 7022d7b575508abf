#include "scene/selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"
#include "mesh/vertices.h"
#include "scene/expression.h"
#include "scene/placement.h"

namespace aspic {
namespace {

// Selections by height extend slightly beyond their fraction, so that a flat base is complete despite round-off.
constexpr double kHeightSlack = 1e-9;

std::pair<double, double> heights_of(const SelectionScope& scope) {
  if (scope.whole) return scope.whole->heights(scope.up);
  double low = INFINITY, high = -INFINITY;
  for (const Vec3d& X : scope.mesh.rest) low = std::min(low, dot(scope.up, X)), high = std::max(high, dot(scope.up, X));
  return {low, high};
}

Predicate by_height(const SelectionScope& scope, double lowest, double highest) {
  const auto [low, high] = heights_of(scope);
  const double height = high - low, slack = kHeightSlack * height;
  const double below = low + lowest * height + slack, above = high - highest * height - slack;
  const Vec3d up = scope.up;
  if (highest < 0) return [up, below](const Vec3d& X) { return dot(up, X) <= below; };
  return [up, above](const Vec3d& X) { return dot(up, X) >= above; };
}

Predicate geometric(const Value& where, const SelectionScope& scope) {
  if (where.is_text()) {
    const Expression formula(where.text());
    return [formula](const Vec3d& X) { return formula.holds_at(X); };
  }
  if (const Value* box = where.find("box")) {
    const Vec3d lower = (*box)["lower"].vector(), upper = (*box)["upper"].vector();
    return [lower, upper](const Vec3d& X) {
      for (int i = 0; i < 3; ++i)
        if (!(X[i] >= lower[i] && X[i] <= upper[i])) return false;
      return true;
    };
  }
  if (const Value* sphere = where.find("sphere")) {
    const Vec3d center = (*sphere)["center"].vector();
    const double radius = (*sphere)["radius"].number();
    return [center, radius](const Vec3d& X) { return dot(X - center, X - center) <= radius * radius; };
  }
  if (const Value* lowest = where.find("lowest")) return by_height(scope, lowest->number(), -1);
  return by_height(scope, -1, where["highest"].number());
}

std::vector<char> painted_vertices(const Value& where, const SelectionScope& scope) {
  if (!scope.painted)
    throw error_at(where.place, "painted selections need a scene; use a formula, box, sphere or vertices");
  const double above = where["above"].number(),
               largest = *std::max_element(scope.painted->begin(), scope.painted->end());
  if (!(largest > above))
    throw error_at(where.place, "where selects nothing of body '" + scope.body + "': the largest value of " +
                                    toml_string(where["name"].text()) + " is " + number_text(largest) + ", not above " +
                                    number_text(above));
  std::vector<char> listed;
  for (const double value : *scope.painted) listed.push_back(value > above);
  return listed;
}

// The name of a group for messages: 'outlet' (3), or 3.
std::string group_text(const SurfaceGroup& group) {
  const std::string label = std::to_string(group.label);
  return group.name.empty() ? label : "'" + group.name + "' (" + label + ")";
}

// Returns the triangles of the surfaces of the mesh file with the name or number `surface`.
std::vector<Triangle> triangles_of(const Value& surface, const SelectionScope& scope) {
  const std::string which = "surface = " + shortened(inline_toml(surface));
  if (scope.whole)
    throw error_at(surface.place, which +
                                      "; several processes do not read the surfaces of mesh files (use a formula "
                                      "or vertices)");
  static const MeshGroups none;
  std::vector<Triangle> triangles;
  std::string known;
  for (const SurfaceGroup& group : (scope.groups ? *scope.groups : none).surfaces) {
    const bool is_chosen = surface.is_text() ? group.name == surface.text() : group.label == surface.integer();
    if (is_chosen) triangles.insert(triangles.end(), group.triangles.begin(), group.triangles.end());
    known += (known.empty() ? "" : ", ") + group_text(group);
  }
  if (!triangles.empty()) return triangles;
  throw error_at(surface.place,
                 which + "; the mesh of body '" + scope.body + "' has " +
                     (known.empty() ? "no surfaces (save physical surfaces of Gmsh or references of Medit with it, or "
                                      "select by a formula)"
                                    : "the surfaces " + elided(known, 300)));
}

const Value* surface_in(const Value& where) { return where.is_table() ? where.find("surface") : nullptr; }

// Corners of the selected triangles, each ascending; sorted.
std::vector<Triangle> sorted_triangles(const Value& surface, const SelectionScope& scope) {
  std::vector<Triangle> triangles = triangles_of(surface, scope);
  for (Triangle& triangle : triangles) std::sort(triangle.begin(), triangle.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Flags the corners of the triangles, and the mid-edge nodes of their edges.
std::vector<char> vertices_of(const std::vector<Triangle>& triangles, const TetMesh& mesh) {
  std::vector<char> listed(mesh.rest.size(), 0);
  std::vector<std::array<int, 2>> edges;
  for (const Triangle& t : triangles)
    for (int c = 0; c < 3; ++c) {
      listed[t[c]] = 1;
      edges.push_back({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
    }
  std::sort(edges.begin(), edges.end());
  for (size_t t = 0; t < mesh.mids.size(); ++t)
    for (int k = 0; k < 6; ++k) {
      const int a = mesh.tets[t][kTetEdges[k][0]], b = mesh.tets[t][kTetEdges[k][1]];
      if (std::binary_search(edges.begin(), edges.end(), std::array{std::min(a, b), std::max(a, b)}))
        listed[mesh.mids[t][k]] = 1;
    }
  return listed;
}

// One flag per vertex of the body for a list of indices, a surface or painted values; empty for other selections.
// Between two listed corners, the mid-edge node is listed too.
std::vector<char> listed_vertices(const Value& where, const SelectionScope& scope) {
  if (where.is_table() && where.find("file")) return painted_vertices(where, scope);
  if (const Value* surface = surface_in(where)) return vertices_of(triangles_of(*surface, scope), scope.mesh);
  const Value* list = where.is_table() ? where.find("vertices") : nullptr;
  if (!list) return {};
  std::vector<char> listed(std::max<size_t>(1, scope.mesh.rest.size()), 0);  // not empty for a part without vertices
  const int count = scope.whole ? scope.whole->vertex_count() : scope.mesh.vertex_count();
  for (const Value& index : list->array()) {
    const std::int64_t i = std::get<std::int64_t>(index.data);
    if (i >= count)
      throw error_at(index.place, "vertices: " + std::to_string(i) + " is beyond the last vertex of body '" +
                                      scope.body + "', " + std::to_string(count - 1));
    const int v = scope.whole ? scope.whole->vertex_of_part(static_cast<int>(i)) : static_cast<int>(i);
    if (v >= 0) listed[v] = 1;
  }
  for (const MidNodes& mids : scope.mesh.mids) {
    const Tet& corners = scope.mesh.tets[&mids - scope.mesh.mids.data()];
    for (int k = 0; k < 6; ++k)
      if (listed[corners[kTetEdges[k][0]]] && listed[corners[kTetEdges[k][1]]]) listed[mids[k]] = 1;
  }
  return listed;
}

InvalidInput nothing_selected(const Value& where, const SelectionScope& scope, const char* what) {
  const Box box = scope.whole ? scope.whole->box() : bounding_box(scope.mesh.rest);
  return error_at(where.place, "where = " + shortened(inline_toml(where)) + " selects no " + what + " of body '" +
                                   scope.body + "', which extends from " + point_text(box.lower) + " to " +
                                   point_text(box.upper));
}

// `has_own(element)`: whether it has a vertex that belongs to this part of the body.
template <class Selected, class HasOwn>
void require_some(const Selected& selected, const HasOwn& has_own, const Value& where, const SelectionScope& scope,
                  const char* what) {
  if (scope.whole) {
    scope.whole->note_selection(nothing_selected(where, scope, what).what(),
                                std::any_of(selected.begin(), selected.end(), has_own));
  } else if (selected.empty()) {
    throw nothing_selected(where, scope, what);
  }
}

template <class Corners>
bool any_own(const SelectionScope& scope, const Corners& corners) {
  return std::any_of(corners.begin(), corners.end(), [&](int v) { return scope.whole->is_own(v); });
}

// Runs `select`, whose formulas may fail at a point, and adds the place.
template <class Select>
auto placed(const Value& where, const Select& select) {
  try {
    return select();
  } catch (const InvalidInput& e) {
    const std::string text = e.what();
    if (text.starts_with(to_string(where.place))) throw;
    throw error_at(where.place, text);
  }
}

const Triangle& corners_of(const Triangle& triangle) { return triangle; }
const Triangle& corners_of(const Face& face) { return face.corners; }

template <class Element>
std::vector<Element> selected_elements(const Value& where, const SelectionScope& scope,
                                       const std::vector<Element>& boundary) {
  const Value* surface = surface_in(where);
  const std::vector<Triangle> of_surface = surface ? sorted_triangles(*surface, scope) : std::vector<Triangle>();
  const std::vector<char> listed = listed_vertices(where, scope);
  const std::vector<Element> selected = placed(where, [&] {
    const Predicate holds = listed.empty() ? geometric(where, scope) : nullptr;
    const auto is_listed = [&](const Triangle& t) {
      if (!surface) return listed[t[0]] && listed[t[1]] && listed[t[2]];
      Triangle ascending = t;
      std::sort(ascending.begin(), ascending.end());
      return std::binary_search(of_surface.begin(), of_surface.end(), ascending);
    };
    const std::vector<Vec3d>& X = scope.mesh.rest;
    std::vector<Element> result;
    for (const Element& element : boundary) {
      const Triangle& t = corners_of(element);
      const Vec3d center = (1.0 / 3) * (X[t[0]] + X[t[1]] + X[t[2]]);
      if (holds ? holds(center) : is_listed(t)) result.push_back(element);
    }
    return result;
  });
  const auto has_own = [&](const Element& element) { return any_own(scope, corners_of(element)); };
  require_some(selected, has_own, where, scope, "boundary triangle");
  return selected;
}

}  // namespace

std::vector<int> select_vertices(const Value& where, const SelectionScope& scope) {
  const std::vector<char> listed = listed_vertices(where, scope);
  const std::vector<int> selected = placed(where, [&] {
    const Predicate holds = listed.empty() ? geometric(where, scope) : nullptr;
    std::vector<int> result;
    for (int v = 0; v < scope.mesh.vertex_count(); ++v)
      if (holds ? holds(scope.mesh.rest[v]) : listed[v]) result.push_back(v);
    return result;
  });
  require_some(
      selected, [&](int v) { return scope.whole->is_own(v); }, where, scope, "vertex");
  return selected;
}

std::vector<int> select_tets(const Value& where, const SelectionScope& scope) {
  if (const Value* surface = surface_in(where))
    throw error_at(surface->place, "surface = " + shortened(inline_toml(*surface)) +
                                       "; a surface has no tets (use a [[body.traction]], or a formula)");
  const std::vector<char> listed = listed_vertices(where, scope);
  const std::vector<int> selected = placed(where, [&] {
    const Predicate holds = listed.empty() ? geometric(where, scope) : nullptr;
    const auto is_listed = [&](int v) { return listed[v] != 0; };
    std::vector<int> result;
    for (int t = 0; t < scope.mesh.tet_count(); ++t) {
      const Tet& tet = scope.mesh.tets[t];
      if (holds ? holds(centroid(scope.mesh, t)) : std::all_of(tet.begin(), tet.end(), is_listed)) result.push_back(t);
    }
    return result;
  });
  require_some(
      selected, [&](int t) { return any_own(scope, scope.mesh.tets[t]); }, where, scope, "tet");
  return selected;
}

std::vector<Triangle> select_triangles(const Value& where, const SelectionScope& scope,
                                       const std::vector<Triangle>& boundary) {
  return selected_elements(where, scope, boundary);
}

std::vector<Face> select_faces(const Value& where, const SelectionScope& scope, const std::vector<Face>& boundary) {
  return selected_elements(where, scope, boundary);
}

}  // namespace aspic
