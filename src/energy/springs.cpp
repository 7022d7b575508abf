#include "energy/springs.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

Vec3d point(Positions x, int vertex) { return {{x[3 * vertex], x[3 * vertex + 1], x[3 * vertex + 2]}}; }

void add_at(std::span<double> g, int vertex, double scale, const Vec3d& v) {
  for (int r = 0; r < 3; ++r) g[3 * vertex + r] += scale * v[r];
}

class PointSprings : public Energy {
 public:
  PointSprings(std::string name, std::vector<PointSpring> springs)
      : name_(std::move(name)), springs_(std::move(springs)), target_(springs_.size()), slot_(springs_.size()) {
    follow(0);
  }

  std::string_view name() const override { return name_; }

  void begin_step(const StepContext& step) override { follow(step.time); }

  double value(Positions x) const override {
    double V = 0;
    for (size_t s = 0; s < springs_.size(); ++s) {
      const Vec3d u = point(x, springs_[s].vertex) - target_[s];
      V += 0.5 * springs_[s].stiffness * dot(u, u);
    }
    return V;
  }

  void add_gradient(Positions x, double scale, std::span<double> g) const override {
    for (size_t s = 0; s < springs_.size(); ++s)
      add_at(g, springs_[s].vertex, scale * springs_[s].stiffness, point(x, springs_[s].vertex) - target_[s]);
  }

  void bind(const BlockPattern& pattern) override {
    for (size_t s = 0; s < springs_.size(); ++s) slot_[s] = pattern.diagonal(springs_[s].vertex);
  }

  int add_hessian(Positions, double scale, const Projection&, BlockSparse& H) const override {
    for (size_t s = 0; s < springs_.size(); ++s)
      for (int r = 0; r < 3; ++r) H.block[slot_[s]](r, r) += scale * springs_[s].stiffness;
    return 0;
  }

 private:
  void follow(double time) {
    for (size_t s = 0; s < springs_.size(); ++s) target_[s] = springs_[s].target(time);
  }

  std::string name_;
  std::vector<PointSpring> springs_;
  std::vector<Vec3d> target_;
  std::vector<int64_t> slot_;
};

class VertexSprings : public Energy {
 public:
  VertexSprings(std::string name, std::vector<Spring> springs)
      : name_(std::move(name)), springs_(std::move(springs)), slot_(springs_.size()) {
    for (Spring& s : springs_)
      if (s.a < s.b) std::swap(s.a, s.b);
  }

  std::string_view name() const override { return name_; }

  double value(Positions x) const override {
    double V = 0;
    for (const Spring& s : springs_) {
      const double stretch = length(x, s) - s.rest_length;
      V += 0.5 * s.stiffness * stretch * stretch;
    }
    return V;
  }

  void add_gradient(Positions x, double scale, std::span<double> g) const override {
    for (const Spring& s : springs_) {
      const double l = length(x, s);
      if (l == 0) continue;  // no direction: the force of a collapsed spring is undefined, taken as zero
      const Vec3d u = point(x, s.a) - point(x, s.b);
      const double tension_per_length = s.stiffness * (1 - s.rest_length / l);
      add_at(g, s.a, scale * tension_per_length, u);
      add_at(g, s.b, -scale * tension_per_length, u);
    }
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Spring& s : springs_) couplings.emplace_back(s.a, s.b);
  }

  void bind(const BlockPattern& pattern) override {
    for (size_t i = 0; i < springs_.size(); ++i)
      slot_[i] = {pattern.diagonal(springs_[i].a), pattern.diagonal(springs_[i].b),
                  pattern.slot(springs_[i].a, springs_[i].b)};
  }

  // K = k (n n' + (1 - l0/l) (I - n n')); the second factor is negative for a compressed spring.
  int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const override {
    int projected = 0;
    for (size_t i = 0; i < springs_.size(); ++i) {
      const Spring& s = springs_[i];
      const double l = length(x, s);
      const Vec3d n = l > 0 ? (1 / l) * (point(x, s.a) - point(x, s.b)) : Vec3d{{1, 0, 0}};
      double across = l > 0 ? 1 - s.rest_length / l : 0;
      if (across < 0 && projection.kind != Definiteness::exact && (projection.covers(s.a) || projection.covers(s.b))) {
        across = projection.kind == Definiteness::clamped ? 0 : -across;
        ++projected;
      }
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) {
          const double k = scale * s.stiffness * ((1 - across) * n[r] * n[c] + (r == c ? across : 0));
          H.block[slot_[i][0]](r, c) += k;
          H.block[slot_[i][1]](r, c) += k;
          H.block[slot_[i][2]](r, c) -= k;
        }
    }
    return projected;
  }

 private:
  static double length(Positions x, const Spring& s) {
    const Vec3d u = point(x, s.a) - point(x, s.b);
    return std::sqrt(dot(u, u));
  }

  std::string name_;
  std::vector<Spring> springs_;
  std::vector<std::array<int64_t, 3>> slot_;  // blocks (a, a), (b, b), (a, b)
};

}  // namespace

std::unique_ptr<Energy> make_point_springs(std::string name, std::vector<PointSpring> springs) {
  return std::make_unique<PointSprings>(std::move(name), std::move(springs));
}

std::unique_ptr<Energy> make_springs(std::string name, std::vector<Spring> springs) {
  return std::make_unique<VertexSprings>(std::move(name), std::move(springs));
}

std::vector<Spring> edge_springs(const TetMesh& mesh, int first, int count, double stiffness) {
  std::vector<std::pair<int, int>> edges;
  for (int t = first; t < first + count; ++t)
    for (int u = 0; u < 4; ++u)
      for (int v = 0; v < u; ++v) edges.push_back(std::minmax(mesh.tets[t][u], mesh.tets[t][v]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Spring> springs;
  for (const auto& [a, b] : edges) {
    const Vec3d u = mesh.rest[a] - mesh.rest[b];
    springs.push_back({a, b, std::sqrt(dot(u, u)), stiffness});
  }
  return springs;
}

}  // namespace aspic
