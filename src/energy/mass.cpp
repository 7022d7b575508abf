#include "energy/mass.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "energy/tet_integrals.h"
#include "mesh/elements.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

// Returns the lumped mass of the sheets and rods at each vertex [kg].
std::vector<double> thin_mass(const TetMesh& mesh, std::span<const double> density) {
  std::vector<double> mass(mesh.rest.size(), 0.0);
  for (int e = mesh.tet_count(); e < mesh.element_count(); ++e) {
    const TetNodes nodes = nodes_of(mesh, e);
    for (const int v : nodes) mass[v] += density[e] * element_volume(mesh, e) / nodes.count;
  }
  return mass;
}

}  // namespace

MassMatrix::MassMatrix(const TetMesh& mesh, std::span<const double> density, MassKind kind,
                       std::span<const double> angle_mass)
    : kind_(kind),
      vertices_(mesh.rest.size()),
      lumped_(vertices_ + angle_mass.size(), 0.0),
      row_sums_(lumped_.size(), 0.0) {
  ASPIC_CHECK(static_cast<int>(density.size()) == mesh.element_count());
  Couplings couplings;
  couplings.reserve(kind == MassKind::lumped ? 0 : (mesh.mids.empty() ? 6 : 45) * mesh.tets.size());
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetNodes nodes = nodes_of(mesh, t);
    const TetIntegrals& integrals = tet_integrals(nodes.count);
    const double mass = density[t] * volume(mesh, t);
    for (int u = 0; u < nodes.count; ++u) {
      lumped_[nodes[u]] += integrals.lumped[u] * mass / integrals.lumped_sum;
      row_sums_[nodes[u]] += integrals.mean[u] * mass / integrals.mean_sum;
      for (int v = 0; v < u && kind == MassKind::consistent; ++v) couplings.emplace_back(nodes[u], nodes[v]);
    }
  }
  std::vector<double> of_thin = thin_mass(mesh, density);
  of_thin.insert(of_thin.end(), angle_mass.begin(), angle_mass.end());
  for (int v = 0; v < rows(); ++v) {
    lumped_[v] += of_thin[v];
    row_sums_[v] += of_thin[v];
  }
  const BlockPattern pattern = make_pattern(rows(), std::move(couplings));
  if (kind == MassKind::lumped) {
    row_sums_ = lumped_;
    store_rows(pattern, lumped_);
    return;
  }
  std::vector<double> lower(pattern.block_count(), 0.0);
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const TetNodes nodes = nodes_of(mesh, t);
    const TetIntegrals& integrals = tet_integrals(nodes.count);
    const double m = density[t] * volume(mesh, t) / integrals.products_sum;
    for (int u = 0; u < nodes.count; ++u)
      for (int v = 0; v <= u; ++v)
        lower[pattern.slot(std::max(nodes[u], nodes[v]), std::min(nodes[u], nodes[v]))] += integrals.products[u][v] * m;
  }
  for (int v = 0; v < rows(); ++v) lower[pattern.diagonal(v)] += of_thin[v];
  store_rows(pattern, lower);
}

void MassMatrix::store_rows(const BlockPattern& pattern, std::span<const double> lower) {
  lower_start_ = pattern.row_start;
  row_start_.resize(rows() + 1);
  for (int i = 0; i <= rows(); ++i) row_start_[i] = pattern.row_start[i] + pattern.upper_start[i];
  column_.resize(row_start_.back());
  entry_.resize(row_start_.back());
  parallel_chunks(rows(), [&](int first, int last) {
    int64_t place = row_start_[first];
    const auto put = [&](int column, double entry) { column_[place] = column, entry_[place++] = entry; };
    for (int i = first; i < last; ++i) {
      for (int64_t k = pattern.row_start[i]; k < pattern.row_start[i + 1]; ++k) put(pattern.column[k], lower[k]);
      for (int64_t k = pattern.upper_start[i]; k < pattern.upper_start[i + 1]; ++k)
        put(pattern.upper_row[k], lower[pattern.upper_slot[k]]);
    }
  });
}

double MassMatrix::total() const {
  double sum = 0;
  for (const double m : vertex_mass()) sum += m;
  return sum;
}

void MassMatrix::multiply(std::span<const double> x, std::span<double> y) const {
  parallel_chunks(rows(), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      double s[3] = {0, 0, 0};
      for (int64_t k = row_start_[i]; k < row_start_[i + 1]; ++k)
        for (int r = 0; r < 3; ++r) s[r] += entry_[k] * x[3 * column_[k] + r];
      for (int r = 0; r < 3; ++r) y[3 * i + r] = s[r];
    }
  });
}

