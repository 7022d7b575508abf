#include "energy/rod.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/check.h"
#include "base/parallel.h"
#include "energy/bending_density.h"
#include "energy/element_groups.h"
#include "energy/internal_variables.h"
#include "energy/springs.h"
#include "math/definite.h"
#include "math/dual.h"
#include "math/vectors.h"
#include "mesh/elements.h"

namespace aspic {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTurned = -0.7;  // minimum cosine of the angle between a tangent and that at the start of the step

using Pair = std::array<double, 2>;

// Derivatives in as many directions as a Pack has lanes, with a common value.
using Slopes = Dual<Pack>;

double root(double x) { return std::sqrt(x); }
Slopes root(const Slopes& x) { return sqrt(x); }

template <class T>
struct Turn {
  T cos, sin;
};
Turn<double> turn(double angle) { return {std::cos(angle), std::sin(angle)}; }
Turn<Slopes> turn(const Slopes& angle) {
  const Pack c(std::cos(angle.value[0])), s(std::sin(angle.value[0]));
  return {{c, -s * angle.rate}, {s, c * angle.rate}};
}

// Returns the angle of the vector (c, s) that is nearest to `near`.
double angle_near(double near, double c, double s) {
  const double angle = std::atan2(s, c);
  return angle + 2 * kPi * std::round((near - angle) / (2 * kPi));
}
Slopes angle_near(double near, const Slopes& c, const Slopes& s) {
  const Pack square = c.value * c.value + s.value * s.value;
  return {Pack(angle_near(near, c.value[0], s.value[0])), (c.value * s.rate - s.value * c.rate) / square};
}

template <class T>
Vec3<T> constant(const Vec3d& v) {
  return {{T(v[0]), T(v[1]), T(v[2])}};
}
template <class T>
Vec3<T> unit(const Vec3<T>& v, T& length) {
  length = root(dot(v, v));
  return (T(1.0) / length) * v;
}
Vec3d unit(const Vec3d& v) { return (1 / norm(v)) * v; }

// Rotates v by the smallest rotation from the unit vector s to the unit vector t.
template <class T>
Vec3<T> transported(const Vec3<T>& s, const Vec3<T>& t, const Vec3<T>& v) {
  const Vec3<T> c = cross(s, t);
  const T cosine = dot(s, t);
  return cosine * v + cross(c, v) + (dot(c, v) / (T(1.0) + cosine)) * c;
}

// Returns a unit vector normal to a unit vector.
Vec3d any_normal(const Vec3d& t) {
  int least = 0;
  for (int r = 1; r < 3; ++r)
    if (std::abs(t[r]) < std::abs(t[least])) least = r;
  Vec3d axis{};
  axis[least] = 1;
  return unit(cross(t, axis));
}

struct Joint {
  std::array<int, 3> vertices;
  std::array<int, 2> segments;              // l and r
  double b = 0, c = 0;                      // [N m]
  std::array<Pair, 2> rest_curvature = {};  // k0 of l and r, which differ only where a chain is closed
  double rest_twist = 0;                    // twist0
};

// Data of a segment at the start of a step.
struct StartSegment {
  Vec3d tangent, director;
  double entry = 0;  // of its row of angles [m]
};

// The frame of a segment.
template <class T>
struct Frame {
  Vec3<T> start, tangent, d1, d2;
  Vec3<T> plain;  // director without the change of the angle
  T length;       // of the segment [m]
  T turned;       // cosine of the angle from the tangent at the start
  T angle;        // change in the step

  // `entry`: change of the entry of the row of angles [rad].
  Frame(const StartSegment& from, const Vec3<T>& edge, const T& change) : angle(change) {
    start = constant<T>(from.tangent);
    tangent = unit(edge, length);
    turned = dot(start, tangent);
    plain = transported(start, tangent, constant<T>(from.director));
    const Turn<T> by = turn(change);
    const Vec3<T> normal = cross(tangent, plain);
    d1 = by.cos * plain + by.sin * normal;
    d2 = by.cos * normal - by.sin * plain;
  }
};

// Strains of a joint.
template <class T>
struct Strains {
  Vec3<T> binormal;
  T chi;      // 1 + t_l . t_r
  T k[2][2];  // k_l and k_r
  T twist;

