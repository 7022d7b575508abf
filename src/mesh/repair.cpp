#include <algorithm>
#include <cmath>
#include <map>

#include "base/formatted.h"
#include "mesh/close_corners.h"
#include "mesh/doctor.h"
#include "mesh/surface_orientation.h"
#include "mesh/tet_shape.h"
#include "mesh/topology.h"

namespace aspic {
namespace {

using Actions = std::vector<std::string>;

void record(Actions& actions, const std::string& what, size_t count, const std::string& noun) {
  if (count > 0) actions.push_back(what + " " + std::to_string(count) + " " + noun);
}

template <class Element>
bool indices_are_valid(const std::vector<Element>& elements, size_t vertex_count) {
  for (const Element& element : elements)
    for (int v : element)
      if (v < 0 || static_cast<size_t>(v) >= vertex_count) return false;
  return true;
}

// Returns the number of removed elements.
template <class Element>
size_t drop_unreferenced(std::vector<Vec3d>& vertices, std::vector<Element>& elements) {
  std::vector<int> number(vertices.size(), -1);
  for (const Element& element : elements)
    for (int v : element) number[v] = 0;
  int kept = 0;
  for (size_t v = 0; v < vertices.size(); ++v) {
    if (number[v] < 0) continue;
    vertices[kept] = vertices[v];
    number[v] = kept++;
  }
  const size_t dropped = vertices.size() - kept;
  vertices.resize(kept);
  for (Element& element : elements)
    for (int& v : element) v = number[v];
  return dropped;
}

// Requires that all vertices are used. Returns the number of vertices merged into an earlier one.
template <class Element>
size_t merge_duplicates(std::vector<Vec3d>& vertices, std::vector<Element>& elements) {
  const std::vector<int> first = first_at_same_place(vertices);
  for (Element& element : elements)
    for (int& v : element) v = first[v];
  return drop_unreferenced(vertices, elements);
}

void merge_agreeing_corners(TriMesh& mesh, Actions& actions) {
  const double tolerance = corner_tolerance(mesh);
  const std::vector<int> first = first_agreeing_corner(mesh);
  for (Triangle& triangle : mesh.triangles)
    for (int& v : triangle) v = first[v];
  record(actions, "merged", drop_unreferenced(mesh.vertices, mesh.triangles),
         "corners of open edges into others that agree up to rounding (within 1e-6 of the diagonal, " +
             three_digits(tolerance) + ")");
}

template <class Keep>
size_t remove_tets(TetMesh& mesh, Keep keep) {
  int kept = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    if (!keep(t)) continue;
    mesh.tets[kept] = mesh.tets[t];
    if (!mesh.region.empty()) mesh.region[kept] = mesh.region[t];
    ++kept;
  }
  const size_t removed = mesh.tets.size() - kept;
  mesh.tets.resize(kept);
  if (!mesh.region.empty()) mesh.region.resize(kept);
  return removed;
}

bool has_volume(const TetMesh& mesh, int tet) {
  const TetCorners X = corners(mesh, tet);
  return !lists_vertex_twice(mesh.tets[tet]) && !(std::abs(signed_volume(X)) <= flat_volume(X));
}

size_t turn_inverted(TetMesh& mesh) {
  size_t turned = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    if (!(volume(mesh, t) < 0)) continue;
    std::swap(mesh.tets[t][2], mesh.tets[t][3]);
    ++turned;
  }
  return turned;
}

template <class Element>
std::vector<bool> is_repeated(const std::vector<Element>& elements) {
  std::vector<bool> flags(elements.size());
  for (int e : repeated_elements(elements)) flags[e] = true;
  return flags;
}

size_t remove_triangles(TriMesh& mesh, const std::vector<bool>& remove) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    if (!remove[t]) mesh.triangles[kept++] = mesh.triangles[t];
  const size_t removed = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  return removed;
}

