// The Dirichlet conditions of a model: prescribed vertices, directions and positions as functions of time. For a vertex
// with the prescribed directions n_k, M = sum of n_k n_k'. P = M^+ M projects onto the pinned space, Q = 1 - P onto the
// free space, and M^+ (sum over the directions of one pin) is the share of that pin: the identity on its directions if
// it is the only one. Pins that prescribe the same direction of a vertex must agree; they share its reaction.
#pragma once
#include <span>
#include <vector>

#include "dynamics/model.h"

namespace aspic {

// Returns the largest distance of a vertex from the positions that `pins` prescribe for it along their directions, if
// their mean square is smallest: 0 if the pins agree [m].
double disagreement(std::span<const Pin* const> pins, const Vec3d& start, double time);

class Pins {
 public:
  // `start`: x at time 0, 3 per vertex [m]. `pins` must outlive this.
  Pins(const std::vector<Pin>& pins, std::span<const double> start);

  int rows() const { return static_cast<int>(kind_.size()); }        // of the model
  bool holds(int vertex) const { return kind_[vertex] == kHeld; }    // in all directions
  bool is_free(int vertex) const { return kind_[vertex] == kFree; }  // no pin holds it in any direction
  bool holds(int vertex, int axis) const;  // along a direction with a component along the axis
  bool any_moves() const;                  // a pin has a motion

  Vec3d held_part(int vertex, const Vec3d& v) const;                         // P v
  Vec3d free_part(int vertex, const Vec3d& v) const;                         // Q v
  Vec3d reaction_of(int pin, int index, const Vec3d& force) const;           // reaction at its index-th vertex
  void place(double time, std::span<double> x) const;                        // P x = P x(t)
  void set_zero(std::span<double> v) const;                                  // P v = 0
  void copy_held(std::span<const double> from, std::span<double> to) const;  // P to = P from
  void set_identity(BlockSparse& H) const;                                   // H = Q H Q + s P
  Mat3d with_identity(int vertex, const Mat3d& H) const;                     // a diagonal block of that matrix

 private:
  static constexpr int kFree = -1, kHeld = -2;
  struct Share {
    int vertex;
    Mat3d factor;
  };

  void set_zero(Stencil& stencil) const;

  const std::vector<Pin>* pins_;
  std::vector<double> start_;
  std::vector<int> kind_;                   // kFree, kHeld, or an index of projector_
  std::vector<Mat3d> projector_;            // P for partly pinned vertices
  std::vector<std::vector<Share>> shares_;  // of the vertices of each pin; empty: it holds all of them alone
};

}  // namespace aspic
