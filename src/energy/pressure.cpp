#include "energy/pressure.h"

#include <algorithm>
#include <array>

#include "energy/quadratic_face.h"
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

// Volume swept by one triangle. m is the mean displacement, d_k the displacement of corner k relative to corner 0, E_k
// the edge from corner 0 to corner k.
//   swept = m . A,   A = (E1 x E2 + (E1 x d2 + d1 x E2) / 2 + d1 x d2 / 3) / 2
struct Sweep {
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
};

// A linear triangle, or the one that represents a quadratic face at a quadrature point.
struct Element {
  const FacePoint* point;
  int node_count;
  std::array<int, 6> node;
  std::array<Vec3d, 6> rest;       // X of the nodes, the corners of the face first
  std::array<int64_t, 36> slot{};  // blocks (i, j) of the larger and the smaller node

  std::span<const int> nodes() const { return std::span(node).first(node_count); }

  Sweep sweep(Positions x) const {
    Corners u{};
    for (int n = 0; n < node_count; ++n) {
      const Vec3d d = aspic::point(x, node[n]) - rest[n];
      for (int k = 0; k < 3; ++k) u[k] = u[k] + point->shares[k][n] * d;
    }
    return {{rest[0], rest[1], rest[2]}, u};
  }
};

// Volume swept by a patch, its derivatives, and the slots of its blocks.
class SweptVolume {
 public:
  SweptVolume(const TetMesh& mesh, std::span<const Face> patch) {
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

  double value(Positions x) const {
    double sum = 0;
    for (const Element& element : elements_) sum += element.point->weight * element.sweep(x).volume();
    return sum;
  }

  // g += scale pressure d(volume)/dx
  void add_gradient(Positions x, double pressure, double scale, std::span<double> g) const {
    for (const Element& element : elements_) {
      const Corners forces = element.sweep(x).gradient();
      for (int n = 0; n < element.node_count; ++n)
        for (int k = 0; k < 3; ++k) {
          const double share = element.point->weight * element.point->shares[k][n];
          if (share == 0) continue;
          for (int r = 0; r < 3; ++r) g[3 * element.node[n] + r] += scale * pressure * (share * forces[k][r]);
        }
    }
  }

  void add_couplings(Couplings& couplings) const {
    for (const Element& element : elements_)
      for (int i = 0; i < element.node_count; ++i)
        for (int j = 0; j < i; ++j) couplings.emplace_back(element.node[i], element.node[j]);
  }

  void bind(const BlockPattern& pattern) {
    for (Element& element : elements_)
      for (int i = 0; i < element.node_count; ++i)
        for (int j = 0; j < element.node_count; ++j) {
          const auto [low, high] = std::minmax(element.node[i], element.node[j]);
          element.slot[6 * i + j] = pattern.slot(high, low);
        }
  }

  // H += scale pressure d2(volume)/dx2. Returns the number of modified elements.
  int add_hessian(Positions x, double pressure, double scale, const Projection& projection, BlockSparse& H) const {
    int projected = 0;
    for (const Element& element : elements_) {
      Mat9d K = hessian(element.sweep(x), pressure);
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

 private:
  static Mat9d hessian(const Sweep& s, double pressure) {
    Mat9d K{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) add_cross(K, i, j, pressure * s.twist(i, j));
    return K;
  }

  static void add_blocks(const Element& element, double scale, const Mat9d& K, BlockSparse& H) {
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

  std::vector<Element> elements_;
};

class SteadyPressure : public Pressure {
 public:
  SteadyPressure(SweptVolume volume, double pressure) : volume_(std::move(volume)), pressure_(pressure) {}

  std::string_view name() const override { return "pressure"; }
  void set_pressure(double pressure) override { pressure_ = pressure; }
  double pressure() const override { return pressure_; }
  double swept_volume(Positions x) const override { return volume_.value(x); }

  double value(Positions x, const Context&) const override { return pressure_ * volume_.value(x); }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    volume_.add_gradient(x, pressure_, scale, g);
  }
  void add_couplings(Couplings& couplings) const override { volume_.add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { volume_.bind(pattern); }
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return volume_.add_hessian(x, pressure_, scale, projection, H);
  }

 private:
  SweptVolume volume_;
  double pressure_;
};

class VaryingPressure : public Energy {
 public:
  VaryingPressure(std::string name, SweptVolume volume, PressureOfTime pressure)
      : name_(std::move(name)), volume_(std::move(volume)), pressure_(std::move(pressure)) {}

  std::string_view name() const override { return name_; }
  double value(Positions x, const Context& context) const override {
    return pressure_(context.time) * volume_.value(x);
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    volume_.add_gradient(x, pressure_(context.time), scale, g);
  }
  void add_couplings(Couplings& couplings) const override { volume_.add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { volume_.bind(pattern); }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return volume_.add_hessian(x, pressure_(context.time), scale, projection, H);
  }

 private:
  std::string name_;
  SweptVolume volume_;
  PressureOfTime pressure_;
};

}  // namespace

std::unique_ptr<Pressure> make_pressure(const TetMesh& mesh, std::span<const Face> patch, double pressure) {
  return std::make_unique<SteadyPressure>(SweptVolume(mesh, patch), pressure);
}

std::unique_ptr<Energy> make_pressure(std::string name, const TetMesh& mesh, std::span<const Face> patch,
                                      PressureOfTime pressure) {
  return std::make_unique<VaryingPressure>(std::move(name), SweptVolume(mesh, patch), std::move(pressure));
}

}  // namespace aspic
