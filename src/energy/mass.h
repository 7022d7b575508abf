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
  // g[k] += scale (M (x - origin))_v, H[k] += scale M_vv I for v = vertices[k].
  void add_vertex_systems(double scale, std::span<const double> x, std::span<const double> origin,
                          std::span<const int> vertices, std::span<Vec3d> g, std::span<Mat3d> H) const;
  void add_couplings(Couplings& couplings) const;
  void bind(const BlockPattern& target);            // remembers where add_to writes
  void add_to(double scale, BlockSparse& H) const;  // H += scale M

 private:
  template <class Visit>
  void for_each_in_row(int row, const Visit& visit) const;  // visit(entry, column)

  MassKind kind_;
  std::vector<double> lumped_;
  BlockPattern pattern_;
  std::vector<double> entry_;  // one per entry of pattern_.column [kg]; empty when lumped
  std::vector<int64_t> target_slot_;
};

}  // namespace aspic
