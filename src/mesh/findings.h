// How findings are worded. Shared by the examinations of tets and of surfaces.
#pragma once
#include <string>
#include <vector>

#include "mesh/doctor.h"

namespace aspic {

std::string number(double value);  // three significant digits

// "3 of 600 tets are inverted": the size of the list, the total, and a predicate.
std::string count_of(size_t count, size_t total, const std::string& noun, const std::string& what);

class Findings {
 public:
  // Adds nothing when no index is listed.
  void add(Finding finding) {
    if (!finding.indices.empty()) list_.push_back(std::move(finding));
  }
  void add_general(Finding finding) { list_.push_back(std::move(finding)); }  // about the mesh as a whole
  std::vector<Finding> take() { return std::move(list_); }

 private:
  std::vector<Finding> list_;
};

// What can be said of points alone, with the elements that use them. `false`: indices or coordinates are unusable and
// nothing more should be asked of the mesh.
template <class Element>
bool examine_vertices(const std::vector<Vec3d>& vertices, const std::vector<Element>& elements, const std::string& noun,
                      Findings& findings);

void examine_units(const std::vector<Vec3d>& vertices, Findings& findings);
void examine_components(const TetMesh& mesh, Findings& findings);
void examine_components(const TriMesh& mesh, Findings& findings);

}  // namespace aspic
