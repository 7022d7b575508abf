#include "linalg/smallest_eigenpairs.h"

#include <Spectra/SymGEigsShiftSolver.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace aspic {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTolerance = 1e-10;  // residual of an eigenpair of (K + shift M)^-1 M, relative to its eigenvalue
constexpr double kProbeTolerance =
    1e-6;                        // tolerance if only the eigenvalue is needed, whose error is the square of this
constexpr double kBelow = 1e-7;  // relative difference at which an eigenvalue counts as smaller
constexpr int kRestarts = 500;

std::span<const double> entries(const VectorXd& x) { return {x.data(), static_cast<size_t>(x.size())}; }
std::span<double> entries(VectorXd& x) { return {x.data(), static_cast<size_t>(x.size())}; }

VectorXd times_mass(const ShiftedPencil& pencil, VectorXd x) {
  pencil.project(entries(x));
  VectorXd y(pencil.size);
  pencil.multiply_mass(entries(x), entries(y));
  pencil.project(entries(y));
  return y;
}

VectorXd solved(const ShiftedPencil& pencil, const VectorXd& b) {
  VectorXd x(pencil.size);
  pencil.solve(entries(b), entries(x));
  return x;
}

// Multiplies by M / mass. Spectra uses absolute thresholds, so vectors and eigenvalues are scaled to about 1.
class ScaledMass {
 public:
  using Scalar = double;
  ScaledMass(const ShiftedPencil& pencil, double mass) : pencil_(pencil), mass_(mass) {}
  Eigen::Index rows() const { return pencil_.size; }
  Eigen::Index cols() const { return pencil_.size; }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<VectorXd>(y, rows()) = times_mass(pencil_, Eigen::Map<const VectorXd>(x, rows())) / mass_;
  }

 private:
  const ShiftedPencil& pencil_;
  double mass_;
};

// Multiplies by factor (K + shift M)^-1 and removes the known eigenvectors, the columns of U: y - U U' M y.
class DeflatedInverse {
 public:
  using Scalar = double;
  DeflatedInverse(const ShiftedPencil& pencil, double factor, const MatrixXd& found)
      : pencil_(pencil), factor_(factor), found_(found), mass_found_(found.rows(), found.cols()) {
    for (Eigen::Index k = 0; k < found.cols(); ++k) mass_found_.col(k) = times_mass(pencil, found.col(k));
  }
  Eigen::Index rows() const { return pencil_.size; }
  Eigen::Index cols() const { return pencil_.size; }
  void set_shift(double) {}
  void perform_op(const double* x, double* y) const {
    VectorXd z = factor_ * solved(pencil_, Eigen::Map<const VectorXd>(x, rows()));
    z -= found_ * (mass_found_.transpose() * z);
    Eigen::Map<VectorXd>(y, rows()) = z;
  }

 private:
  const ShiftedPencil& pencil_;
  double factor_;
  const MatrixXd& found_;
  MatrixXd mass_found_;
};

struct Found {
  bool converged = true;
  VectorXd values;   // eigenvalues of (K + shift M)^-1 M, descending
  MatrixXd vectors;  // eigenvectors as columns
};

int subspace_size(int count) { return std::max(2 * count, count + 10); }

VectorXd start_vector(const ShiftedPencil& pencil, int run) {
  Spectra::SimpleRandom<double> random(1 + 7919 * run);  // a seed of 0 means 1
  VectorXd x = random.random_vec(pencil.size);
  pencil.project(entries(x));
  return x;
}

// Returns an upper bound of the order of magnitude of the eigenvalues of (K + shift M)^-1 M.
double typical_value(const ShiftedPencil& pencil, VectorXd x) {
  double size = 1;
  for (int k = 0; k < 2; ++k) {
    x /= std::sqrt(x.dot(times_mass(pencil, x)));
    VectorXd y = solved(pencil, times_mass(pencil, x));
    size = x.dot(times_mass(pencil, y));
    x = y;
  }
  return size;
}

struct LanczosOptions {
  int count = 1;
  double tolerance = kTolerance;
  int run = 0;  // selects the start vector
};

