#include "verify/modes.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "dynamics/incremental_potential.h"
#include "linalg/dense_eigen.h"
#include "linalg/linear_solver.h"
#include "verify/models.h"

namespace aspic::verify {
namespace {

using Vector = std::vector<double>;
using Vectors = std::vector<Vector>;

double product(const Vector& a, const Vector& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

Vectors random_vectors(size_t size, int count, const Pins& pins) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vectors X(count, Vector(size));
  for (Vector& x : X) {
    for (double& entry : x) entry = uniform(random);
    pins.set_zero(x);
  }
  return X;
}

// sum over k of c[k + n i] X[k] for each i.
Vectors combined(const Vectors& X, const Vector& c) {
  const size_t n = X.size();
  Vectors Y(n, Vector(X[0].size()));
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 0; k < n; ++k)
      for (size_t j = 0; j < X[k].size(); ++j) Y[i][j] += c[k + n * i] * X[k][j];
  return Y;
}

// c such that the combinations of X are orthonormal with respect to the Gram matrix G, by its eigenvectors.
Vector orthonormal(const Vector& G, size_t n) {
  DenseEigen e = dense_eigen(static_cast<int>(n), G);
  for (size_t i = 0; i < n; ++i)
    for (size_t k = 0; k < n; ++k) e.vectors[k + n * i] /= std::sqrt(e.values[i]);
  return e.vectors;
}

Vector gram(const Vectors& A, const Vectors& B) {
  Vector G(A.size() * A.size());
  for (size_t i = 0; i < A.size(); ++i)
    for (size_t j = 0; j < A.size(); ++j) G[j + A.size() * i] = product(A[j], B[i]);
  return G;
}

class Eigenproblem {
 public:
  explicit Eigenproblem(const Model& model)
      : model_(model),
        rest_(at_rest(model.mesh).q),
        pins_(model.pins, rest_),
        E_(model, pins_),
        solver_(make_linear_solver("cholesky")) {
    E_.begin_step(rest_, 0, 1);
    K_ = std::make_unique<BlockSparse>(E_.hessian(rest_, {Definiteness::exact}));
    solver_->analyze(*K_->pattern);
    if (!solver_->factorize(*K_)) throw std::runtime_error("the stiffness matrix is not positive definite");
  }

  Vectors start(int count) const { return random_vectors(rest_.size(), count, pins_); }

  // One iteration; returns the eigenvalues, ascending.
  Vector improve(Vectors& X) const {
    Vectors MX = times_mass(X);
    for (size_t i = 0; i < X.size(); ++i) solver_->solve(MX[i], X[i], 1e-12);
    Vectors KX = MX;  // K X = the M X of before
    const Vector c = orthonormal(gram(X, times_mass(X)), X.size());
    X = combined(X, c);
    KX = combined(KX, c);
    const DenseEigen e = dense_eigen(static_cast<int>(X.size()), gram(X, KX));
    X = combined(X, e.vectors);
    return {e.values.rbegin(), e.values.rend()};
  }

 private:
  Vectors times_mass(const Vectors& X) const {
    Vectors MX(X.size(), Vector(X[0].size()));
    for (size_t i = 0; i < X.size(); ++i) {
      model_.mass->multiply(X[i], MX[i]);
      pins_.set_zero(MX[i]);
    }
    return MX;
  }

  const Model& model_;
  Vector rest_;
  Pins pins_;
  IncrementalPotential E_;
  std::unique_ptr<LinearSolver> solver_;
  std::unique_ptr<BlockSparse> K_;
};

}  // namespace

std::vector<Mode> modes(const Model& model, int count) {
  const Eigenproblem problem(model);
  Vectors X = problem.start(2 * count + 2);
  Vector before(count, 0.0);
  for (int i = 0; i < 100; ++i) {
    Vector values = problem.improve(X);
    values.resize(count);
    double change = 0;
    for (int k = 0; k < count; ++k) change = std::fmax(change, std::abs(values[k] / before[k] - 1));
    before = values;
    if (change > 1e-9) continue;
    std::vector<Mode> found;
    for (int k = 0; k < count; ++k)
      found.push_back({std::sqrt(values[k]) / (2 * std::numbers::pi), X[X.size() - 1 - k]});
    return found;
  }
  throw std::runtime_error("the natural frequencies did not converge");
}

std::vector<double> frequencies(const Model& model, int count) {
  std::vector<double> found;
  for (const Mode& mode : modes(model, count)) found.push_back(mode.frequency);
  return found;
}

}  // namespace aspic::verify
