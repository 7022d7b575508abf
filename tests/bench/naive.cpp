// Straightforward implementation of the beam with Eigen: triplets into a new matrix and a new factorization in each
// iteration, one loop over the tets for everything, dense 9x12 matrices for the chain rule.
#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <cmath>
#include <limits>
#include <vector>

#include "bench/beam_problem.h"
#include "bench/stopwatch.h"

namespace aspic::bench {
namespace {

using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;
using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector12d = Eigen::Matrix<double, 12, 1>;
using Matrix12d = Eigen::Matrix<double, 12, 12>;
using Matrix9x12d = Eigen::Matrix<double, 9, 12>;

struct Solid {
  double mu, lambda;  // [Pa]
};
Solid make_solid(double young) {
  return {young / (2 * (1 + kPoisson)), young * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson))};
}

// psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2
double psi(const Solid& solid, const Matrix3d& F) {
  const double J = F.determinant();
  if (J <= 0) return std::numeric_limits<double>::infinity();
  const double log_J = std::log(J);
  return solid.mu / 2 * (F.squaredNorm() - 3) - solid.mu * log_J + solid.lambda / 2 * log_J * log_J;
}

// P = mu F + (lambda ln J - mu) F^-T
Matrix3d pk1(const Solid& solid, const Matrix3d& F) {
  const double log_J = std::log(F.determinant());
  return solid.mu * F + (solid.lambda * log_J - solid.mu) * F.inverse().transpose();
}

// dP/dF : dF = mu dF + lambda (F^-T : dF) F^-T - (lambda ln J - mu) F^-T dF^T F^-T, one column per entry of F
Matrix9d hessian(const Solid& solid, const Matrix3d& F) {
  const Matrix3d G = F.inverse().transpose();
  const double log_J = std::log(F.determinant());
  Matrix9d H;
  for (int k = 0; k < 9; ++k) {
    Matrix3d dF = Matrix3d::Zero();
    dF(k % 3, k / 3) = 1;
    const Matrix3d dP =
        solid.mu * dF + solid.lambda * G(k % 3, k / 3) * G - (solid.lambda * log_J - solid.mu) * G * dF.transpose() * G;
    H.col(k) = Map<const Vector9d>(dP.data());
  }
  return H;
}

class NaiveBeam {
 public:
  explicit NaiveBeam(const BeamProblem& problem)
      : solid_(make_solid(problem.young)),
        h_(problem.time_step),
        tolerance_(problem.tolerance),
        mesh_(make_beam(problem.n)),
        q_(3 * mesh_.vertex_count()),
        v_(VectorXd::Zero(q_.size())) {
    for (int i = 0; i < mesh_.vertex_count(); ++i) q_.segment<3>(3 * i) = Map<const Vector3d>(&mesh_.rest[i][0]);
    make_elements();
    make_mass();
    make_selection();
    VectorXd gravity = VectorXd::Zero(q_.size());
    for (int i = 0; i < mesh_.vertex_count(); ++i) gravity[3 * i + 1] = kGravity;
    weight_ = mass_ * gravity;
  }

  // Minimizes E(x) = 1/2 (x - x~)' M (x - x~) + h^2 V(x) with Newton's method. Returns the number of iterations.
  int step() {
    const VectorXd predicted = q_ + h_ * v_;
    VectorXd x = q_;
    double first_gradient = 0;
    int iterations = 0;
    for (;; ++iterations) {
      const VectorXd g = select_ * gradient(x, predicted);
      if (iterations == 0) first_gradient = g.norm();
      if (g.norm() <= tolerance_ * first_gradient) break;
      const Eigen::SimplicialLDLT<SparseMatrix> solver(objective_hessian(x));
      const VectorXd d = select_.transpose() * solver.solve(-g);
      const double slope = d.dot(select_.transpose() * g), E = objective(x, predicted);
      double alpha = 1;
      while (objective(x + alpha * d, predicted) > E + 1e-4 * alpha * slope + 1e-12 * std::abs(E) && alpha > 1e-10) {
        alpha /= 2;
      }
      x += alpha * d;
    }
    v_ = (x - q_) / h_;
    q_ = x;
    return iterations;
  }

  double displacement(int vertex) const { return q_[3 * vertex + 1] - mesh_.rest[vertex][1]; }

