// The mass matrix M of linear tetrahedra: one scalar per pair of vertices, the same for x, y and z.
#pragma once
#include <span>
#include <vector>

#include "linalg/block_sparse.h"
#include "mesh/tet_mesh.h"

namespace aspic {

enum class MassKind { consistent, lumped };

class MassMatrix {
 public:
  MassMatrix(const TetMesh& mesh, std::span<const double> density /* per tet [kg/m^3] */, MassKind kind);

  MassKind kind() const { return kind_; }
  std::span<const double> vertex_mass() const { return lumped_; }  // row sums [kg]
  double total() const;                                            // [kg]

  void multiply(std::span<const double> x, std::span<double> y) const;  // y = M x; 3 numbers per vertex
  void add_couplings(Couplings& couplings) const;
  void bind(const BlockPattern& target);            // remembers where add_to writes
  void add_to(double scale, BlockSparse& H) const;  // H += scale M

 private:
  MassKind kind_;
  std::vector<double> lumped_;
  BlockPattern pattern_;
  std::vector<double> entry_;  // one per entry of pattern_.column [kg]; empty when lumped
  std::vector<int64_t> target_slot_;
};

}  // namespace aspic
