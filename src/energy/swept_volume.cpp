#include "energy/swept_volume.h"

#include <algorithm>

#include "math/definite.h"

namespace aspic {
namespace {

// Adds the matrix of a -> q x a to the 3x3 block (i, j) of K.
void add_cross(Mat9d& K, int i, int j, const Vec3d& q) {
  for (int r = 0; r < 3; ++r) {
    const int s = (r + 1) % 3, t = (r + 2) % 3;
    K(3 * i + s, 3 * j + r) += q[t];
    K(3 * i + t, 3 * j + r) -= q[s];
  }
}

using Corners = std::array<Vec3d, 3>;

}  // namespace

// Volume swept by one triangle. m is the mean displacement, d_k the displacement of corner k relative to corner 0, E_k
// the edge from corner 0 to corner k.
//   swept = m . A,   A = (E1 x E2 + (E1 x d2 + d1 x E2) / 2 + d1 x d2 / 3) / 2
struct SweptVolume::Sweep {
  Vec3d m, A, w1, w2;  // w_k = E_k / 2 + d_k / 3, so that dA = (w1 x delta2 + delta1 x w2) / 2

  Sweep(const Corners& X, const Corners& u) {
    const Vec3d E1 = X[1] - X[0], E2 = X[2] - X[0], d1 = u[1] - u[0], d2 = u[2] - u[0];
    w1 = 0.5 * E1 + (1.0 / 3) * d1, w2 = 0.5 * E2 + (1.0 / 3) * d2;
    A = 0.5 * (cross(E1, E2) + 0.5 * (cross(E1, d2) + cross(d1, E2)) + (1.0 / 3) * cross(d1, d2));
    m = (1.0 / 3) * (u[0] + u[1] + u[2]);
  }

  double volume() const { return dot(m, A); }

  Corners gradient() const {
    const Vec3d by_d1 = 0.5 * cross(w2, m), by_d2 = 0.5 * cross(m, w1), by_m = (1.0 / 3) * A;
    return {by_m - by_d1 - by_d2, by_m + by_d1, by_m + by_d2};
  }

  // d2(swept) / du_i du_j = [q_ij]x, antisymmetric in i and j.
  Vec3d twist(int i, int j) const {
    constexpr double kM = 1.0 / 3, kD1[3] = {-1, 1, 0}, kD2[3] = {-1, 0, 1};
    return (0.5 * kM * (kD1[i] - kD1[j])) * w2 + (0.5 * kM * (kD2[j] - kD2[i])) * w1 +
           ((kD2[i] * kD1[j] - kD1[i] * kD2[j]) / 6) * m;
  }

  Mat9d hessian(double pressure) const {
    Mat9d K{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) add_cross(K, i, j, pressure * twist(i, j));
    return K;
  }
};

SweptVolume::Sweep SweptVolume::sweep(const Element& element, Positions x) {
  Corners u{};
  for (int n = 0; n < element.node_count; ++n) {
    const Vec3d d = aspic::point(x, element.node[n]) - element.rest[n];
    for (int k = 0; k < 3; ++k) u[k] = u[k] + element.point->shares[k][n] * d;
  }
  return {{element.rest[0], element.rest[1], element.rest[2]}, u};
}

SweptVolume::SweptVolume(const TetMesh& mesh, std::span<const Face> patch) {
  for (const Face& face : patch) {
    Element element{&kLinearPoint, face.is_quadratic() ? 6 : 3, nodes_of(face), {}};
    for (int n = 0; n < element.node_count; ++n) element.rest[n] = mesh.rest[element.node[n]];
    if (!face.is_quadratic()) elements_.push_back(element);
    for (size_t q = 0; q < kFacePoints.size() && face.is_quadratic(); ++q) {
      element.point = &kFacePoints[q];
      elements_.push_back(element);
    }
  }
}

double SweptVolume::value(Positions x) const {
  double sum = 0;
  for (const Element& element : elements_) sum += element.point->weight * sweep(element, x).volume();
  return sum;
}

void SweptVolume::add_gradient(Positions x, double scale, std::span<double> g) const {
  for (const Element& element : elements_) {
    const Corners forces = sweep(element, x).gradient();
    for (int n = 0; n < element.node_count; ++n)
      for (int k = 0; k < 3; ++k) {
        const double share = element.point->weight * element.point->shares[k][n];
        if (share == 0) continue;
        for (int r = 0; r < 3; ++r) g[3 * element.node[n] + r] += scale * (share * forces[k][r]);
      }
  }
}

void SweptVolume::add_couplings(Couplings& couplings) const {
  for (const Element& element : elements_)
    for (int i = 0; i < element.node_count; ++i)
      for (int j = 0; j < i; ++j) couplings.emplace_back(element.node[i], element.node[j]);
}

void SweptVolume::bind(const BlockPattern& pattern) {
  for (Element& element : elements_)
    for (int i = 0; i < element.node_count; ++i)
      for (int j = 0; j < element.node_count; ++j) {
        const auto [low, high] = std::minmax(element.node[i], element.node[j]);
        element.slot[6 * i + j] = pattern.slot(high, low);
      }
}

int SweptVolume::add_hessian(Positions x, double pressure, double scale, const Projection& projection,
                             BlockSparse& H) const {
  int projected = 0;
  for (const Element& element : elements_) {
    Mat9d K = sweep(element, x).hessian(pressure);
    const auto covers = [&](int v) { return projection.covers(v); };
    const std::span<const int> nodes = element.nodes();
    if (projection.kind != Definiteness::exact && std::any_of(nodes.begin(), nodes.end(), covers)) {
      const bool is_clamped = projection.kind == Definiteness::clamped;
      projected += modify_hessian(K, is_clamped ? EigenvalueFilter::clamp : EigenvalueFilter::absolute, 1) != 0;
    }
    add_blocks(element, scale * element.point->weight, K, H);
  }
  return projected;
}

void SweptVolume::add_blocks(const Element& element, double scale, const Mat9d& K, BlockSparse& H) {
  const auto& shares = element.point->shares;
  for (int n = 0; n < element.node_count; ++n)
    for (int m = 0; m < element.node_count; ++m) {
      if (element.node[m] > element.node[n]) continue;
      Mat3d& block = H.block[element.slot[6 * n + m]];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const double share = shares[i][n] * shares[j][m];
          if (share == 0) continue;
          for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) block(r, c) += scale * (share * K(3 * i + r, 3 * j + c));
        }
    }
}

}  // namespace aspic
