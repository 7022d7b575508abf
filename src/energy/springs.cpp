#include "energy/springs.h"

#include <algorithm>

namespace aspic {
namespace {

void add_at(std::span<double> g, int vertex, double scale, const Vec3d& v) {
  for (int r = 0; r < 3; ++r) g[3 * vertex + r] += scale * v[r];
}

class PointSprings : public Energy {
 public:
  PointSprings(std::string name, std::vector<PointSpring> springs)
      : name_(std::move(name)), springs_(std::move(springs)), slot_(springs_.size()) {}

  std::string_view name() const override { return name_; }

  std::unique_ptr<Context> make_context() const override {
    auto targets = std::make_unique<Targets>();
    PointSprings::begin_step({}, *targets);
    return targets;
  }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    std::vector<Vec3d>& target = static_cast<Targets&>(context).target;
    target.resize(springs_.size());
    for (size_t s = 0; s < springs_.size(); ++s) target[s] = springs_[s].target(step.time);
  }

  double value(Positions x, const Context& context) const override {
    double V = 0;
    for (size_t s = 0; s < springs_.size(); ++s) {
      const Vec3d u = point(x, springs_[s].vertex) - target(context, s);
      V += 0.5 * springs_[s].stiffness * dot(u, u);
    }
    return V;
  }

  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    for (size_t s = 0; s < springs_.size(); ++s)
      add_at(g, springs_[s].vertex, scale * springs_[s].stiffness, point(x, springs_[s].vertex) - target(context, s));
  }

  void bind(const BlockPattern& pattern) override {
    for (size_t s = 0; s < springs_.size(); ++s) slot_[s] = pattern.diagonal(springs_[s].vertex);
  }

  int add_hessian(Positions, const Context&, double scale, const Projection&, BlockSparse& H) const override {
    for (size_t s = 0; s < springs_.size(); ++s)
      for (int r = 0; r < 3; ++r) H.block[slot_[s]](r, r) += scale * springs_[s].stiffness;
    return 0;
  }

 private:
  struct Targets : Context {
    std::vector<Vec3d> target;  // target of each spring at the time [m]
  };
  static const Vec3d& target(const Context& context, size_t spring) {
    return static_cast<const Targets&>(context).target[spring];
  }

  std::string name_;
  std::vector<PointSpring> springs_;
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

  double value(Positions x, const Context&) const override {
    double V = 0;
    for (const Spring& s : springs_) {
      const double stretch = length(x, s) - s.rest_length;
      V += 0.5 * s.stiffness * stretch * stretch;
    }
    return V;
  }

  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    for (const Spring& s : springs_) {
      const Vec3d tension = pull(x, s);
      add_at(g, s.a, scale, tension);
      add_at(g, s.b, -scale, tension);
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

  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    int projected = 0;
    for (size_t i = 0; i < springs_.size(); ++i) {
      const Spring& s = springs_[i];
      double across = stretch_across(x, s);
      if (across < 0 && projection.kind != Definiteness::exact && (projection.covers(s.a) || projection.covers(s.b))) {
        across = projection.kind == Definiteness::clamped ? 0 : -across;
        ++projected;
      }
      const Mat3d K = block(x, s, across);
      for (int m = 0; m < 9; ++m) {
        H.block[slot_[i][0]].a[m] += scale * K.a[m];
        H.block[slot_[i][1]].a[m] += scale * K.a[m];
        H.block[slot_[i][2]].a[m] -= scale * K.a[m];
      }
    }
    return projected;
  }

 private:
  // Returns dV/dx of vertex a minus that of vertex b; zero for a collapsed spring, whose direction is undefined.
  static Vec3d pull(Positions x, const Spring& s) {
    const double l = length(x, s);
    return l == 0 ? Vec3d{} : (s.stiffness * (1 - s.rest_length / l)) * (point(x, s.a) - point(x, s.b));
  }
  static double stretch_across(Positions x, const Spring& s) {
    const double l = length(x, s);
    return l > 0 ? 1 - s.rest_length / l : 0;
  }
  // K = k (n n' + across (I - n n')), across = 1 - l0/l, which is negative for a compressed spring.
  static Mat3d block(Positions x, const Spring& s, double across) {
    const double l = length(x, s);
    const Vec3d n = l > 0 ? (1 / l) * (point(x, s.a) - point(x, s.b)) : Vec3d{{1, 0, 0}};
    Mat3d K;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) K(r, c) = s.stiffness * ((1 - across) * n[r] * n[c] + (r == c ? across : 0));
    return K;
  }

  static double length(Positions x, const Spring& s) {
    const Vec3d u = point(x, s.a) - point(x, s.b);
    return norm(u);
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
    springs.push_back({a, b, norm(u), stiffness});
  }
  return springs;
}

}  // namespace aspic
