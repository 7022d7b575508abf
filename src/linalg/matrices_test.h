// Matrices for the tests of this folder.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "linalg/block_sparse.h"
#include "math/vectors.h"

namespace aspic::test {

struct Matrix {  // keeps the pattern at a fixed address
  std::unique_ptr<BlockPattern> pattern;
  BlockSparse values;
  explicit Matrix(BlockPattern p) : pattern(std::make_unique<BlockPattern>(std::move(p))), values(*pattern) {}
  int rows() const { return pattern->rows(); }
};

// Adds A to block (i, j), whichever triangle it lies in.
inline void add_block(BlockSparse& H, int i, int j, const Mat3d& A) {
  const Mat3d B = i >= j ? A : transpose(A);
  Mat3d& block = H.block[H.pattern->slot(std::max(i, j), std::min(i, j))];
  block = block + B;
}

inline std::vector<double> random_vector(size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> v(size);
  for (double& value : v) value = uniform(random);
  return v;
}

// Returns a matrix with random off-diagonal blocks (entries in (-1, 1)) and diagonal blocks that dominate their rows,
// hence positive definite.
inline Matrix random_dominant(int rows, const Couplings& couplings, unsigned seed) {
  Matrix H(make_pattern(rows, couplings));
  std::vector<double> row_sum(rows, 0.0);
  const BlockPattern& p = *H.pattern;
  const std::vector<double> entries = random_vector(9 * p.block_count(), seed);
  for (int r = 0; r < rows; ++r)
    for (int64_t s = p.row_start[r]; s < p.row_start[r + 1]; ++s) {
      std::copy_n(&entries[9 * s], 9, H.values.block[s].a);
      row_sum[r] += 3, row_sum[p.column[s]] += 3;  // no row of a block exceeds 3 in absolute value
    }
  for (int r = 0; r < rows; ++r) {
    Mat3d& D = H.values.block[p.diagonal(r)];
    D = D + transpose(D) + (row_sum[r] + 3) * identity3<double>();
  }
  return H;
}

inline Couplings random_couplings(int rows, int count, unsigned seed) {
  std::mt19937 random(seed);
  Couplings couplings;
  for (int k = 0; rows > 0 && k < count; ++k) {
    const int i = static_cast<int>(random() % rows), j = static_cast<int>(random() % rows);
    couplings.emplace_back(i, j);
  }
  return couplings;
}

// Replaces a row by that of the identity, like the row of a pinned vertex.
inline void pin(BlockSparse& H, int row) {
  const BlockPattern& p = *H.pattern;
  for (int64_t s = p.row_start[row]; s < p.row_start[row + 1]; ++s) H.block[s] = {};
  for (int64_t u = p.upper_start[row]; u < p.upper_start[row + 1]; ++u) H.block[p.upper_slot[u]] = {};
  H.block[p.diagonal(row)] = identity3<double>();
}

struct Lattice {
  int nx = 4, ny = 4, nz = 4;  // cells
  double stiffness = 1, mass = 1;
};

// Springs along the edges of the Kuhn subdivision of a box: block (i, j) of a spring with unit direction n is -k n n'.
// The sparsity is that of linear tetrahedra on the same box. Without mass, the nullspace contains the rigid motions.
inline Matrix spring_lattice(const Lattice& lattice) {
  const auto [nx, ny, nz, stiffness, mass] = lattice;
  const auto vertex = [&, sy = ny + 1, sz = nz + 1](int i, int j, int k) { return (i * sy + j) * sz + k; };
  struct Spring {
    int a, b;
    Vec3d n;
  };
  std::vector<Spring> springs;
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j)
      for (int k = 0; k <= nz; ++k)
        for (int e = 1; e < 8; ++e) {
          const int di = e & 1, dj = e >> 1 & 1, dk = e >> 2;
          if (i + di > nx || j + dj > ny || k + dk > nz) continue;
          const double length = std::sqrt(di + dj + dk);
          springs.push_back(
              {vertex(i, j, k), vertex(i + di, j + dj, k + dk), {{di / length, dj / length, dk / length}}});
        }
  Couplings couplings;
  for (const Spring& s : springs) couplings.emplace_back(s.a, s.b);
  Matrix H(make_pattern((nx + 1) * (ny + 1) * (nz + 1), couplings));
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j)
      for (int k = 0; k <= nz; ++k) H.pattern->rest_position.push_back({{1.0 * i, 1.0 * j, 1.0 * k}});
  for (int r = 0; r < H.rows(); ++r) add_block(H.values, r, r, mass * identity3<double>());
  for (const Spring& s : springs) {
    Mat3d K;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) K(r, c) = stiffness * s.n[r] * s.n[c];
    add_block(H.values, s.a, s.a, K);
    add_block(H.values, s.b, s.b, K);
    add_block(H.values, s.a, s.b, -1.0 * K);
  }
  return H;
}

// Returns the full symmetric matrix, column-major.
inline std::vector<double> dense(const BlockSparse& H) {
  const BlockPattern& p = *H.pattern;
  const size_t n = 3 * p.rows();
  std::vector<double> A(n * n, 0.0);
  for (int r = 0; r < p.rows(); ++r)
    for (int64_t s = p.row_start[r]; s < p.row_start[r + 1]; ++s)
      for (int k = 0; k < 9; ++k) {
        const size_t row = 3 * r + k % 3, col = 3 * p.column[s] + k / 3;
        A[row + n * col] = H.block[s].a[k];
        A[col + n * row] = H.block[s].a[k];
      }
  return A;
}

// |b - H x| / |b|
inline double relative_residual(const BlockSparse& H, const std::vector<double>& b, const std::vector<double>& x) {
  std::vector<double> r(b.size());
  H.multiply(x, r);
  for (size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
  return std::sqrt(dot(r, r) / dot(b, b));
}

}  // namespace aspic::test
