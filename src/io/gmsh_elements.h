// Element types and tags of .msh files. Tags are neither ordered nor dense.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace aspic {

struct GmshElementType {
  int number, dimension, nodes;
  std::string_view name;
};
inline constexpr int kGmshTriangle = 2, kGmshQuadrangle = 3, kGmshTet = 4, kGmshQuadraticTet = 11;
// Number of corners of a face of first or second order; 0 for other elements.
int gmsh_face_corners(int type);

const GmshElementType* gmsh_element_type(int number);  // null if unknown [Gmsh reference manual, MSH file format]

// Maps vertex tags to positions in the file, which are the vertex indices.
class GmshTags {
 public:
  void add(int64_t tag) { tags_.push_back(tag); }
  std::optional<int64_t> prepare();  // call after the last add(); returns a duplicate tag, if any
  std::optional<int> index(int64_t tag) const;

 private:
  std::vector<int64_t> tags_;
  std::vector<std::pair<int64_t, int>> sorted_;  // empty if the tags are consecutive
};

}  // namespace aspic
