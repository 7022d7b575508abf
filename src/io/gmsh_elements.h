// What the numbers of a .msh file mean: the table of element types, and tags that are neither ordered nor dense.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace aspic {

struct GmshElementType {
  int number, dimension, nodes;
  std::string_view name;
};
inline constexpr int kGmshTriangle = 2, kGmshQuadrangle = 3, kGmshTet = 4;

const GmshElementType* gmsh_element_type(int number);  // null when unknown [Gmsh reference manual, MSH file format]

// Vertex tag -> position in the file, which is the index of the vertex.
class GmshTags {
 public:
  void add(int64_t tag) { tags_.push_back(tag); }
  std::optional<int64_t> prepare();  // after the last add(); the tag that occurs twice, if any
  std::optional<int> index(int64_t tag) const;

 private:
  std::vector<int64_t> tags_;
  std::vector<std::pair<int64_t, int>> sorted_;  // empty when the tags are consecutive
};

}  // namespace aspic
