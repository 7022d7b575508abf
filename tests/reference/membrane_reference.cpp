#include "reference/membrane_reference.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace aspic::verify {
namespace {

using Vector = std::vector<double>;
using Vec2 = std::array<double, 2>;
using Mat2 = std::array<double, 4>;  // row-major

double inner(const Mat2& A, const Mat2& B) { return A[0] * B[0] + A[1] * B[1] + A[2] * B[2] + A[3] * B[3]; }
Mat2 cofactor(const Mat2& F) { return {F[3], -F[2], -F[1], F[0]}; }

// Symmetric matrix whose entries are zero farther than `band` from the diagonal.
class BandMatrix {
 public:
  BandMatrix(int size, int band) : size_(size), band_(band), a_(static_cast<size_t>(size) * (band + 1)) {}
  double& at(int i, int j) { return a_[static_cast<size_t>(i) * (band_ + 1) + (i - j)]; }  // j <= i

  Vector solve(Vector b) {  // in-place L D L' solution; call once
    for (int i = 0; i < size_; ++i) {
      const int first = first_in(i);
      for (int j = first; j < i; ++j)  // row of L D
        for (int k = std::max(first, first_in(j)); k < j; ++k) at(i, j) -= at(i, k) * at(j, k);
      for (int j = first; j < i; ++j) {
        const double l = at(i, j) / at(j, j);
        at(i, i) -= l * at(i, j);
        b[i] -= l * b[j];
        at(i, j) = l;
      }
    }
    for (int i = 0; i < size_; ++i) b[i] /= at(i, i);
    for (int i = size_ - 1; i >= 0; --i)
      for (int j = first_in(i); j < i; ++j) b[j] -= at(i, j) * b[i];
    return b;
  }

 private:
  int first_in(int i) const { return std::max(0, i - band_); }

  int size_, band_;
  Vector a_;
};

// The three shape functions on a line from -1 to 1, and their slopes.
struct Line {
  std::array<double, 3> value, slope;
  explicit Line(double t) : value{t * (t - 1) / 2, 1 - t * t, t * (t + 1) / 2}, slope{t - 0.5, -2 * t, t + 0.5} {}
};

struct GaussPoint {
  double weight;                  // volume per thickness
  std::array<Vec2, 9> gradients;  // gradients of the shape functions
};

class Membrane {
 public:
  Membrane(const InvariantLaw& law, int cells) : law_(law), cells_(cells), side_(2 * cells + 1) {
    for (int i = 0; i < side_; ++i)
      for (int j = 0; j < side_; ++j) {
        const double x = graded(i, [](double t) { return t * t; });
        const double y = graded(j, [](double t) { return t * t * (3 - 2 * t); });
        rest_.push_back({48 * x, 44 * x + y * (44 - 28 * x)});
      }
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) add_gauss_points(i, j);
  }

  double solved(double traction) {
    constexpr int kParts = 5;
    u_.assign(2 * rest_.size(), 0.0);
    for (int part = 1; part <= kParts; ++part) find_equilibrium(traction * part / kParts);
    return u_[2 * node(side_ - 1, cells_) + 1];
  }

 private:
  // The middle node is at the center of the element.
  template <class Grading>
  double graded(int k, Grading grading) const {
    const auto end = [&](int e) { return grading(static_cast<double>(e) / cells_); };
    return k % 2 == 0 ? end(k / 2) : (end(k / 2) + end(k / 2 + 1)) / 2;
  }
  int node(int i, int j) const { return i * side_ + j; }
  std::array<int, 9> nodes_of(size_t element) const {
    const int i = 2 * (static_cast<int>(element) / cells_), j = 2 * (static_cast<int>(element) % cells_);
    std::array<int, 9> nodes;
    for (int a = 0; a < 9; ++a) nodes[a] = node(i + a / 3, j + a % 3);
    return nodes;
  }

  void add_gauss_points(int i, int j) {
    const double g = std::sqrt(0.6);
    const std::array<double, 3> at = {-g, 0, g}, weight = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    const std::array<int, 9> nodes = nodes_of(static_cast<size_t>(i) * cells_ + j);
    std::array<GaussPoint, 9> points;
    for (int p = 0; p < 9; ++p) {
      const Line x(at[p / 3]), y(at[p % 3]);
      std::array<Vec2, 9> slopes;
      Mat2 J{};
      for (int a = 0; a < 9; ++a) {
        slopes[a] = {x.slope[a / 3] * y.value[a % 3], x.value[a / 3] * y.slope[a % 3]};
        for (int r = 0; r < 2; ++r)
          for (int c = 0; c < 2; ++c) J[2 * r + c] += rest_[nodes[a]][r] * slopes[a][c];
      }
      const double det = J[0] * J[3] - J[1] * J[2];
      points[p].weight = det * weight[p / 3] * weight[p % 3];
      for (int a = 0; a < 9; ++a) {
        const auto& [s, t] = slopes[a];
        points[p].gradients[a] = {(s * J[3] - t * J[2]) / det, (t * J[0] - s * J[1]) / det};
      }
    }
    points_.push_back(points);
  }