  Strains(const Frame<T>& l, const Frame<T>& r, double twist_at_start) {
    chi = T(1.0) + dot(l.tangent, r.tangent);
    binormal = (T(2.0) / chi) * cross(l.tangent, r.tangent);
    k[0][0] = dot(binormal, l.d1), k[0][1] = dot(binormal, l.d2);
    k[1][0] = dot(binormal, r.d1), k[1][1] = dot(binormal, r.d2);
    const Vec3<T> u = transported(l.tangent, r.tangent, l.plain);
    twist = angle_near(twist_at_start, dot(u, r.plain), dot(cross(u, r.plain), r.tangent)) + r.angle - l.angle;
  }
};

double energy_of(const Joint& joint, const Pair& k_l, const Pair& k_r, double twist) {
  double squares = 0;
  for (int i = 0; i < 2; ++i)
    squares += std::pow(k_l[i] - joint.rest_curvature[0][i], 2) + std::pow(k_r[i] - joint.rest_curvature[1][i], 2);
  return 0.25 * joint.b * squares + 0.5 * joint.c * std::pow(twist - joint.rest_twist, 2);
}

// Derivatives of the energy of a joint by the edge vectors of l and r, and by their angles.
template <class T>
struct JointForces {
  Vec3<T> edge[2];
  T torque[2];
};

template <class T>
JointForces<T> forces_of(const Joint& joint, const Frame<T>& l, const Frame<T>& r, double twist_at_start) {
  const Strains<T> strains(l, r, twist_at_start);
  const Frame<T>* const frames[2] = {&l, &r};
  const T M = T(joint.c) * (strains.twist - T(joint.rest_twist));
  JointForces<T> forces;
  Vec3<T> w = constant<T>(Vec3d{});  // by the binormal
  for (int e = 0; e < 2; ++e) {
    const T* k = strains.k[e];
    const T m1 = T(0.5 * joint.b) * (k[0] - T(joint.rest_curvature[e][0])),
            m2 = T(0.5 * joint.b) * (k[1] - T(joint.rest_curvature[e][1]));
    w = w + m1 * frames[e]->d1 + m2 * frames[e]->d2;
    forces.torque[e] = m1 * k[1] - m2 * k[0] + (e == 0 ? -M : M);
  }
  const T along = dot(strains.binormal, w);
  for (int e = 0; e < 2; ++e) {
    const Frame<T>&own = *frames[e], &other = *frames[1 - e];
    const Vec3<T> turned = e == 0 ? cross(other.tangent, w) : cross(w, other.tangent);
    Vec3<T> g = (T(1.0) / strains.chi) * (T(2.0) * turned - along * other.tangent) + (T(0.5) * M) * strains.binormal -
                (forces.torque[e] / (T(1.0) + own.turned)) * cross(own.start, own.tangent);
    forces.edge[e] = (T(1.0) / own.length) * (g - dot(g, own.tangent) * own.tangent);
  }
  return forces;
}

constexpr int kNodes = 5;       // three vertices and two rows of angles
constexpr int kInternal = 8;    // per segment
constexpr int kDirections = 8;  // of a joint: edge vectors of l and r, and their angles

class RodBending : public Energy, public InternalVariables, public BendingElements {
 public:
  RodBending(const TetMesh& mesh, std::span<const RodSegment> segments)
      : segments_(segments.begin(), segments.end()), first_element_(mesh.first_segment()) {
    ASPIC_CHECK(segments.size() == mesh.rods.size());
    for (size_t s = 0; s < segments.size(); ++s)
      volume_.push_back(element_volume(mesh, first_element_ + static_cast<int>(s)));
    make_rest_frames(mesh);
    make_joints(mesh);
    find_unused_entries();
    std::vector<std::array<int, kNodes>> nodes;
    for (const Joint& joint : joints_) nodes.push_back(nodes_of_joint(joint));
    groups_ = ElementGroups(nodes);
  }

  std::string_view name() const override { return "rod"; }

