#include "energy/pressure_rim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "math/vectors.h"

namespace aspic {
namespace {

// Three Gauss points integrate polynomials of degree 5 along an edge: those of a quadratic one.
struct EdgePoint {
  double s, weight;
};
const std::array<EdgePoint, 3> kEdgePoints = {
    {{0.5 - std::sqrt(0.15), 5.0 / 18}, {0.5, 4.0 / 9}, {0.5 + std::sqrt(0.15), 5.0 / 18}}};

struct EdgeShapes {
  std::array<double, 3> value, slope;  // of the nodes a, b and between; with respect to s from 0 at a to 1 at b
};

EdgeShapes edge_shapes(double s, bool is_quadratic) {
  if (!is_quadratic) return {{1 - s, s, 0}, {-1, 1, 0}};
  return {{(1 - s) * (1 - 2 * s), s * (2 * s - 1), 4 * s * (1 - s)}, {4 * s - 3, 4 * s - 1, 4 - 8 * s}};
}

struct Edge {
  std::array<int, 3> node;  // indices in the rim: a, b, between
  int node_count;
  std::array<int64_t, 3> slot = {};        // blocks of the node pairs (1, 0), (2, 0), (2, 1)
  std::array<bool, 3> is_transposed = {};  // whether the second node of a pair has the larger number
};
constexpr int kPairs[3][2] = {{1, 0}, {2, 0}, {2, 1}};

struct RimUpdate {
  std::vector<double> before, change;  // of r where it was updated
};

// The lagged shape of the rim: x0 and r(x0), 3 numbers per node.
struct RimContext : Energy::Context {
  std::vector<double> shape, r;
  std::vector<RimUpdate> updates;  // the last ones of this step
};

// Anderson's acceleration: moves r to where the secant through the last updates has no change [Anderson 1965]. The
// lagged part of the tangent is antisymmetric, so that plain updates turn, and diverge under large pressures.
void accelerate(std::span<const RimUpdate> updates, std::vector<double>& r) {
  constexpr double kDependent = 1e-8;  // relative norm of the new part of a dependent difference
  std::vector<std::vector<double>> basis, steps;
  std::vector<double> left = updates.back().change;
  for (size_t k = updates.size() - 1; k > 0; --k) {
    std::vector<double> change = updates[k].change, step = updates[k].before;
    add_scaled(-1, updates[k - 1].change, change);
    add_scaled(-1, updates[k - 1].before, step);
    add_scaled(1, change, step);  // difference of r
    const double whole = norm(change);
    for (size_t j = 0; j < basis.size(); ++j) {
      const double part = dot(basis[j], change);
      add_scaled(-part, basis[j], change);
      add_scaled(-part, steps[j], step);
    }
    const double size = norm(change);
    if (!(size > kDependent * whole)) break;
    for (auto* v : {&change, &step})
      for (double& x : *v) x /= size;
    const double part = dot(change, left);
    add_scaled(-part, change, left);
    add_scaled(-part, step, r);
    basis.push_back(std::move(change));
    steps.push_back(std::move(step));
  }
}

class Rim : public PressureRim {
 public:
  Rim(const Energy& pressure, const TetMesh& mesh, std::span<const RimEdge> rim, std::function<double(double)> value)
      : pressure_(pressure), value_(std::move(value)) {
    std::map<int, int> index;
    const auto add = [&](int vertex) {
      const auto [found, is_new] = index.try_emplace(vertex, static_cast<int>(nodes_.size()));
      if (is_new) {
        nodes_.push_back(vertex);
        for (const double X : mesh.rest[vertex].a) rest_.push_back(X);
      }
      return found->second;
    };
    for (const RimEdge& of : rim)
      edges_.push_back(
          {.node = {add(of.a), add(of.b), of.mid < 0 ? -1 : add(of.mid)}, .node_count = of.mid < 0 ? 2 : 3});
  }

  std::string_view name() const override { return "pressure_rim"; }
  const Energy& pressure() const override { return pressure_; }

