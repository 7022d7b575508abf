// The prescribed vertices of a model: which they are, and where they are at a time.
#pragma once
#include <span>
#include <vector>

#include "dynamics/model.h"

namespace aspic {

class Pins {
 public:
  Pins(const std::vector<Pin>& pins, std::span<const double> start /* x at time 0 */);

  int vertex_count() const { return static_cast<int>(pinned_.size()); }
  bool holds(int vertex) const { return pinned_[vertex]; }
  bool any_moves() const;

  void place(double time, std::span<double> x) const;  // writes the positions of the pinned vertices
  void set_zero(std::span<double> v) const;            // clears the entries of the pinned vertices
  void set_identity(BlockSparse& H) const;             // their rows and columns; the rest stays

 private:
  const std::vector<Pin>* pins_;
  std::vector<double> start_;
  std::vector<char> pinned_;
};

}  // namespace aspic