  std::unique_ptr<Context> make_context() const override {
    auto start = std::make_unique<Start>();
    start->segments = rest_;
    start->twist.assign(joints_.size(), 0.0);
    return start;
  }

  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    const Start& start = static_cast<const Start&>(context);
    for (size_t s = 0; s < segments_.size() && !step.start.empty(); ++s) {
      start.segments[s].tangent = unit(edge_of(s, step.start));
      start.segments[s].entry = entry_of(s, step.start);
    }
    begin_internal({}, step.h, context);
  }

  InternalRange internal_range() const override {
    return {first_element_, static_cast<int>(segments_.size()), kInternal};
  }

  // Directors that are zero are those at rest, transported to the tangents at the start.
  void begin_internal(std::span<const double> z, double, const Context& context) const override {
    const Start& start = static_cast<const Start&>(context);
    for (size_t s = 0; s < segments_.size(); ++s) {
      StartSegment& segment = start.segments[s];
      const Vec3d& t = segment.tangent;
      Vec3d d = z.empty() ? Vec3d{} : Vec3d{{z[kInternal * s], z[kInternal * s + 1], z[kInternal * s + 2]}};
      if (squared_norm(d) == 0) d = director_at(s, start);
      segment.director = unit(d - dot(d, t) * t);
    }
    start.energy = 0;
    for (size_t j = 0; j < joints_.size(); ++j) {
      const auto [l, r] = joints_[j].segments;
      const StartSegment &a = start.segments[l], &b = start.segments[r];
      const Frame<double> left(a, a.tangent, 0), right(b, b.tangent, 0);
      const double near = z.empty() ? 0 : z[kInternal * static_cast<size_t>(l) + 7];
      const Strains<double> strains(left, right, near);
      start.twist[j] = strains.twist;
      start.energy += energy_of(joints_[j], pair_of(strains.k[0]), pair_of(strains.k[1]), strains.twist);
    }
  }

  void end_internal(Positions x, const Context& context, std::span<double> z) const override {
    write(x, static_cast<const Start&>(context), z);
  }

  void write_initial(Positions x, std::span<double> z) const override {
    const std::unique_ptr<Context> context = make_context();
    begin_step({.start = x}, *context);
    write(x, static_cast<const Start&>(*context), z);
  }

  double stored_energy(std::span<const double> z) const override {
    double sum = 0;
    for (const Joint& joint : joints_) sum += stored_energy(joint, z);
    return sum;
  }

  // A joint gives half of its energy to each of its segments.
  void add_bending_density(Positions, std::span<const double> z, std::span<double> density) const override {
    for (const Joint& joint : joints_)
      for (const int s : joint.segments) density[first_element_ + s] += 0.5 * stored_energy(joint, z) / volume_[s];
  }

  InternalEnergies internal_energies(const InternalStep& step, const Context& context) const override {
    std::vector<double> g(step.end.size());
    add_gradient(step.end, context, 1, g);
    double work = 0;
    for (size_t i = 0; i < g.size(); ++i) work += g[i] * (step.end[i] - step.start[i]);
    return {work, stored_energy(step.z_end) - static_cast<const Start&>(context).energy, 0};
  }