  void add_couplings(Couplings& couplings) const override {
    for (const Edge& edge : edges_)
      for_each_pair(edge, [&](int, int n, int m) { couplings.emplace_back(vertex(edge, n), vertex(edge, m)); });
  }
  void bind(const BlockPattern& pattern) override {
    for (Edge& edge : edges_)
      for_each_pair(edge, [&](int k, int n, int m) {
        const int a = vertex(edge, n), b = vertex(edge, m);
        edge.slot[k] = pattern.slot(std::max(a, b), std::min(a, b));
        edge.is_transposed[k] = a < b;
      });
  }

  std::unique_ptr<Context> make_context() const override {
    auto context = std::make_unique<RimContext>();
    context->shape = rest_;
    context->r.assign(rest_.size(), 0.0);
    return context;
  }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    static_cast<RimContext&>(context).updates.clear();
    lag(step.shape.empty() ? step.start : step.shape, context);
  }
  void update_lagged(Positions x, bool, Context& context) const override {
    auto& own = static_cast<RimContext&>(context);
    RimUpdate update{product(own, difference(x, own.shape)), {}};
    add_scaled(1, own.r, update.before);
    lag(x, context);
    update.change = own.r;
    add_scaled(-1, update.before, update.change);
    own.updates.push_back(std::move(update));
    if (own.updates.size() > kUpdates) own.updates.erase(own.updates.begin());
  }
  bool relax_lagged(Context& context) const override {
    auto& own = static_cast<RimContext&>(context);
    if (own.updates.size() < 2) return false;
    accelerate(own.updates, own.r);
    return true;
  }

  double value(Positions x, const Context& context) const override {
    const RimContext& own = rim(context);
    const std::vector<double> d = difference(x, own.shape), Sd = product(own, d);
    double sum = 0;
    for (size_t i = 0; i < d.size(); ++i) sum += (own.r[i] + 0.5 * Sd[i]) * d[i];
    return -value_(context.time) * sum;
  }

  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    const RimContext& own = rim(context);
    const std::vector<double> Sd = product(own, difference(x, own.shape));
    const double factor = -scale * value_(context.time);
    for (size_t n = 0; n < nodes_.size(); ++n)
      for (size_t r = 0; r < 3; ++r) g[3 * nodes_[n] + r] += factor * (own.r[3 * n + r] + Sd[3 * n + r]);
  }

  // The blocks (n, m) of S are [q]x, antisymmetric in n and m. Modified Hessians leave them out: they are indefinite.
  int add_hessian(Positions, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    const RimContext& own = rim(context);
    const double factor = -scale * value_(context.time);
    int omitted = 0;
    for (const Edge& edge : edges_) {
      bool is_modified = false;
      for (int n = 0; n < edge.node_count; ++n) is_modified |= projection.covers(vertex(edge, n));
      if (projection.kind != Definiteness::exact && is_modified) {
        ++omitted;
        continue;
      }
      for_each_pair(edge, [&](int k, int n, int m) {
        const Vec3d q = (edge.is_transposed[k] ? -factor : factor) * twist(edge, own.shape, n, m);
        for (int r = 0; r < 3; ++r) {
          const int s = (r + 1) % 3, t = (r + 2) % 3;
          H.block[edge.slot[k]](s, r) += q[t];
          H.block[edge.slot[k]](t, r) -= q[s];
        }
      });
    }
    return omitted;
  }

 private:
  static constexpr size_t kUpdates = 4;  // for the acceleration
  static const RimContext& rim(const Context& context) { return static_cast<const RimContext&>(context); }
  int vertex(const Edge& edge, int n) const { return nodes_[edge.node[n]]; }

  template <class Visit>
  static void for_each_pair(const Edge& edge, const Visit& visit) {
    for (int k = 0; k < (edge.node_count == 2 ? 1 : 3); ++k) visit(k, kPairs[k][0], kPairs[k][1]);
  }

