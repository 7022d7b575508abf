#include "io/gmsh_elements.h"

#include <algorithm>

namespace aspic {

const GmshElementType* gmsh_element_type(int number) {
  static constexpr GmshElementType kTypes[] = {
      {1, 1, 2, "2-node lines"},
      {kGmshTriangle, 2, 3, "3-node triangles"},
      {kGmshQuadrangle, 2, 4, "4-node quadrangles"},
      {kGmshTet, 3, 4, "4-node tets"},
      {5, 3, 8, "8-node hexahedra"},
      {6, 3, 6, "6-node prisms"},
      {7, 3, 5, "5-node pyramids"},
      {8, 1, 3, "3-node lines (second order)"},
      {9, 2, 6, "6-node triangles (second order)"},
      {10, 2, 9, "9-node quadrangles (second order)"},
      {kGmshQuadraticTet, 3, 10, "10-node tets (second order)"},
      {12, 3, 27, "27-node hexahedra (second order)"},
      {13, 3, 18, "18-node prisms (second order)"},
      {14, 3, 14, "14-node pyramids (second order)"},
      {15, 0, 1, "points"},
      {16, 2, 8, "8-node quadrangles (second order)"},
      {17, 3, 20, "20-node hexahedra (second order)"},
      {18, 3, 15, "15-node prisms (second order)"},
      {19, 3, 13, "13-node pyramids (second order)"},
      {20, 2, 9, "9-node triangles (third order)"},
      {21, 2, 10, "10-node triangles (third order)"},
      {22, 2, 12, "12-node triangles (fourth order)"},
      {23, 2, 15, "15-node triangles (fourth order)"},
      {24, 2, 15, "15-node triangles (fifth order)"},
      {25, 2, 21, "21-node triangles (fifth order)"},
      {26, 1, 4, "4-node lines (third order)"},
      {27, 1, 5, "5-node lines (fourth order)"},
      {28, 1, 6, "6-node lines (fifth order)"},
      {29, 3, 20, "20-node tets (third order)"},
      {30, 3, 35, "35-node tets (fourth order)"},
      {31, 3, 56, "56-node tets (fifth order)"},
      {92, 3, 64, "64-node hexahedra (third order)"},
      {93, 3, 125, "125-node hexahedra (fourth order)"},
  };
  const auto type = std::find_if(std::begin(kTypes), std::end(kTypes),
                                 [number](const GmshElementType& t) { return t.number == number; });
  return type == std::end(kTypes) ? nullptr : type;
}

int gmsh_face_corners(int type) {
  constexpr int kQuadraticTriangle = 9, kQuadraticQuadrangle = 10, kSerendipityQuadrangle = 16;
  if (type == kGmshTriangle || type == kQuadraticTriangle) return 3;
  return type == kGmshQuadrangle || type == kQuadraticQuadrangle || type == kSerendipityQuadrangle ? 4 : 0;
}

std::optional<int64_t> GmshTags::prepare() {
  // Differences of unsigned numbers cannot overflow.
  bool is_consecutive = true;
  for (size_t i = 0; i < tags_.size() && is_consecutive; ++i)
    is_consecutive = static_cast<uint64_t>(tags_[i]) - static_cast<uint64_t>(tags_[0]) == i;
  if (is_consecutive) return std::nullopt;
  sorted_.reserve(tags_.size());
  for (size_t i = 0; i < tags_.size(); ++i) sorted_.emplace_back(tags_[i], static_cast<int>(i));
  std::sort(sorted_.begin(), sorted_.end());
  const auto twice = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                        [](const auto& a, const auto& b) { return a.first == b.first; });
  return twice == sorted_.end() ? std::nullopt : std::optional(twice->first);
}

std::optional<int> GmshTags::index(int64_t tag) const {
  if (sorted_.empty()) {
    if (tags_.empty()) return std::nullopt;
    const uint64_t offset = static_cast<uint64_t>(tag) - static_cast<uint64_t>(tags_[0]);
    return offset < tags_.size() ? std::optional(static_cast<int>(offset)) : std::nullopt;
  }
  const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(tag, 0));
  return found != sorted_.end() && found->first == tag ? std::optional(found->second) : std::nullopt;
}

}  // namespace aspic
