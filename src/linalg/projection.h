// Modified Hessians: how elements with negative eigenvalues are treated.
#pragma once
#include <span>

namespace aspic {

// exact: unmodified; clamped: negative eigenvalues become a small positive number; absolute: negative eigenvalues
// become their absolute values.
enum class Definiteness { exact, clamped, absolute };

struct Projection {
  Definiteness kind = Definiteness::exact;
  std::span<const char> vertices = {};  // only elements with a marked vertex are modified; empty: all elements

  bool clamps_stencils = false;  // whether Hessians of stencils, such as contact, are clamped even if kind is exact

  bool covers(int vertex) const { return vertices.empty() || vertices[vertex]; }
};

}  // namespace aspic