// Returns the number of edges that an odd number of triangles share.
size_t odd_edges(const TriMesh& mesh, const std::vector<bool>& remove) {
  std::vector<Triangle> kept;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    if (!remove[t]) kept.push_back(mesh.triangles[t]);
  size_t odd = 0;
  for_each_edge(edge_uses(kept), [&](const EdgeUse* first, const EdgeUse* last) { odd += (last - first) % 2; });
  return odd;
}

// Returns whether the triangle is an even permutation of its sorted vertices.
bool runs_forward(const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return (a < b) + (b < c) + (c < a) == 2;
}

// Marks pairs of triangles with the same vertices and opposite orientation, which enclose no volume.
std::vector<bool> back_to_back(const TriMesh& mesh) {
  std::map<Triangle, std::vector<size_t>> unpaired;  // unpaired triangles of one orientation
  std::vector<bool> paired(mesh.triangles.size());
  for (size_t t = 0; t < paired.size(); ++t) {
    Triangle key = mesh.triangles[t];
    std::sort(key.begin(), key.end());
    std::vector<size_t>& others = unpaired[key];
    if (!others.empty() && runs_forward(mesh.triangles[others.back()]) != runs_forward(mesh.triangles[t])) {
      paired[t] = paired[others.back()] = true;
      others.pop_back();
    } else {
      others.push_back(t);
    }
  }
  return paired;
}

// Removes back-to-back pairs, if this leaves fewer open edges than keeping one triangle of each pair (for surfaces that
// list both sides). Returns the number of removed triangles.
size_t cancel_pairs(TriMesh& mesh) {
  const std::vector<bool> pairs = back_to_back(mesh), repeated = is_repeated(mesh.triangles);
  return odd_edges(mesh, pairs) < odd_edges(mesh, repeated) ? remove_triangles(mesh, pairs) : 0;
}

}  // namespace

std::vector<std::string> repair(TetMesh& mesh) {
  Actions actions;
  if (!indices_are_valid(mesh.tets, mesh.rest.size())) return actions;
  record(actions, "dropped", drop_unreferenced(mesh.rest, mesh.tets), "unreferenced vertices");
  record(actions, "merged", merge_duplicates(mesh.rest, mesh.tets), "duplicate vertices into those at the same place");
  record(actions, "removed", remove_tets(mesh, [&](int t) { return has_volume(mesh, t); }), "tets of zero volume");
  record(actions, "flipped", turn_inverted(mesh), "inverted tets");
  const std::vector<bool> repeated = is_repeated(mesh.tets);
  record(actions, "removed", remove_tets(mesh, [&](int t) { return !repeated[t]; }), "repeated tets");
  record(actions, "dropped", drop_unreferenced(mesh.rest, mesh.tets), "vertices that only removed tets used");
  return actions;
}

std::vector<std::string> repair(TriMesh& mesh) {
  Actions actions;
  if (!indices_are_valid(mesh.triangles, mesh.vertices.size())) return actions;
  record(actions, "dropped", drop_unreferenced(mesh.vertices, mesh.triangles), "unreferenced vertices");
  record(actions, "merged", merge_duplicates(mesh.vertices, mesh.triangles),
         "duplicate vertices into those at the same place");
  merge_agreeing_corners(mesh, actions);
  std::vector<bool> twice(mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) twice[t] = lists_vertex_twice(mesh.triangles[t]);
  record(actions, "removed", remove_triangles(mesh, twice), "triangles that list a vertex twice");
  record(actions, "removed", cancel_pairs(mesh), "triangles in back-to-back pairs");
  record(actions, "removed", remove_triangles(mesh, is_repeated(mesh.triangles)), "repeated triangles");
  record(actions, "flipped", orient(mesh), "triangles with the wrong orientation");
  record(actions, "dropped", drop_unreferenced(mesh.vertices, mesh.triangles),
         "vertices that only removed triangles used");
  return actions;
}

}  // namespace aspic
