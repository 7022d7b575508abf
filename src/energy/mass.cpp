#include "energy/mass.h"

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {

MassMatrix::MassMatrix(const TetMesh& mesh, std::span<const double> density, MassKind kind)
    : kind_(kind), lumped_(mesh.vertex_count(), 0.0) {
  ASPIC_CHECK(static_cast<int>(density.size()) == mesh.tet_count());
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (const int v : mesh.tets[t]) lumped_[v] += density[t] * volume(mesh, t) / 4;
  if (kind == MassKind::lumped) return;

  Couplings couplings;
  couplings.reserve(6 * mesh.tets.size());
  for (const Tet& tet : mesh.tets)
    for (int u = 0; u < 4; ++u)
      for (int v = 0; v < u; ++v) couplings.emplace_back(tet[u], tet[v]);
  pattern_ = make_pattern(mesh.vertex_count(), std::move(couplings));
  // integral of N_u N_v over a tet = volume / 20 (1 + [u = v])
  entry_.assign(pattern_.block_count(), 0.0);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const Tet& tet = mesh.tets[t];
    const double m = density[t] * volume(mesh, t) / 20;
    for (int u = 0; u < 4; ++u) {
      entry_[pattern_.diagonal(tet[u])] += 2 * m;
      for (int v = 0; v < u; ++v) entry_[pattern_.slot(std::max(tet[u], tet[v]), std::min(tet[u], tet[v]))] += m;
    }
  }
}

double MassMatrix::total() const {
  double sum = 0;
  for (const double m : lumped_) sum += m;
  return sum;
}

template <class Visit>
void MassMatrix::for_each_in_row(int row, const Visit& visit) const {
  if (kind_ == MassKind::lumped) return visit(lumped_[row], row);
  for (int64_t k = pattern_.row_start[row]; k < pattern_.row_start[row + 1]; ++k) visit(entry_[k], pattern_.column[k]);
  for (int64_t k = pattern_.upper_start[row]; k < pattern_.upper_start[row + 1]; ++k)
    visit(entry_[pattern_.upper_slot[k]], pattern_.upper_row[k]);
}

void MassMatrix::multiply(std::span<const double> x, std::span<double> y) const {
  parallel_chunks(static_cast<int>(lumped_.size()), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      double s[3] = {0, 0, 0};
      for_each_in_row(i, [&](double m, int j) {
        for (int r = 0; r < 3; ++r) s[r] += m * x[3 * j + r];
      });
      for (int r = 0; r < 3; ++r) y[3 * i + r] = s[r];
    }
  });
}

void MassMatrix::add_vertex_systems(double scale, std::span<const double> x, std::span<const double> origin,
                                    std::span<const int> vertices, std::span<Vec3d> g, std::span<Mat3d> H) const {
  for (size_t k = 0; k < vertices.size(); ++k)
    for_each_in_row(vertices[k], [&](double m, int j) {
      for (int r = 0; r < 3; ++r) g[k][r] += scale * m * (x[3 * j + r] - origin[3 * j + r]);
      if (j == vertices[k])
        for (int r = 0; r < 3; ++r) H[k](r, r) += scale * m;
    });
}

void MassMatrix::add_couplings(Couplings& couplings) const {
  if (kind_ == MassKind::lumped) return;
  for (int i = 0; i < pattern_.rows(); ++i)
    for (int64_t k = pattern_.row_start[i]; k < pattern_.row_start[i + 1]; ++k)
      couplings.emplace_back(i, pattern_.column[k]);
}

void MassMatrix::bind(const BlockPattern& target) {
  target_slot_.clear();
  if (kind_ == MassKind::lumped)
    for (int i = 0; i < target.rows(); ++i) target_slot_.push_back(target.diagonal(i));
  else
    for (int i = 0; i < pattern_.rows(); ++i)
      for (int64_t k = pattern_.row_start[i]; k < pattern_.row_start[i + 1]; ++k)
        target_slot_.push_back(target.slot(i, pattern_.column[k]));
}

void MassMatrix::add_to(double scale, BlockSparse& H) const {
  const std::vector<double>& entry = kind_ == MassKind::lumped ? lumped_ : entry_;
  ASPIC_CHECK(target_slot_.size() == entry.size());
  parallel_chunks(static_cast<int>(entry.size()), [&](int first, int last) {
    for (int k = first; k < last; ++k)
      for (int r = 0; r < 3; ++r) H.block[target_slot_[k]](r, r) += scale * entry[k];
  });
}

}  // namespace aspic