  double value(Positions x, const Context& context) const override {
    const Start& start = static_cast<const Start&>(context);
    const double V = parallel_sum(count(), [&](int first, int last) {
      double sum = 0;
      for (int j = first; j < last; ++j) sum += energy(j, x, start);
      return sum;
    });
    double springs = 0;
    for (const int i : unused_) springs += 0.5 * spring_ * x[i] * x[i];
    return std::isnan(V) ? std::numeric_limits<double>::infinity() : V - start.energy + springs;
  }

  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    const Start& start = static_cast<const Start&>(context);
    groups_.for_each([&](int j) {
      const Joint& joint = joints_[j];
      const auto [l, r] = joint.segments;
      const JointForces<double> forces = forces_of(joint, frame(l, x, start), frame(r, x, start), start.twist[j]);
      add_vec(-scale * forces.edge[0], joint.vertices[0], g);
      add_vec(scale * (forces.edge[0] - forces.edge[1]), joint.vertices[1], g);
      add_vec(scale * forces.edge[1], joint.vertices[2], g);
      for (int e = 0; e < 2; ++e)
        g[place_of(joint.segments[e])] += scale * forces.torque[e] / segments_[joint.segments[e]].length;
    });
    for (const int i : unused_) g[i] += scale * spring_ * x[i];
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Joint& joint : joints_) {
      const std::array<int, kNodes> nodes = nodes_of_joint(joint);
      for (int i = 0; i < kNodes; ++i)
        for (int j = 0; j < i; ++j)
          if (nodes[i] != nodes[j]) couplings.emplace_back(nodes[i], nodes[j]);
    }
  }

  void bind(const BlockPattern& pattern) override {
    diagonal_.clear();
    for (const int i : unused_) diagonal_.push_back(pattern.diagonal(i / 3));
    slots_.resize(joints_.size());
    for (size_t k = 0; k < joints_.size(); ++k) {
      const std::array<int, kNodes> nodes = nodes_of_joint(joints_[k]);
      for (int i = 0; i < kNodes; ++i)
        for (int j = 0; j < kNodes; ++j) slots_[k][i][j] = nodes[i] >= nodes[j] ? pattern.slot(nodes[i], nodes[j]) : -1;
    }
  }

  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    const Start& start = static_cast<const Start&>(context);
    const int modified = groups_.count_if([&](int j) {
      const Joint& joint = joints_[j];
      Mat9d K = stiffness(joint, x, start, start.twist[j]);
      const bool is_kept = projection.kind == Definiteness::exact || !is_covered(nodes_of_joint(joint), projection);
      const bool is_modified =
          !is_kept && modify_hessian(K, projection.kind == Definiteness::clamped ? EigenvalueFilter::clamp
                                                                                 : EigenvalueFilter::absolute) != 0;
      add(joint, slots_[j], scale, K, H);
      return is_modified;
    });
    for (size_t k = 0; k < unused_.size(); ++k)
      H.block[diagonal_[k]](unused_[k] % 3, unused_[k] % 3) += scale * spring_;
    return modified;
  }

 private:
  struct Start : Context {
    mutable std::vector<StartSegment> segments;
    mutable std::vector<double> twist;  // of each joint
    mutable double energy = 0;          // [J]
  };
  using Slots = std::array<std::array<int64_t, kNodes>, kNodes>;

  int count() const { return static_cast<int>(joints_.size()); }
  static double stored_energy(const Joint& joint, std::span<const double> z) {
    const double *l = &z[kInternal * static_cast<size_t>(joint.segments[0])],
                 *r = &z[kInternal * static_cast<size_t>(joint.segments[1])];
    return energy_of(joint, {l[5], l[6]}, {r[3], r[4]}, l[7]);
  }
  static Pair pair_of(const double* k) { return {k[0], k[1]}; }
  size_t place_of(int segment) const {
    return 3 * static_cast<size_t>(segments_[segment].row) + segments_[segment].entry;
  }
  double entry_of(size_t segment, Positions x) const { return x[place_of(static_cast<int>(segment))]; }
  Vec3d edge_of(size_t segment, Positions x) const {
    const auto& [a, b] = segments_[segment].ends;
    return point(x, b) - point(x, a);
  }
  // Returns the director at rest, transported to the tangent at the start; if this has turned far, that of the segment
  // before it, transported along the rod.
  Vec3d director_at(size_t segment, const Start& start) const {
    const Vec3d& t = start.segments[segment].tangent;
    if (dot(rest_[segment].tangent, t) > kTurned)
      return transported(rest_[segment].tangent, t, rest_[segment].director);
    const int before = previous_[segment];
    if (before < 0 || before > static_cast<int>(segment)) return any_normal(t);
    return transported(start.segments[before].tangent, t, start.segments[before].director);
  }
  Frame<double> frame(int segment, Positions x, const Start& start) const {
    const StartSegment& from = start.segments[segment];
    return {from, edge_of(segment, x), (entry_of(segment, x) - from.entry) / segments_[segment].length};
  }
  std::array<int, kNodes> nodes_of_joint(const Joint& joint) const {
    const auto& [a, b, c] = joint.vertices;
    return {a, b, c, segments_[joint.segments[0]].row, segments_[joint.segments[1]].row};
  }

  double energy(int j, Positions x, const Start& start) const {
    const Joint& joint = joints_[j];
    const Frame<double> l = frame(joint.segments[0], x, start), r = frame(joint.segments[1], x, start);
    if (!(l.turned > kTurned && r.turned > kTurned)) return std::numeric_limits<double>::infinity();
    const Strains<double> strains(l, r, start.twist[j]);
    return energy_of(joint, pair_of(strains.k[0]), pair_of(strains.k[1]), strains.twist);
  }

  // Returns the Hessian by the edge vectors and the entries of the angles of l and r, in the first 8 rows.
  Mat9d stiffness(const Joint& joint, Positions x, const Start& start, double twist) const {
    Mat9d K{};
    const int own[2] = {joint.segments[0], joint.segments[1]};
    for (int first = 0; first < kDirections; first += kPackWidth) {
      Slopes q[kDirections];
      for (int i = 0; i < kDirections; ++i) {
        const int e = i < 6 ? i / 3 : i - 6;
        const double length = segments_[own[e]].length;
        q[i] = i < 6 ? Slopes(edge_of(own[e], x)[i % 3])
                     : Slopes((entry_of(own[e], x) - start.segments[own[e]].entry) / length);
        const int lane = i - first;
        if (0 <= lane && lane < kPackWidth) q[i].rate.set(lane, i < 6 ? 1 : 1 / length);
      }
      const Frame<Slopes> l(start.segments[own[0]], {{q[0], q[1], q[2]}}, q[6]),
          r(start.segments[own[1]], {{q[3], q[4], q[5]}}, q[7]);
      const JointForces<Slopes> forces = forces_of(joint, l, r, twist);
      for (int lane = 0; lane < kPackWidth && first + lane < kDirections; ++lane)
        for (int e = 0; e < 2; ++e) {
          for (int i = 0; i < 3; ++i) K(3 * e + i, first + lane) = forces.edge[e][i].rate[lane];
          K(6 + e, first + lane) = forces.torque[e].rate[lane] / segments_[own[e]].length;
        }
    }
    for (int i = 0; i < kDirections; ++i)
      for (int j = 0; j < i; ++j) K(i, j) = K(j, i) = 0.5 * (K(i, j) + K(j, i));
    return K;
  }

  // Adds the blocks at and below the diagonal. The rows of both angles may be the same.
  void add(const Joint& joint, const Slots& slots, double scale, const Mat9d& K, BlockSparse& H) const {
    constexpr double kSign[2][3] = {{-1, 1, 0}, {0, -1, 1}};  // of the vertices in the edge vectors
    const int entry[2] = {segments_[joint.segments[0]].entry, segments_[joint.segments[1]].entry};
    const auto sign = [&](int node, int e) { return node < 3 ? kSign[e][node] : node - 3 == e ? 1.0 : 0.0; };
    const auto add_entry = [&](int64_t slot, int r, int c, double k) { H.block[slot](r, c) += scale * k; };
    for (int u = 0; u < kNodes; ++u)
      for (int v = 0; v < kNodes; ++v) {
        const int64_t slot = slots[u][v];
        for (int e = 0; e < 2 && slot >= 0; ++e)
          for (int f = 0; f < 2; ++f) {
            const double s = sign(u, e) * sign(v, f);
            if (s == 0) continue;
            for (int i = 0; i < (u < 3 ? 3 : 1); ++i)
              for (int j = 0; j < (v < 3 ? 3 : 1); ++j)
                add_entry(slot, u < 3 ? i : entry[e], v < 3 ? j : entry[f],
                          s * K(u < 3 ? 3 * e + i : 6 + e, v < 3 ? 3 * f + j : 6 + f));
          }
      }
  }

  void write(Positions x, const Start& start, std::span<double> z) const {
    std::fill(z.begin(), z.end(), 0.0);
    for (size_t s = 0; s < segments_.size(); ++s) {
      const Frame<double> own = frame(static_cast<int>(s), x, start);
      for (int r = 0; r < 3; ++r) z[kInternal * s + r] = own.d1[r];
    }
    for (size_t j = 0; j < joints_.size(); ++j) {
      const auto [l, r] = joints_[j].segments;
      const Strains<double> strains(frame(l, x, start), frame(r, x, start), start.twist[j]);
      double *left = &z[kInternal * static_cast<size_t>(l)], *right = &z[kInternal * static_cast<size_t>(r)];
      for (int i = 0; i < 2; ++i) left[5 + i] = strains.k[0][i], right[3 + i] = strains.k[1][i];
      left[7] = strains.twist;
    }
  }

  // Directors at rest are transported along each chain of segments, so that they have no twist.
  void make_rest_frames(const TetMesh& mesh) {
    const auto& X = mesh.rest;
    std::vector<int> next(X.size(), -1);  // segment that starts at a vertex
    std::vector<char> has_previous(X.size(), 0);
    for (size_t s = 0; s < segments_.size(); ++s) {
      const auto& [a, b] = segments_[s].ends;
      ASPIC_CHECK(norm(X[b] - X[a]) > 0 && next[a] < 0 && !has_previous[b]);
      next[a] = static_cast<int>(s);
      has_previous[b] = 1;
      rest_.push_back({unit(X[b] - X[a]), {}, 0});
    }
    const auto follow = [&](int s) {
      rest_[s].director = any_normal(rest_[s].tangent);
      for (int n = next[segments_[s].ends[1]]; n >= 0 && squared_norm(rest_[n].director) == 0;
           s = n, n = next[segments_[n].ends[1]])
        rest_[n].director = transported(rest_[s].tangent, rest_[n].tangent, rest_[s].director);
    };
    for (size_t s = 0; s < segments_.size(); ++s)
      if (!has_previous[segments_[s].ends[0]]) follow(static_cast<int>(s));
    for (size_t s = 0; s < segments_.size(); ++s)  // closed chains
      if (squared_norm(rest_[s].director) == 0) follow(static_cast<int>(s));
    for (size_t s = 0; s < segments_.size(); ++s)
      if (const int n = next[segments_[s].ends[1]]; n >= 0)
        joints_.push_back(
            {{segments_[s].ends[0], segments_[s].ends[1], segments_[n].ends[1]}, {static_cast<int>(s), n}});
    previous_.assign(segments_.size(), -1);
    for (const Joint& joint : joints_) previous_[joint.segments[1]] = joint.segments[0];
  }

  void make_joints(const TetMesh& mesh) {
    for (Joint& joint : joints_) {
      const auto [l, r] = joint.segments;
      const bool is_rigid = segments_[l].is_held && segments_[r].is_held;
      double bending = 0, torsion = 0;  // compliances [1/(N m)]
      for (const int s : joint.segments) {
        if (segments_[s].is_held && !is_rigid) continue;
        const auto& [a, b] = segments_[s].ends;
        const double half = 0.5 * norm(mesh.rest[b] - mesh.rest[a]);
        bending += half / segments_[s].bending;
        torsion += half / segments_[s].torsion;
        joint.rest_twist += half * segments_[s].natural_twist;
      }
      joint.b = 1 / bending;
      joint.c = 1 / torsion;
      const Frame<double> left(rest_[l], rest_[l].tangent, 0), right(rest_[r], rest_[r].tangent, 0);
      const Strains<double> strains(left, right, 0);
      joint.rest_twist += strains.twist;  // not zero where a chain is closed
      if (!segments_[l].is_straight) joint.rest_curvature = {pair_of(strains.k[0]), pair_of(strains.k[1])};
    }
  }

  // Entries of segments without joints, and those that fill the last row of a body.
  void find_unused_entries() {
    std::vector<size_t> used;
    for (const Joint& joint : joints_)
      for (const int s : joint.segments) used.push_back(place_of(s));
    std::sort(used.begin(), used.end());
    std::vector<int> rows;
    for (const RodSegment& segment : segments_) rows.push_back(segment.row);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    for (const int row : rows)
      for (int entry = 3 * row; entry < 3 * row + 3; ++entry)
        if (!std::binary_search(used.begin(), used.end(), static_cast<size_t>(entry))) unused_.push_back(entry);
    for (const Joint& joint : joints_)
      spring_ = std::max(spring_, joint.c / std::pow(segments_[joint.segments[0]].length, 2));
    if (spring_ == 0) spring_ = 1;
  }

  std::vector<RodSegment> segments_;
  int first_element_;
  std::vector<double> volume_;  // of each segment at rest [m^3]
  std::vector<StartSegment> rest_;
  std::vector<int> previous_;  // of each segment; -1: none
  std::vector<Joint> joints_;
  std::vector<int> unused_;  // entries of x
  double spring_ = 0;        // their stiffness [N/m]
  std::vector<Slots> slots_;
  std::vector<int64_t> diagonal_;  // slots of the unused entries
  ElementGroups groups_;
};

