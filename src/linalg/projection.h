// What becomes of the negative curvature of a Hessian that is a sum over elements.
#pragma once
#include <span>

namespace aspic {

// Of an element whose Hessian has negative eigenvalues: leave it, raise them to a small positive number, or take their
// absolute value.
enum class Definiteness { exact, clamped, absolute };

struct Projection {
  Definiteness kind = Definiteness::exact;
  std::span<const char> vertices = {};  // only elements with a vertex marked here are touched; empty: all of them

  bool covers(int vertex) const { return vertices.empty() || vertices[vertex]; }
};

}  // namespace aspic
