// Mass matrix M of tets, sheets and rods: one scalar per vertex pair, the same for x, y and z. Rows of angles follow
// the vertices, see angle_row.h.
#pragma once
#include <span>
#include <vector>

#include "linalg/block_sparse.h"
#include "mesh/tet_mesh.h"

namespace aspic {

enum class MassKind {
  consistent,  // integrals of products of the shape functions
  lumped,      // diagonal: the masses of vertex_mass()
};

class MassMatrix {
 public:
  // `density`: one per element [kg/m^3]. The masses of sheets and rods are always lumped. angle_mass: of the rows of
  // angles [kg]. The mesh need not outlive this.
  MassMatrix(const TetMesh& mesh, std::span<const double> density, MassKind kind,
             std::span<const double> angle_mass = {});

  MassKind kind() const { return kind_; }
  // Positive shares of the mass [kg]: row sums of linear tets, scaled diagonals of quadratic ones, see TetIntegrals.
  std::span<const double> vertex_mass() const { return row_mass().first(vertices_); }
  std::span<const double> row_mass() const { return lumped_; }  // of the vertices and the rows of angles [kg]
  // Row sums of this matrix [kg], which weights are proportional to; negative at some corners of quadratic tets.
  std::span<const double> row_sums() const { return std::span(row_sums_).first(vertices_); }
  double total() const;  // mass of all vertices [kg]

  void multiply(std::span<const double> x, std::span<double> y) const;                  // y = M x; 3 entries per row
  double squared_distance(std::span<const double> x, std::span<const double> y) const;  // (x - y)' M (x - y)
  // Returns the share of the first `count` rows in squared_distance(). The shares of all rows add up to it.
  double squared_distance(std::span<const double> x, std::span<const double> y, int count) const;
  void add_couplings(Couplings& couplings) const;      // appends the vertex pairs of its off-diagonal blocks
  void bind(const BlockPattern& target);               // stores the slots that add_to() writes
  void add_to(double scale, BlockSparse& H) const;     // H += scale M
  void assign_to(double scale, BlockSparse& H) const;  // H = scale M

 private:
  int rows() const { return static_cast<int>(lumped_.size()); }
  int64_t lower_count(int row) const { return lower_start_[row + 1] - lower_start_[row]; }
  void add_row(int row, double scale, BlockSparse& H) const;
  void store_rows(const BlockPattern& pattern, std::span<const double> lower);

  MassKind kind_;
  size_t vertices_;
  std::vector<double> lumped_, row_sums_;  // of all rows
  // Both triangles of the symmetric matrix, row by row, columns ascending, so that products read memory in order.
  std::vector<int64_t> row_start_, lower_start_;  // lower_start_ counts only the columns up to the diagonal
  std::vector<int> column_;
  std::vector<double> entry_;         // [kg]
  std::vector<int64_t> target_slot_;  // slots of the columns up to the diagonal
};

// gradient += d(w' M y)/d(density), one entry per tet; w and y have 3 entries per vertex.
void add_density_gradient(const TetMesh& mesh, MassKind kind, std::span<const double> w, std::span<const double> y,
                          std::span<double> gradient);

}  // namespace aspic