class RodStretch : public TetElasticity {
 public:
  RodStretch(const TetMesh& mesh, int first, std::span<const double> young)
      : first_element_(mesh.first_segment() + first), young_(young.begin(), young.end()) {
    std::vector<Spring> springs;
    for (size_t s = 0; s < young.size(); ++s) {
      const auto& [a, b] = mesh.rods[first + s];
      const double r = mesh.radius[first + s], l = norm(mesh.rest[b] - mesh.rest[a]);
      ends_.push_back({a, b});
      length_.push_back(l);
      springs.push_back({a, b, l, young[s] * kPi * r * r / l});
    }
    springs_ = make_springs("elastic", std::move(springs));
  }

  std::string_view name() const override { return "elastic"; }
  void add_couplings(Couplings& couplings) const override { springs_->add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { springs_->bind(pattern); }
  double value(Positions x, const Context& context) const override { return springs_->value(x, context); }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    springs_->add_gradient(x, context, scale, g);
  }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return springs_->add_hessian(x, context, scale, projection, H);
  }

  double min_det_F(Positions x) const override {
    double least = std::numeric_limits<double>::infinity();
    for (size_t s = 0; s < ends_.size(); ++s) least = std::min(least, norm(edge(s, x)) / length_[s]);
    return least;
  }
  void evaluate(Positions x, TetFields& fields) const override {
    constexpr int kRow[6] = {0, 1, 2, 0, 1, 2}, kColumn[6] = {0, 1, 2, 1, 2, 0};
    for (size_t s = 0; s < ends_.size(); ++s) {
      const size_t e = static_cast<size_t>(first_element_) + s;
      const Vec3d d = edge(s, x);
      const double l = norm(d), strain = l / length_[s] - 1, stress = young_[s] * strain;
      fields.energy_density[e] = 0.5 * stress * strain;
      fields.det_F[e] = 1 + strain;
      for (int k = 0; k < 6; ++k) fields.cauchy[6 * e + k] = stress * (d[kRow[k]] / l) * (d[kColumn[k]] / l);
      fields.von_mises[e] = std::abs(stress);
    }
  }

  int parameter_count() const override { return 0; }
  std::vector<MaterialParameters> parameters() const override { return {}; }
  void set_parameters(std::span<const MaterialParameters>) override {}

 private:
  Vec3d edge(size_t s, Positions x) const { return point(x, ends_[s][1]) - point(x, ends_[s][0]); }

  int first_element_;
  std::vector<double> young_, length_;
  std::vector<Segment> ends_;
  std::unique_ptr<Energy> springs_;
};

}  // namespace

std::unique_ptr<Energy> make_rod_bending(const TetMesh& mesh, std::span<const RodSegment> segments) {
  return std::make_unique<RodBending>(mesh, segments);
}

std::vector<AngleRow> make_rod_rows(const TetMesh& mesh, int first, std::span<const double> density, double length) {
  std::vector<AngleRow> rows;
  const int count = static_cast<int>(density.size());
  for (int s = 0; s < count; ++s) {
    const auto& [a, b] = mesh.rods[first + s];
    if (s % 3 == 0) rows.push_back({{}, 0, a});
    const int in_row = std::min(3, count - s / 3 * 3);
    const double r = mesh.radius[first + s];
    AngleRow& row = rows.back();
    row.center = row.center + (0.5 / in_row) * (mesh.rest[a] + mesh.rest[b]);
    row.mass +=
        0.5 * density[s] * kPi * std::pow(r, 4) * norm(mesh.rest[b] - mesh.rest[a]) / (length * length * in_row);
  }
  return rows;
}

std::unique_ptr<TetElasticity> make_rod_stretch(const TetMesh& mesh, int first, std::span<const double> young) {
  return std::make_unique<RodStretch>(mesh, first, young);
}

}  // namespace aspic
