#include "ranks/petsc_matrix.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "math/vectors.h"

namespace aspic::distributed {

void check(PetscErrorCode error) {
  if (error == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(error, &text, nullptr);
  throw std::runtime_error("PETSc error " + std::to_string(error) + ": " + (text ? text : "without a text"));
}

void copy_to(std::span<const double> own, Vec v) {
  double* values = nullptr;
  check(VecGetArrayWrite(v, &values));
  std::copy(own.begin(), own.end(), values);
  check(VecRestoreArrayWrite(v, &values));
}

void copy_from(Vec v, std::span<double> own) {
  const double* values = nullptr;
  check(VecGetArrayRead(v, &values));
  std::copy_n(values, own.size(), own.begin());
  check(VecRestoreArrayRead(v, &values));
}

RowsOfRank::RowsOfRank(const MeshShare& mesh, const BlockPattern& pattern) : mesh_(&mesh), start_{0} {
  for (int row = 0; row < mesh.own(); ++row) {
    const auto first = static_cast<std::ptrdiff_t>(entry_.size());
    for (std::int64_t s = pattern.row_start[row]; s < pattern.row_start[row + 1]; ++s)
      entry_.push_back({mesh.vertex[pattern.column[s]], s, false});
    for (std::int64_t u = pattern.upper_start[row]; u < pattern.upper_start[row + 1]; ++u)
      entry_.push_back({mesh.vertex[pattern.upper_row[u]], pattern.upper_slot[u], true});
    std::sort(entry_.begin() + first, entry_.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
    start_.push_back(entry_.size());
  }
}

Mat RowsOfRank::make_matrix() const {
  const int own = mesh_->own();
  std::vector<PetscInt> inside(own, 0), outside(own, 0);  // blocks per row
  for (int row = 0; row < own; ++row)
    for (size_t k = start_[row]; k < start_[row + 1]; ++k) ++(mesh_->owns(entry_[k].column) ? inside : outside)[row];
  Mat A = nullptr;
  check(MatCreate(PETSC_COMM_WORLD, &A));
  check(MatSetSizes(A, 3 * own, 3 * own, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(A, MATAIJ));  // GAMG has no block format
  check(MatXAIJSetPreallocation(A, 3, inside.data(), outside.data(), nullptr, nullptr));
  check(MatSetOption(A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  check(MatSetOption(A, MAT_SPD, PETSC_TRUE));
  return A;
}

void RowsOfRank::fill(const BlockSparse& H, Mat A) const {
  std::vector<PetscInt> columns;
  std::vector<double> values;
  for (int row = 0; row < mesh_->own(); ++row) {
    const size_t count = start_[row + 1] - start_[row];
    columns.resize(count);
    values.resize(9 * count);
    for (size_t k = 0; k < count; ++k) {
      const Entry& entry = entry_[start_[row] + k];
      const Mat3d& block = H.block[entry.slot];
      columns[k] = entry.column;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) values[i * 3 * count + 3 * k + j] = entry.is_transposed ? block(j, i) : block(i, j);
    }
    const PetscInt whole_row = mesh_->first() + row;
    check(MatSetValuesBlocked(A, 1, &whole_row, static_cast<PetscInt>(count), columns.data(), values.data(),
                              INSERT_VALUES));
  }
  check(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
}

namespace {

// Displacement of a vertex by translation or rotation number `motion`.
Vec3d rigid_motion(int motion, const Vec3d& x) {
  Vec3d u{};
  if (motion < 3) {
    u[motion] = 1;
  } else {
    u[(motion + 1) % 3] = -x[(motion + 2) % 3];
    u[(motion + 2) % 3] = x[(motion + 1) % 3];
  }
  return u;
}

}  // namespace

void set_rigid_motions(const MeshShare& mesh, std::span<const double> positions, Vec like, Mat A) {
  Vec3d sum{}, center{};
  for (int v = 0; v < mesh.own(); ++v) sum = sum + vec_at(positions, v);
  MPI_Allreduce(sum.a, center.a, 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  center = (1.0 / mesh.cut.back()) * center;
  std::array<Vec, 6> motions{};
  std::vector<double> values(3 * static_cast<size_t>(mesh.own()));
  for (int m = 0; m < 6; ++m) {
    check(VecDuplicate(like, &motions[m]));
    for (int v = 0; v < mesh.own(); ++v) set_vec(rigid_motion(m, vec_at(positions, v) - center), v, values);
    copy_to(values, motions[m]);
    for (int twice = 0; twice < 2; ++twice)
      for (int k = 0; k < m; ++k) {
        double product = 0;
        check(VecDot(motions[m], motions[k], &product));
        check(VecAXPY(motions[m], -product, motions[k]));
      }
    check(VecNormalize(motions[m], nullptr));
  }
  MatNullSpace space = nullptr;
  check(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, 6, motions.data(), &space));
  check(MatSetNearNullSpace(A, space));
  check(MatNullSpaceDestroy(&space));
  for (Vec& motion : motions) check(VecDestroy(&motion));
}

}  // namespace aspic::distributed