double MassMatrix::squared_distance(std::span<const double> x, std::span<const double> y) const {
  return parallel_sum(rows(), [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) {
      const int64_t diagonal = row_start_[i] + lower_count(i) - 1;
      double s[3] = {0, 0, 0};
      for (int64_t k = row_start_[i]; k < diagonal; ++k) {
        const int j = 3 * column_[k];
        for (int r = 0; r < 3; ++r) s[r] += 2 * entry_[k] * (x[j + r] - y[j + r]);
      }
      for (int r = 0; r < 3; ++r) {
        const double d = x[3 * i + r] - y[3 * i + r];
        sum += d * (s[r] + entry_[diagonal] * d);
      }
    }
    return sum;
  });
}

double MassMatrix::squared_distance(std::span<const double> x, std::span<const double> y, int count) const {
  return parallel_sum(count, [&](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i)
      for (int64_t k = row_start_[i]; k < row_start_[i + 1]; ++k)
        for (int r = 0; r < 3; ++r)
          sum += (x[3 * i + r] - y[3 * i + r]) * entry_[k] * (x[3 * column_[k] + r] - y[3 * column_[k] + r]);
    return sum;
  });
}

void MassMatrix::add_couplings(Couplings& couplings) const {
  for (int i = 0; i < rows(); ++i)
    for (int64_t k = row_start_[i]; column_[k] < i; ++k) couplings.emplace_back(i, column_[k]);
}

void MassMatrix::bind(const BlockPattern& target) {
  target_slot_.resize(lower_start_.back());
  parallel_chunks(rows(), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      int64_t slot = target.row_start[i];  // columns ascend in both
      for (int64_t k = 0; k < lower_count(i); ++k) {
        while (target.column[slot] != column_[row_start_[i] + k]) ++slot;
        ASPIC_CHECK(slot < target.row_start[i + 1]);
        target_slot_[lower_start_[i] + k] = slot;
      }
    }
  });
}

void MassMatrix::add_row(int row, double scale, BlockSparse& H) const {
  for (int64_t k = 0; k < lower_count(row); ++k) {
    Mat3d& block = H.block[target_slot_[lower_start_[row] + k]];
    for (int r = 0; r < 3; ++r) block(r, r) += scale * entry_[row_start_[row] + k];
  }
}

void MassMatrix::add_to(double scale, BlockSparse& H) const {
  ASPIC_CHECK(static_cast<int64_t>(target_slot_.size()) == lower_start_.back());
  parallel_chunks(rows(), [&](int first, int last) {
    for (int i = first; i < last; ++i) add_row(i, scale, H);
  });
}

void MassMatrix::assign_to(double scale, BlockSparse& H) const {
  ASPIC_CHECK(static_cast<int64_t>(target_slot_.size()) == lower_start_.back());
  parallel_chunks(rows(), [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      std::fill(H.block.begin() + H.pattern->row_start[i], H.block.begin() + H.pattern->row_start[i + 1], Mat3d{});
      add_row(i, scale, H);
    }
  });
  H.stencils.clear();
}

namespace {

// w' M y of one tet, divided by its mass.
double mass_product(const TetNodes& nodes, MassKind kind, std::span<const double> w, std::span<const double> y) {
  const TetIntegrals& integrals = tet_integrals(nodes.count);
  const auto product = [&](int u, int v) {
    double sum = 0;
    for (int r = 0; r < 3; ++r) sum += w[3 * nodes[u] + r] * y[3 * nodes[v] + r];
    return sum;
  };
  double sum = 0;
  for (int u = 0; u < nodes.count; ++u) {
    if (kind == MassKind::lumped) sum += integrals.lumped[u] * product(u, u);
    for (int v = 0; v < nodes.count && kind == MassKind::consistent; ++v)
      sum += integrals.products[u][v] * product(u, v);
  }
  return sum / (kind == MassKind::lumped ? integrals.lumped_sum : integrals.products_sum);
}

}  // namespace

void add_density_gradient(const TetMesh& mesh, MassKind kind, std::span<const double> w, std::span<const double> y,
                          std::span<double> gradient) {
  parallel_chunks(mesh.tet_count(), [&](int first, int last) {
    for (int t = first; t < last; ++t) gradient[t] += volume(mesh, t) * mass_product(nodes_of(mesh, t), kind, w, y);
  });
}

}  // namespace aspic
