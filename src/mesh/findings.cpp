#include "mesh/findings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "base/formatted.h"
#include "mesh/box_tree.h"
#include "mesh/components.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

template <class Element>
std::vector<int> with_invalid_index(const std::vector<Element>& elements, size_t vertex_count) {
  std::vector<int> invalid;
  for (size_t e = 0; e < elements.size(); ++e)
    if (std::any_of(elements[e].begin(), elements[e].end(),
                    [&](int v) { return v < 0 || static_cast<size_t>(v) >= vertex_count; }))
      invalid.push_back(static_cast<int>(e));
  return invalid;
}

std::vector<int> not_finite(const std::vector<Vec3d>& vertices) {
  std::vector<int> list;
  for (size_t v = 0; v < vertices.size(); ++v)
    if (!std::isfinite(vertices[v][0] + vertices[v][1] + vertices[v][2])) list.push_back(static_cast<int>(v));
  return list;
}

std::vector<int> too_large(const std::vector<Vec3d>& vertices) {
  std::vector<int> list;
  for (size_t v = 0; v < vertices.size(); ++v)
    if (std::any_of(vertices[v].a, vertices[v].a + 3, [](double x) { return std::abs(x) > kLargestCoordinate; }))
      list.push_back(static_cast<int>(v));
  return list;
}

std::vector<int> duplicates(const std::vector<Vec3d>& vertices) {
  const std::vector<int> first = first_at_same_place(vertices);
  std::vector<int> list;
  for (size_t v = 0; v < first.size(); ++v)
    if (first[v] != static_cast<int>(v)) list.push_back(static_cast<int>(v));
  return list;
}

template <class Element>
std::vector<int> unreferenced(const std::vector<Element>& elements, size_t vertex_count) {
  std::vector<bool> used(vertex_count);
  for (const Element& element : elements)
    for (int v : element) used[v] = true;
  std::vector<int> list;
  for (size_t v = 0; v < vertex_count; ++v)
    if (!used[v]) list.push_back(static_cast<int>(v));
  return list;
}

}  // namespace

std::string count_of(size_t count, size_t total, const std::string& noun, const std::string& what) {
  return std::to_string(count) + " of " + std::to_string(total) + " " + noun + " " + what;
}

template <class Element>
bool examine_vertices(const std::vector<Vec3d>& vertices, const std::vector<Element>& elements, const std::string& noun,
                      Findings& findings) {
  const size_t total = vertices.size();
  const std::vector<int> invalid = with_invalid_index(elements, total), infinite = not_finite(vertices);
  if (elements.empty())
    findings.add_general({Severity::error, "empty_mesh", "the mesh has no " + noun, "check the file and its format"});
  findings.add({Severity::error, "invalid_indices",
                count_of(invalid.size(), elements.size(), noun, "refer to a vertex that does not exist"),
                "write the file again; indices start at 1 in some formats and at 0 in others", invalid});
  findings.add({Severity::error, "non_finite_coordinates",
                count_of(infinite.size(), total, "vertices", "have an infinite or NaN coordinate"), "correct the file",
                infinite});
  if (elements.empty() || !invalid.empty() || !infinite.empty()) return false;
  const std::vector<int> large = too_large(vertices);
  findings.add({Severity::error, "coordinates_too_large",
                count_of(large.size(), total, "vertices",
                         "have a coordinate beyond " + three_digits(kLargestCoordinate) + " m, where volumes overflow"),
                "choose a larger unit of length, or correct the file", large});
  if (!large.empty()) return false;
  const std::vector<int> repeated = duplicates(vertices), unused = unreferenced(elements, total);
  // A vertex without tets has no mass, so no solver can move it. Beside a surface it is harmless.
  constexpr Severity severity = std::tuple_size_v<Element> == 4 ? Severity::error : Severity::note;
  findings.add({Severity::warning, "duplicate_vertices",
                count_of(repeated.size(), total, "vertices",
                         "coincide with an earlier vertex, so the mesh is not connected there"),
                "merge them with --repair", repeated});
  findings.add({severity, "unreferenced_vertices",
                count_of(unused.size(), total, "vertices", "belong to none of the " + noun),
                "remove them with --repair", unused});
  return true;
}
template bool examine_vertices(const std::vector<Vec3d>&, const std::vector<Tet>&, const std::string&, Findings&);
template bool examine_vertices(const std::vector<Vec3d>&, const std::vector<Triangle>&, const std::string&, Findings&);

std::string unit_hint(const Box& box) {
  constexpr double kLargest = 10, kSmallest = 1e-3, kLargestInCentimeters = 1000;  // [m] usual range of soft bodies
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) extent = std::max(extent, box.upper[axis] - box.lower[axis]);
  const std::string begin = "extent " + three_digits(extent) + " m; if the file is in ";
  if (extent < kSmallest) return begin + "kilometers use scale = 1000";
  if (!(extent > kLargest)) return "";
  return begin + "millimeters use scale = 0.001" +
         (extent < kLargestInCentimeters
              ? ", in centimeters 0.01: " + three_digits(0.001 * extent) + " m or " + three_digits(0.01 * extent) + " m"
              : "");
}

void examine_units(const std::vector<Vec3d>& vertices, Findings& findings) {
  Box box;
  for (const Vec3d& x : vertices) box.add(x);
  const std::string hint = unit_hint(box);
  if (!hint.empty())
    findings.add_general(
        {Severity::note, "suspicious_units", hint, "set scale in the scene if the file is not in meters"});
}

namespace {

// Returns whether merging vertices at equal positions would connect parts of the mesh.
template <class Element>
bool are_joined_by_merging(const std::vector<std::vector<int>>& parts, const std::vector<Element>& elements,
                           const std::vector<Vec3d>& vertices) {
  std::vector<int> part_at(vertices.size(), -1);  // part at each position, by the first vertex there
  const std::vector<int> first = first_at_same_place(vertices);
  for (size_t p = 0; p < parts.size(); ++p)
    for (const int e : parts[p])
      for (const int v : elements[e]) {
        int& part = part_at[first[v]];
        if (part >= 0 && part != static_cast<int>(p)) return true;
        part = static_cast<int>(p);
      }
  return false;
}

void add_components(const std::vector<std::vector<int>>& components, const std::string& noun, bool are_joined,
                    Findings& findings) {
  const auto smaller = [](const auto& a, const auto& b) { return a.size() < b.size(); };
  const auto& smallest = *std::min_element(components.begin(), components.end(), smaller);
  Finding finding{Severity::note, "several_components",
                  "the mesh consists of " + std::to_string(components.size()) +
                      " parts that share no vertex; the smallest has " + std::to_string(smallest.size()) + " " + noun,
                  are_joined ? "if it should be one body, merge the duplicate vertices with --repair"
                             : "if it should be one body, join the parts in the source model"};
  for (const auto& component : components) finding.indices.push_back(component.front());
  findings.add(std::move(finding));
}

}  // namespace

void examine_components(const TetMesh& mesh, const std::vector<std::vector<int>>& parts, Findings& findings) {
  if (parts.size() > 1) add_components(parts, "tets", are_joined_by_merging(parts, mesh.tets, mesh.rest), findings);
}

void examine_components(const TriMesh& mesh, Findings& findings) {
  const auto parts = triangle_components(mesh);
  if (parts.size() > 1)
    add_components(parts, "triangles", are_joined_by_merging(parts, mesh.triangles, mesh.vertices), findings);
}

}  // namespace aspic
