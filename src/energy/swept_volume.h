// Volume W(x) that a surface patch sweeps outward from rest to x, see pressure.h.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "energy/energy.h"
#include "energy/quadratic_face.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"

namespace aspic {

class SweptVolume {
 public:
  SweptVolume(const TetMesh& mesh,
              std::span<const Face> patch);  // boundary faces of the mesh, which need not outlive it

  double value(Positions x) const;                                          // [m^3]
  void add_gradient(Positions x, double scale, std::span<double> g) const;  // g += scale dW/dx
  void add_couplings(Couplings& couplings) const;
  void bind(const BlockPattern& pattern);
  // H += scale pressure d2W/dx2. Returns the number of modified elements.
  int add_hessian(Positions x, double pressure, double scale, const Projection& projection, BlockSparse& H) const;

 private:
  // A linear triangle, or the one that represents a quadratic face at a quadrature point.
  struct Element {
    const FacePoint* point;
    int node_count;
    std::array<int, 6> node;
    std::array<Vec3d, 6> rest;       // X of the nodes, the corners of the face first
    std::array<int64_t, 36> slot{};  // blocks (i, j) of the larger and the smaller node

    std::span<const int> nodes() const { return std::span(node).first(node_count); }
  };
  struct Sweep;
  static Sweep sweep(const Element& element, Positions x);
  static void add_blocks(const Element& element, double scale, const Mat9d& K, BlockSparse& H);

  std::vector<Element> elements_;
};

}  // namespace aspic