// Returns the `count` largest eigenvalues after removing the eigenvectors `known`.
Found lanczos(const ShiftedPencil& pencil, const MatrixXd& known, const LanczosOptions& options) {
  const auto [count, tolerance, run] = options;
  const VectorXd start = start_vector(pencil, run);
  const double mass = start.dot(times_mass(pencil, start)) / start.squaredNorm();
  const double size = typical_value(pencil, start);
  ScaledMass M(pencil, mass);
  DeflatedInverse inverse(pencil, mass / size, known);
  Spectra::SymGEigsShiftSolver<DeflatedInverse, ScaledMass, Spectra::GEigsMode::ShiftInvert> solver(
      inverse, M, count, subspace_size(count), 0);
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestMagn, kRestarts, tolerance, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) return {.converged = false, .values = {}, .vectors = {}};
  return {.values = size * solver.eigenvalues().cwiseInverse(), .vectors = solver.eigenvectors() / std::sqrt(mass)};
}

// Returns orthonormal vectors that span the subspace. The constraints of different vertices are independent.
MatrixXd basis(const ShiftedPencil& pencil) {
  MatrixXd Z(pencil.size, pencil.dimension);
  int columns = 0;
  for (int i = 0; i < pencil.size && columns < pencil.dimension; ++i) {
    VectorXd z = VectorXd::Unit(pencil.size, i);
    pencil.project(entries(z));
    for (int k = std::max(0, columns - 2); k < columns; ++k) z -= Z.col(k) * Z.col(k).dot(z);
    if (z.norm() > 1e-6) Z.col(columns++) = z.normalized();
  }
  return Z.leftCols(columns);
}

Found dense(const ShiftedPencil& pencil) {
  const MatrixXd Z = basis(pencil);
  MatrixXd MZ(Z.rows(), Z.cols()), inverse_MZ(Z.rows(), Z.cols());
  for (Eigen::Index k = 0; k < Z.cols(); ++k) {
    MZ.col(k) = times_mass(pencil, Z.col(k));
    inverse_MZ.col(k) = solved(pencil, MZ.col(k));
  }
  const MatrixXd A = MZ.transpose() * inverse_MZ, M = Z.transpose() * MZ;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver((A + A.transpose()) / 2, (M + M.transpose()) / 2);
  return {.converged = solver.info() == Eigen::Success,
          .values = solver.eigenvalues().reverse(),
          .vectors = Z * solver.eigenvectors().rowwise().reverse()};
}

Found merged(const Found& a, const Found& b) {
  const Eigen::Index n = a.values.size() + b.values.size();
  VectorXd values(n);
  values << a.values, b.values;
  MatrixXd vectors(b.vectors.rows(), n);
  vectors << a.vectors, b.vectors;
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int k) { return values[i] > values[k]; });
  return {.values = values(order), .vectors = vectors(Eigen::all, order)};
}

// A Krylov space contains one vector of each eigenspace: the projection of its start vector. Runs with other start
// vectors find the remaining copies of a repeated eigenvalue.
Found largest(const ShiftedPencil& pencil, int count) {
  Found found{.values = VectorXd(0), .vectors = MatrixXd(pencil.size, 0)};
  for (int run = 0;;) {
    const int missing = std::max(1, count - static_cast<int>(found.values.size()));
    if (found.values.size() >= count) {
      const Found probe = lanczos(pencil, found.vectors, {.tolerance = kProbeTolerance, .run = run++});
      if (!probe.converged) return probe;
      if (probe.values[0] <= found.values[count - 1] * (1 + kBelow)) return found;
    }
    const Found more = lanczos(pencil, found.vectors, {.count = missing, .run = run++});
    if (!more.converged) return more;
    found = merged(found, more);
  }
}

std::vector<double> normalized(const ShiftedPencil& pencil, VectorXd u) {
  pencil.project(entries(u));
  Eigen::Index at = 0;
  u.cwiseAbs().maxCoeff(&at);
  u *= (u[at] < 0 ? -1 : 1) / std::sqrt(u.dot(times_mass(pencil, u)));
  return {u.begin(), u.end()};
}

}  // namespace

Eigenpairs smallest_eigenpairs(const ShiftedPencil& pencil, int count) {
  count = std::min(count, pencil.dimension);
  if (count <= 0) return {.converged = true, .values = {}, .vectors = {}};
  const Found found = pencil.dimension <= 3 * subspace_size(count) ? dense(pencil) : largest(pencil, count);
  Eigenpairs pairs{.converged = found.converged, .values = {}, .vectors = {}};
  for (int k = 0; k < count && found.converged; ++k) {
    pairs.values.push_back(1 / found.values[k] - pencil.shift);
    pairs.vectors.push_back(normalized(pencil, found.vectors.col(k)));
  }
  return pairs;
}

}  // namespace aspic
