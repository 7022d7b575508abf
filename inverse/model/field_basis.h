// A field over the tets with few coefficients: z_t = sum_j w_tj p_j. Weights of a tet are positive and sum to 1.
#pragma once
#include <span>
#include <vector>

#include "mesh/tet_mesh.h"

namespace aspic {

class FieldBasis {
 public:
  static FieldBasis uniform(int tets);
  static FieldBasis tets(int tets);
  static FieldBasis regions(const std::vector<int>& labels);  // one function per label, ascending
  // Compact radial functions [Wendland 1995] at centroids of tets that are as far apart as possible, divided by their
  // sum [Shepard 1968]. `count` is at most the number of tets.
  static FieldBasis radial(const TetMesh& mesh, int count);

  int size() const { return size_; }  // number of coefficients
  bool is_identity() const { return is_identity_; }
  const std::vector<Vec3d>& centers() const { return centers_; }  // of radial functions; empty for other fields
  int tet_count() const { return static_cast<int>(row_start_.size()) - 1; }
  void multiply(std::span<const double> p, std::span<double> z) const;        // z = W p
  void add_transposed(std::span<const double> z, std::span<double> p) const;  // p += W' z
  // Calls visit(t, j, w) for every nonzero weight, tet by tet.
  template <class Visit>
  void for_each_weight(const Visit& visit) const {
    for (int t = 0; t < tet_count(); ++t)
      for (int s = row_start_[t]; s < row_start_[t + 1]; ++s) visit(t, index_[s], weight_[s]);
  }

 private:
  void close_row() { row_start_.push_back(static_cast<int>(index_.size())); }

  int size_ = 0;
  bool is_identity_ = false;
  std::vector<int> row_start_{0}, index_;
  std::vector<double> weight_;
  std::vector<Vec3d> centers_;
};

}  // namespace aspic