 private:
  void make_elements() {  // vec(F) = B u for the twelve coordinates u of a tet
    for (int t = 0; t < mesh_.tet_count(); ++t) {
      Matrix3d Dm;
      for (int c = 0; c < 3; ++c) {
        Dm.col(c) = q_.segment<3>(3 * mesh_.tets[t][c + 1]) - q_.segment<3>(3 * mesh_.tets[t][0]);
      }
      const Matrix3d Dm_inverse = Dm.inverse();
      Eigen::Matrix<double, 4, 3> shape_gradient;
      shape_gradient << -Dm_inverse.colwise().sum(), Dm_inverse;
      Matrix9x12d B = Matrix9x12d::Zero();
      for (int corner = 0; corner < 4; ++corner) {
        for (int j = 0; j < 3; ++j) {
          for (int i = 0; i < 3; ++i) B(3 * j + i, 3 * corner + i) = shape_gradient(corner, j);
        }
      }
      B_.push_back(B);
      volume_.push_back(Dm.determinant() / 6);
    }
  }

  void make_mass() {  // consistent mass: rho V / 10 on the diagonal, rho V / 20 off the diagonal
    Triplets triplets;
    for (int t = 0; t < mesh_.tet_count(); ++t) {
      for (int a : mesh_.tets[t]) {
        for (int b : mesh_.tets[t]) {
          for (int i = 0; i < 3; ++i) {
            triplets.emplace_back(3 * a + i, 3 * b + i, kDensity * volume_[t] * (a == b ? 0.1 : 0.05));
          }
        }
      }
    }
    mass_.resize(q_.size(), q_.size());
    mass_.setFromTriplets(triplets.begin(), triplets.end());
  }

  void make_selection() {  // rows of the identity for the free coordinates
    Triplets triplets;
    int row = 0;
    for (int i = 0; i < mesh_.vertex_count(); ++i) {
      for (int c = 0; c < 3 && !is_clamped(mesh_, i); ++c) triplets.emplace_back(row++, 3 * i + c, 1.0);
    }
    select_.resize(row, q_.size());
    select_.setFromTriplets(triplets.begin(), triplets.end());
  }

  Matrix3d deformation_gradient(const VectorXd& x, int t) const {
    Vector12d u;
    for (int corner = 0; corner < 4; ++corner) u.segment<3>(3 * corner) = x.segment<3>(3 * mesh_.tets[t][corner]);
    const Vector9d f = B_[t] * u;
    return Map<const Matrix3d>(f.data());
  }

  double objective(const VectorXd& x, const VectorXd& predicted) const {
    double V = -weight_.dot(x);
    for (int t = 0; t < mesh_.tet_count(); ++t) V += volume_[t] * psi(solid_, deformation_gradient(x, t));
    const VectorXd difference = x - predicted;
    return 0.5 * difference.dot(mass_ * difference) + h_ * h_ * V;
  }

  VectorXd gradient(const VectorXd& x, const VectorXd& predicted) const {
    VectorXd dV = -weight_;
    for (int t = 0; t < mesh_.tet_count(); ++t) {
      const Matrix3d P = pk1(solid_, deformation_gradient(x, t));
      const Vector12d g = volume_[t] * B_[t].transpose() * Map<const Vector9d>(P.data());
      for (int corner = 0; corner < 4; ++corner) dV.segment<3>(3 * mesh_.tets[t][corner]) += g.segment<3>(3 * corner);
    }
    return mass_ * (x - predicted) + h_ * h_ * dV;
  }

  SparseMatrix objective_hessian(const VectorXd& x) const {
    Triplets triplets;
    for (int t = 0; t < mesh_.tet_count(); ++t) {
      const Matrix12d H = volume_[t] * B_[t].transpose() * hessian(solid_, deformation_gradient(x, t)) * B_[t];
      for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 12; ++j) {
          triplets.emplace_back(3 * mesh_.tets[t][i / 3] + i % 3, 3 * mesh_.tets[t][j / 3] + j % 3, H(i, j));
        }
      }
    }
    SparseMatrix K(q_.size(), q_.size());
    K.setFromTriplets(triplets.begin(), triplets.end());
    const SparseMatrix H = mass_ + h_ * h_ * K;
    return select_ * H * select_.transpose();
  }

  Solid solid_;
  double h_;          // [s]
  double tolerance_;  // relative to the first gradient
  TetMesh mesh_;
  VectorXd q_, v_, weight_;
  std::vector<Matrix9x12d> B_;
  std::vector<double> volume_;
  SparseMatrix mass_, select_;
};

}  // namespace

BeamResult run_naive(const BeamProblem& problem) {
  Stopwatch stopwatch;
  NaiveBeam beam(problem);
  BeamResult result;
  result.set_up = stopwatch.lap();
  for (int i = 0; i < problem.steps; ++i) result.iterations += beam.step();
  result.steps = stopwatch.lap();
  result.displacement = beam.displacement(tip_vertex(problem.n));
  return result;
}

}  // namespace aspic::bench
