// Solves H d = b for H = A + B'DB with stiff rows B, for which a preconditioner of A alone converges slowly. With the
// unknowns p = D B d, such as pressures, the system becomes
//   A d + B'p = b,   B d - D^-1 p = 0.
// It is solved by FGMRES [Saad 1993] with a block-triangular preconditioner [Benzi, Golub and Liesen 2005, section 10]:
//   p = -S^-1 r_p,   d = M^-1 (r_d - B'p),   S = D^-1 + compliance.
// Iterations hardly depend on D.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "linalg/linear_solver.h"
#include "linalg/stiff_rows.h"

namespace aspic {

class LiftedSolver {
 public:
  using Precondition = std::function<void(std::span<const double> r, std::span<double> z)>;  // z = M^-1 r

  // Computes A with the stencils of H, and returns it. H and rows must outlive the solves.
  const BlockSparse& separate(const BlockSparse& H, const StiffRows& rows);

  // Solves until |b - H x| <= tolerance |b|. `indefinite`: x is no descent direction, or has negative curvature.
  SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance, const Precondition& precondition);
  void set_stop(const StopToken& stop) { stop_ = stop; }
  void set_max_iterations(int count) { max_iterations_ = count; }

 private:
  struct Cycle;  // one FGMRES cycle between restarts

  // A stiff row that contains a vertex.
  struct Use {
    int row, place;
    Vec3d g;  // of the vertex
  };
  using Slots = std::array<int64_t, 10>;  // of the blocks of a vertex and those of a row; -1: above the diagonal

  size_t rows() const { return rows_->size(); }
  void find_uses();
  template <class Visit>
  void for_each_row(const Visit& visit) const;
  template <class Factor>
  void add_rows(const Factor& factor, std::span<double> x);
  void apply(std::span<const double> z, std::span<double> w);
  void apply_preconditioner(std::span<const double> r, std::span<double> z, const Precondition& precondition);
  double primal_norm(std::span<const double> r, double factor);  // |b - H x| for the lifted residual factor r
  bool run(Cycle& cycle, const Precondition& precondition);
  void judge(std::span<const double> b, std::span<const double> x, double tolerance, SolveReport& report);

  const BlockSparse* H_ = nullptr;
  const StiffRows* rows_ = nullptr;
  std::optional<BlockSparse> A_;
  uint64_t version_ = 0;                       // pattern of uses_
  std::vector<std::array<int, 10>> vertices_;  // of the rows of uses_
  std::vector<int> use_start_;                 // per vertex
  std::vector<Use> uses_;                      // ascending by row
  std::vector<Slots> slots_;                   // per use
  std::vector<double> factor_;                 // per row
  std::vector<double> scale_;                  // unit of p, one per row: balances both equations
  StopToken stop_;
  int max_iterations_ = 500;
  std::vector<std::vector<double>> v_, z_;  // bases
  std::vector<double> t_, primal_, right_;
};

}  // namespace aspic