  // Adds forces to r and stiffness to K; degrees of freedom begin after the clamped nodes.
  void assemble(Vector& r, BandMatrix& K) const {
    for (size_t e = 0; e < points_.size(); ++e) {
      const std::array<int, 9> nodes = nodes_of(e);
      for (const GaussPoint& point : points_[e]) add_point(nodes, point, r, K);
    }
  }
  void add_point(const std::array<int, 9>& nodes, const GaussPoint& point, Vector& r, BandMatrix& K) const {
    Mat2 F = {1, 0, 0, 1};
    for (int a = 0; a < 9; ++a)
      for (int c = 0; c < 4; ++c) F[c] += u_[2 * nodes[a] + c / 2] * point.gradients[a][c % 2];
    const Mat2 cof = cofactor(F);
    const double J = inner(F, cof) / 2;
    const InvariantDerivatives f = law_(inner(F, F) + 1, J);
    for (int a = 0; a < 9; ++a)
      for (int k = 0; k < 2; ++k) {
        const int row = dof(nodes[a], k);
        if (row < 0) continue;
        Mat2 D{};  // derivative of F with respect to the displacement of this node
        D[2 * k] = point.gradients[a][0], D[2 * k + 1] = point.gradients[a][1];
        const double dI = 2 * inner(F, D), dJ = inner(cof, D);
        r[row] += point.weight * (f.by_I * dI + f.by_J * dJ);
        const double f_I = f.by_II * dI + f.by_IJ * dJ, f_J = f.by_IJ * dI + f.by_JJ * dJ;
        const Mat2 dcof = cofactor(D);
        Mat2 dP;
        for (int c = 0; c < 4; ++c) dP[c] = 2 * (f.by_I * D[c] + f_I * F[c]) + f_J * cof[c] + f.by_J * dcof[c];
        for (int b = 0; b < 9; ++b)
          for (int l = 0; l < 2; ++l) {
            const int column = dof(nodes[b], l);
            if (column < 0 || column > row) continue;
            K.at(row, column) +=
                point.weight * (dP[2 * l] * point.gradients[b][0] + dP[2 * l + 1] * point.gradients[b][1]);
          }
      }
  }
  int dof(int n, int k) const { return 2 * (n - side_) + k; }

  void find_equilibrium(double traction) {
    const int size = 2 * (static_cast<int>(rest_.size()) - side_);
    for (int iteration = 0; iteration < 20; ++iteration) {
      Vector r(size);
      BandMatrix K(size, 4 * side_ + 5);
      assemble(r, K);
      for (int j = 0; j + 2 < side_; j += 2) {
        const int first = node(side_ - 1, j);
        const double share = traction * (rest_[first + 2][1] - rest_[first][1]) / 6;
        for (int a = 0; a < 3; ++a) r[dof(first + a, 1)] -= (a == 1 ? 4 : 1) * share;
      }
      const Vector d = K.solve(r);
      double most = 0;
      for (int i = 0; i < size; ++i) u_[2 * side_ + i] -= d[i], most = std::fmax(most, std::abs(d[i]));
      if (most < 1e-10) return;
    }
    throw std::runtime_error("the reference of Cook's membrane did not converge");
  }

  const InvariantLaw& law_;
  int cells_, side_;  // nodes per edge
  std::vector<Vec2> rest_;
  std::vector<std::array<GaussPoint, 9>> points_;
  Vector u_;
};

}  // namespace

InvariantLaw logarithmic_law(double mu, double lambda) {
  return [=](double, double J) -> InvariantDerivatives {
    const double log_J = std::log(J);
    return {mu / 2, (lambda * log_J - mu) / J, 0, 0, (mu + lambda - lambda * log_J) / (J * J)};
  };
}

InvariantLaw split_law(double mu, std::function<std::array<double, 2>(double J)> volume) {
  return [mu, volume = std::move(volume)](double I1, double J) -> InvariantDerivatives {
    const double p = mu * std::pow(J, -2 / 3.0);
    const auto [dU, ddU] = volume(J);
    return {p / 2, dU - p * I1 / (3 * J), 0, -p / (3 * J), ddU + 5 * p * I1 / (9 * J * J)};
  };
}

double membrane_reference(const InvariantLaw& law, double traction, int cells) {
  return Membrane(law, cells).solved(traction);
}

}  // namespace aspic::verify
