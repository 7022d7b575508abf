// Collects and formats findings for tet meshes and surfaces.
#pragma once
#include <string>
#include <vector>

#include "mesh/box.h"
#include "mesh/doctor.h"

namespace aspic {

// Returns a phrase like "3 of 600 tets are inverted" from the count, the total, a noun and a predicate.
std::string count_of(size_t count, size_t total, const std::string& noun, const std::string& what);

class Findings {
 public:
  // Adds the finding if it lists an index.
  void add(Finding finding) {
    if (!finding.indices.empty()) list_.push_back(std::move(finding));
  }
  void add_general(Finding finding) { list_.push_back(std::move(finding)); }  // for findings about the whole mesh
  std::vector<Finding> take() { return std::move(list_); }

 private:
  std::vector<Finding> list_;
};

// Examines points and the elements that use them. Returns false if indices or coordinates are unusable, so that the
// mesh must not be examined further.
template <class Element>
bool examine_vertices(const std::vector<Vec3d>& vertices, const std::vector<Element>& elements, const std::string& noun,
                      Findings& findings);

// "extent 70 m; if ... use scale = ..." for extents that are rare in meters, otherwise empty.
std::string unit_hint(const Box& box);
void examine_units(const std::vector<Vec3d>& vertices, Findings& findings);
// parts: the tets of each component
void examine_components(const TetMesh& mesh, const std::vector<std::vector<int>>& parts, Findings& findings);
void examine_components(const TriMesh& mesh, Findings& findings);

}  // namespace aspic
