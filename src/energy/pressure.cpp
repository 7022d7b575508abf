#include "energy/pressure.h"

#include <algorithm>
#include <array>

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

// Volume swept by one triangle. m is the mean displacement, d_k the displacement of corner k relative to corner 0, E_k
// the edge from corner 0 to corner k.
//   swept = m . A,   A = (E1 x E2 + (E1 x d2 + d1 x E2) / 2 + d1 x d2 / 3) / 2
struct Sweep {
  Vec3d m, A, w1, w2;  // w_k = E_k / 2 + d_k / 3, so that dA = (w1 x delta2 + delta1 x w2) / 2

  double volume() const { return dot(m, A); }

  std::array<Vec3d, 3> gradient() const {
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

// Volume swept by a patch, its derivatives, and the slots of its blocks.
class SweptVolume {
 public:
  SweptVolume(const TetMesh& mesh, std::vector<Triangle> patch) : patch_(std::move(patch)) {
    for (const Triangle& t : patch_) rest_.push_back({mesh.rest[t[0]], mesh.rest[t[1]], mesh.rest[t[2]]});
  }

  double value(Positions x) const {
    double sum = 0;
    for (size_t t = 0; t < patch_.size(); ++t) sum += sweep(x, t).volume();
    return sum;
  }

  // g += scale pressure d(volume)/dx
  void add_gradient(Positions x, double pressure, double scale, std::span<double> g) const {
    for (size_t t = 0; t < patch_.size(); ++t) {
      const std::array<Vec3d, 3> forces = sweep(x, t).gradient();
      for (int i = 0; i < 3; ++i)
        for (int r = 0; r < 3; ++r) g[3 * patch_[t][i] + r] += scale * pressure * forces[i][r];
    }
  }

  void add_couplings(Couplings& couplings) const {
    for (const Triangle& t : patch_)
      for (int i = 0; i < 3; ++i) couplings.emplace_back(t[i], t[(i + 1) % 3]);
  }

  void bind(const BlockPattern& pattern) {
    slot_.resize(patch_.size());
    for (size_t t = 0; t < patch_.size(); ++t)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const auto [low, high] = std::minmax(patch_[t][i], patch_[t][j]);
          slot_[t][3 * i + j] = pattern.slot(high, low);
        }
  }

  // H += scale pressure d2(volume)/dx2. Returns the number of modified elements.
  int add_hessian(Positions x, double pressure, double scale, const Projection& projection, BlockSparse& H) const {
    int projected = 0;
    for (size_t t = 0; t < patch_.size(); ++t) {
      Mat9d K = hessian(sweep(x, t), pressure);
      const auto covers = [&](int v) { return projection.covers(v); };
      if (projection.kind != Definiteness::exact && std::any_of(patch_[t].begin(), patch_[t].end(), covers)) {
        const bool is_clamped = projection.kind == Definiteness::clamped;
        projected += modify_hessian(K, is_clamped ? EigenvalueFilter::clamp : EigenvalueFilter::absolute, 1) != 0;
      }
      add_blocks(t, scale, K, H);
    }
    return projected;
  }

 private:
  Sweep sweep(Positions x, size_t t) const {
    const auto& X = rest_[t];
    const Vec3d u0 = point(x, patch_[t][0]) - X[0], u1 = point(x, patch_[t][1]) - X[1];
    const Vec3d u2 = point(x, patch_[t][2]) - X[2];
    const Vec3d E1 = X[1] - X[0], E2 = X[2] - X[0], d1 = u1 - u0, d2 = u2 - u0;
    const Vec3d w1 = 0.5 * E1 + (1.0 / 3) * d1, w2 = 0.5 * E2 + (1.0 / 3) * d2;
    const Vec3d A = 0.5 * (cross(E1, E2) + 0.5 * (cross(E1, d2) + cross(d1, E2)) + (1.0 / 3) * cross(d1, d2));
    return {(1.0 / 3) * (u0 + u1 + u2), A, w1, w2};
  }

  static Mat9d hessian(const Sweep& s, double pressure) {
    Mat9d K{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) add_cross(K, i, j, pressure * s.twist(i, j));
    return K;
  }

  void add_blocks(size_t t, double scale, const Mat9d& K, BlockSparse& H) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (patch_[t][j] > patch_[t][i]) continue;
        Mat3d& block = H.block[slot_[t][3 * i + j]];
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) block(r, c) += scale * K(3 * i + r, 3 * j + c);
      }
  }

  std::vector<Triangle> patch_;
  std::vector<std::array<Vec3d, 3>> rest_;    // X of the corners of each triangle
  std::vector<std::array<int64_t, 9>> slot_;  // blocks (i, j) of the larger and the smaller vertex
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

std::unique_ptr<Pressure> make_pressure(const TetMesh& mesh, std::vector<Triangle> patch, double pressure) {
  return std::make_unique<SteadyPressure>(SweptVolume(mesh, std::move(patch)), pressure);
}

std::unique_ptr<Energy> make_pressure(std::string name, const TetMesh& mesh, std::vector<Triangle> patch,
                                      PressureOfTime pressure) {
  return std::make_unique<VaryingPressure>(std::move(name), SweptVolume(mesh, std::move(patch)), std::move(pressure));
}

}  // namespace aspic