  std::vector<double> difference(Positions x, const std::vector<double>& shape) const {
    std::vector<double> d(shape.size());
    for (size_t n = 0; n < nodes_.size(); ++n)
      for (size_t r = 0; r < 3; ++r) d[3 * n + r] = x[3 * nodes_[n] + r] - shape[3 * n + r];
    return d;
  }

  Vec3d displacement(const Edge& edge, const std::vector<double>& shape, int n) const {
    return point(shape, edge.node[n]) - point(rest_, edge.node[n]);
  }

  // Returns q of the block [q]x of S for two nodes: minus the integral of (N_n N_m' - N_m N_n') u / 6.
  Vec3d twist(const Edge& edge, const std::vector<double>& shape, int n, int m) const {
    Vec3d q{};
    for (const auto& [s, weight] : kEdgePoints) {
      const EdgeShapes N = edge_shapes(s, edge.node_count == 3);
      Vec3d u{};
      for (int k = 0; k < edge.node_count; ++k) u = u + N.value[k] * displacement(edge, shape, k);
      q = q - (weight / 6 * (N.value[n] * N.slope[m] - N.value[m] * N.slope[n])) * u;
    }
    return q;
  }

  std::vector<double> product(const RimContext& own, const std::vector<double>& d) const {  // S d
    std::vector<double> Sd(d.size());
    for (const Edge& edge : edges_)
      for_each_pair(edge, [&](int, int n, int m) {
        const Vec3d q = twist(edge, own.shape, n, m);
        add_vec(cross(q, point(d, edge.node[m])), edge.node[n], Sd);
        add_vec(cross(point(d, edge.node[n]), q), edge.node[m], Sd);
      });
    return Sd;
  }

  void lag(Positions x, Context& context) const {
    auto& own = static_cast<RimContext&>(context);
    own.shape.assign(3 * nodes_.size(), 0.0);
    own.shape = difference(x, own.shape);
    own.r.assign(own.shape.size(), 0.0);
    for (const Edge& edge : edges_)
      for (const auto& [s, weight] : kEdgePoints) {
        const EdgeShapes N = edge_shapes(s, edge.node_count == 3);
        Vec3d u{}, w{};
        for (int n = 0; n < edge.node_count; ++n) {
          const Vec3d d = displacement(edge, own.shape, n);
          u = u + N.value[n] * d;
          w = w + N.slope[n] * (0.5 * point(rest_, edge.node[n]) + (1.0 / 3) * d);
        }
        for (int n = 0; n < edge.node_count; ++n) add_vec((-weight * N.value[n]) * cross(u, w), edge.node[n], own.r);
      }
  }

  const Energy& pressure_;
  std::function<double(double)> value_;
  std::vector<int> nodes_;    // vertices of the rim
  std::vector<double> rest_;  // X, 3 numbers per node
  std::vector<Edge> edges_;
};

}  // namespace

std::vector<RimEdge> rim_of(std::span<const Face> patch) {
  std::map<std::pair<int, int>, int> balance;  // of both directions of an edge, smaller vertex first
  const auto for_each_edge = [&](const auto& visit) {
    for (const Face& face : patch)
      for (int k = 0; k < 3; ++k) visit(RimEdge{face.corners[k], face.corners[(k + 1) % 3], face.mids[k]});
  };
  for_each_edge([&](const RimEdge& e) { balance[std::minmax(e.a, e.b)] += e.a < e.b ? 1 : -1; });
  std::vector<RimEdge> rim;
  for_each_edge([&](const RimEdge& e) {
    int& left = balance[std::minmax(e.a, e.b)];
    const int way = e.a < e.b ? 1 : -1;
    if (left * way <= 0) return;
    rim.push_back(e);
    left -= way;
  });
  return rim;
}

std::unique_ptr<PressureRim> make_pressure_rim(const Energy& pressure, const TetMesh& mesh,
                                               std::span<const RimEdge> rim, std::function<double(double)> value) {
  return std::make_unique<Rim>(pressure, mesh, rim, std::move(value));
}

}  // namespace aspic
