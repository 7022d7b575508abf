// Modified Hessians: how elements with negative eigenvalues are treated.
#pragma once
#include <span>

namespace aspic {

// exact: unchanged; clamped: negative eigenvalues are raised to a small positive number; absolute: their absolute
// values.
enum class Definiteness { exact, clamped, absolute };

struct Projection {
  Definiteness kind = Definiteness::exact;
  std::span<const char> vertices = {};  // only elements with a marked vertex are modified; empty: all elements

  bool covers(int vertex) const { return vertices.empty() || vertices[vertex]; }
};

}  // namespace aspic
