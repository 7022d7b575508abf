#include "dynamics/mesh_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "base/formatted.h"
#include "base/free_memory.h"
#include "contact/friction.h"
#include "dynamics/incremental_potential.h"
#include "energy/damping.h"
#include "mesh/surface.h"
#include "mesh/tet_nodes.h"
#include "optimize/newton.h"

namespace aspic {
namespace {

constexpr double kResidual = 1e-2;      // relative residual of the linear solve; the error of e is about its square
constexpr double kProportional = 1e-6;  // relative deviation of a load from a multiple of the mass
constexpr double kSmallForce = 1e-2;    // damping forces in tets that do not matter, relative to the elastic ones
constexpr double kBytesPerTet = 3000;   // of quadratic tets with their matrix
constexpr double kSmallInertia = 1e-8;  // relative to the rate of uniform growth
constexpr double kUnstrained = 1e-6;    // strains below this are round-off
constexpr double kProbe = 1e-3;         // displacement for second differences, relative to an edge

using Vector = std::vector<double>;

double norm_of(std::span<const double> v) { return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0)); }

// The Hessian of other terms as a constant, whose rows are the first ones: d' K d / 2 of the displacement from y.
class HeldStiffness : public SteadyEnergy {
 public:
  explicit HeldStiffness(BlockSparse stiffness) : K_(std::move(stiffness)) {}

  std::string_view name() const override { return "held"; }
  bool has_constant_gradient() const override { return true; }
  void add_couplings(Couplings& couplings) const override {
    for (int row = 0; row < K_.pattern->rows(); ++row)
      for (int64_t k = K_.pattern->row_start[row]; k < K_.pattern->diagonal(row); ++k)
        couplings.emplace_back(row, K_.pattern->column[k]);
  }
  void bind(const BlockPattern& pattern) override {
    slot_.clear();
    for (int row = 0; row < K_.pattern->rows(); ++row)
      for (int64_t k = K_.pattern->row_start[row]; k < K_.pattern->row_start[row + 1]; ++k)
        slot_.push_back(pattern.slot(row, K_.pattern->column[k]));
  }
  double value(Positions, const Context&) const override { return 0; }  // at y, as is the gradient
  void add_gradient(Positions, const Context&, double, std::span<double>) const override {}
  int add_hessian(Positions, const Context&, double scale, const Projection&, BlockSparse& H) const override {
    for (size_t k = 0; k < slot_.size(); ++k) H.block[slot_[k]] = H.block[slot_[k]] + scale * K_.block[k];
    for (Stencil stencil : K_.stencils) {
      for (Mat3d& block : stencil.block) block = scale * block;
      H.stencils.push_back(stencil);
    }
    return 0;
  }

 private:
  BlockSparse K_;
  std::vector<int64_t> slot_;
};

// The quadratic tets: their nodes are the vertices, then the middles of edges.
class Lift {
 public:
  explicit Lift(const TetMesh& mesh) : vertices_(mesh.vertex_count()), mesh_(raise_order(mesh)) {
    ends_.resize(mesh_.vertex_count() - vertices_);
    for (int t = 0; t < mesh_.tet_count(); ++t)
      for (int e = 0; e < 6; ++e)
        ends_[mesh_.mids[t][e] - vertices_] = {mesh_.tets[t][kTetEdges[e][0]], mesh_.tets[t][kTetEdges[e][1]]};
  }

  const TetMesh& mesh() const { return mesh_; }
  int vertices() const { return vertices_; }
  std::span<const std::array<int, 2>> ends() const { return ends_; }
  int middle(int edge) const { return vertices_ + edge; }

  // Interpolates linearly.
  Vector operator()(std::span<const double> x) const {
    Vector y(x.begin(), x.end());
    y.reserve(3 * mesh_.rest.size());
    for (const auto& [a, b] : ends_)
      for (int r = 0; r < 3; ++r) y.push_back(0.5 * (x[3 * a + r] + x[3 * b + r]));
    return y;
  }
  // Replaces the forces on vertices by those with which the forces f on middles do no work on linear functions.
  void balance(std::span<double> f) const {
    std::fill_n(f.begin(), 3 * vertices_, 0.0);
    for (size_t e = 0; e < ends_.size(); ++e)
      for (const int end : ends_[e])
        for (int r = 0; r < 3; ++r) f[3 * end + r] -= 0.5 * f[3 * (vertices_ + e) + r];
  }

 private:
  int vertices_;
  TetMesh mesh_;
  std::vector<std::array<int, 2>> ends_;
};

// Returns the common entries of ascending lists.
std::vector<int> common(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// Pins hold the middle of an edge if they hold both ends, and the edge is in the boundary or in a held tet.
std::vector<Pin> lifted_pins(const Lift& lift, const std::vector<Pin>& pins) {
  const TetMesh& mesh = lift.mesh();
  std::vector<Pin> lifted;
  std::vector<std::vector<int>> pins_at(mesh.rest.size());  // of vertices; of middles: those that hold a tet there
  for (size_t k = 0; k < pins.size(); ++k) {
    lifted.push_back({pins[k].name, pins[k].vertices, {}, pins[k].directions});
    for (const int v : pins[k].vertices) pins_at[v].push_back(static_cast<int>(k));
  }
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if (pins_at[a].empty()) continue;
    const std::vector<int> held = common(common(pins_at[a], pins_at[b]), common(pins_at[c], pins_at[d]));
    for (const int mid : mesh.mids[t]) pins_at[mid].insert(pins_at[mid].end(), held.begin(), held.end());
  }
  std::vector<char> is_boundary(mesh.rest.size(), false);
  for (const Face& face : boundary_faces(mesh, 0, mesh.tet_count()))
    for (const int mid : face.mids) is_boundary[mid] = true;
  for (size_t e = 0; e < lift.ends().size(); ++e) {
    const auto& [a, b] = lift.ends()[e];
    const int middle = lift.middle(static_cast<int>(e));
    const std::vector<int>& holding = pins_at[middle];
    for (const int k : common(pins_at[a], pins_at[b]))
      if (is_boundary[middle] || std::find(holding.begin(), holding.end(), k) != holding.end())
        lifted[k].vertices.push_back(middle);
  }
  return lifted;
}

// Uniform tractions t on faces that have given forces f on vertices, f_i = sum of t A / 3 over the faces at i. There
// are more faces than vertices: of all, those are chosen that differ least between neighbors without an edge between
// them.
class FaceTractions {
 public:
  FaceTractions(const TetMesh& mesh, std::vector<Face> faces)
      : faces_(std::move(faces)), total_(mesh.vertex_count(), 0.0), at_vertex_(mesh.vertex_count()) {
    std::vector<int> other(mesh.vertex_count(), -1);  // the first face at the middle of an edge
    std::vector<Vec3d> normal;
    for (size_t k = 0; k < faces_.size(); ++k) {
      const auto& [a, b, c] = faces_[k].corners;
      const Vec3d area = 0.5 * cross(mesh.rest[b] - mesh.rest[a], mesh.rest[c] - mesh.rest[a]);
      area_.push_back(norm(area));
      normal.push_back((1 / area_.back()) * area);
      for (const int v : faces_[k].corners) total_[v] += area_.back() / 3;
      for (const int mid : faces_[k].mids) {
        if (other[mid] >= 0 && dot(normal[other[mid]], normal[k]) > kSmooth)
          neighbors_.push_back({other[mid], static_cast<int>(k)});
        other[mid] = static_cast<int>(k);
      }
    }
  }

  // Least squares with a small weight of the differences, by conjugate gradients.
  std::vector<Vec3d> of(std::span<const double> f) const {
    std::vector<Vec3d> t(faces_.size()), r(faces_.size()), Ap(faces_.size());
    for (size_t k = 0; k < faces_.size(); ++k)
      for (const int v : faces_[k].corners) r[k] = r[k] + (area_[k] / (3 * total_[v] * total_[v])) * point(f, v);
    std::vector<Vec3d> p = r;
    double rr = product(r, r);
    const double enough = kTractionResidual * kTractionResidual * rr;
    for (int iteration = 0; iteration < kMostIterations && rr > enough; ++iteration) {
      apply(p, Ap);
      const double alpha = rr / product(p, Ap), before = rr;
      for (size_t k = 0; k < t.size(); ++k) t[k] = t[k] + alpha * p[k], r[k] = r[k] - alpha * Ap[k];
      rr = product(r, r);
      for (size_t k = 0; k < t.size(); ++k) p[k] = r[k] + (rr / before) * p[k];
    }
    return t;
  }

  // Adds the forces on middles of edges: the integral of their shape functions over a face is a third of its area.
  void add_forces(const std::vector<Vec3d>& t, std::span<double> force) const {
    for (size_t k = 0; k < faces_.size(); ++k)
      for (const int mid : faces_[k].mids)
        for (int r = 0; r < 3; ++r) force[3 * mid + r] += area_[k] / 3 * t[k][r];
  }

 private:
  static constexpr double kSmooth = 0.8;        // cosine between normals without an edge
  static constexpr double kDifferences = 1e-1;  // weight
  static constexpr double kTractionResidual = 1e-8;
  static constexpr int kMostIterations = 500;

  static double product(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
    double sum = 0;
    for (size_t k = 0; k < a.size(); ++k) sum += dot(a[k], b[k]);
    return sum;
  }
  void apply(const std::vector<Vec3d>& t, std::vector<Vec3d>& result) const {
    std::fill(at_vertex_.begin(), at_vertex_.end(), Vec3d{});
    for (size_t k = 0; k < t.size(); ++k)
      for (const int v : faces_[k].corners) at_vertex_[v] = at_vertex_[v] + (area_[k] / (3 * total_[v])) * t[k];
    for (size_t k = 0; k < t.size(); ++k) {
      result[k] = {};
      for (const int v : faces_[k].corners) result[k] = result[k] + (area_[k] / (3 * total_[v])) * at_vertex_[v];
    }
    for (const auto& [k, l] : neighbors_) {
      const Vec3d difference = kDifferences * (t[k] - t[l]);
      result[k] = result[k] + difference;
      result[l] = result[l] - difference;
    }
  }

  std::vector<Face> faces_;
  std::vector<double> area_, total_;  // of each face, and a third of those at each vertex [m^2]
  std::vector<std::array<int, 2>> neighbors_;
  mutable std::vector<Vec3d> at_vertex_;  // scratch
};

// Forces on vertices as sums of a multiple of the mass of each body, tractions on surfaces, and forces at points.
class ForceLift {
 public:
  ForceLift(const Model& model, const Lift& lift)
      : model_(model), lift_(lift), acceleration_(3 * lift.vertices(), 0.0), force_(3 * lift.mesh().rest.size(), 0.0) {
    for (const BodyRange& body : model.bodies)
      faces_.push_back(boundary_faces(lift.mesh(), body.first_tet, body.tet_count));
  }

  void add(std::span<const double> f) {
    std::vector<Face> loaded;
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      if (add_weight(model_.bodies[b], f)) continue;
      for (const Face& face : faces_[b])
        if (std::all_of(face.corners.begin(), face.corners.end(), [&](int v) { return norm(point(f, v)) > 0; }))
          loaded.push_back(face);
    }
    if (loaded.empty()) return;
    const FaceTractions tractions(lift_.mesh(), std::move(loaded));
    tractions.add_forces(tractions.of(f), force_);
  }
  void add_acceleration(std::span<const double> a, double factor) {
    for (size_t i = 0; i < a.size(); ++i) acceleration_[i] += factor * a[i];
  }
  // Returns the forces on the middles of edges.
  Vector take(const MassMatrix& mass) {
    const Vector a = lift_(acceleration_);
    Vector f(a.size());
    mass.multiply(a, f);
    for (size_t i = 0; i < f.size(); ++i) f[i] += force_[i];
    return f;
  }

 private:
  // Returns false if f is no multiple of the mass.
  bool add_weight(const BodyRange& body, std::span<const double> f) {
    const std::span<const double> mass = model_.mass->row_sums();
    Vec3d sum{};
    double total = 0, largest = 0, deviation = 0;
    const int last = body.first_vertex + body.vertex_count;
    for (int v = body.first_vertex; v < last; ++v) sum = sum + point(f, v), total += mass[v];
    if (!(total > 0)) return false;
    const Vec3d g = (1 / total) * sum;
    for (int v = body.first_vertex; v < last; ++v) {
      largest = std::max(largest, norm(mass[v] * g));
      deviation = std::max(deviation, norm(point(f, v) - mass[v] * g));
    }
    if (!(deviation <= kProportional * largest)) return false;
    for (int v = body.first_vertex; v < last; ++v)
      for (int r = 0; r < 3; ++r) acceleration_[3 * v + r] += g[r];
    return true;
  }

  const Model& model_;
  const Lift& lift_;
  std::vector<std::vector<Face>> faces_;  // of each body
  Vector acceleration_, force_;
};

class Estimator {
 public:
  explicit Estimator(const MeshErrorInput& input) : in_(input), lift_(input.model.mesh), x_(input.state.q) {}

  MeshErrorEstimate compute(const StopToken& stop) {
    const Model& model = in_.model;
    raised_.mesh = lift_.mesh();
    raised_.density = model.density;
    raised_.bodies = {{"", 0, raised_.mesh.vertex_count(), 0, raised_.mesh.tet_count()}};
    raised_.pins = lifted_pins(lift_, model.pins);
    raised_.mass = std::make_unique<MassMatrix>(raised_.mesh, model.density, MassKind::consistent);
    for (const auto& V : model.elasticity)
      if (!raised_.elasticity.emplace_back(V->on(raised_.mesh))) return refused("a material has no quadratic tets");
    y_ = lift_(x_);
    inner_.assign(y_.size(), 0.0);
    for (const auto& V : raised_.elasticity) V->add_gradient(y_, 1, inner_);
    for (const auto& load : model.loads) {
      const auto* in_tets = dynamic_cast<const TetEnergy*>(load.get());
      if (!in_tets) continue;
      raised_.loads.push_back(in_tets->on(raised_.mesh));
      ActiveTerm(*raised_.loads.back(), step()).add_gradient(y_, 1, inner_);
    }
    if (const std::string why = find_forces(); !why.empty()) return refused(why);
    return solve(stop);
  }

 private:
  static MeshErrorEstimate refused(std::string reason) {
    MeshErrorEstimate none;
    none.reason = std::move(reason);
    return none;
  }

  StepContext step() const { return {.start = y_, .h = in_.is_static ? 0 : in_.h, .time = in_.state.time}; }

  // Computes r_ and the held stiffness. Returns why it cannot.
  std::string find_forces() {
    const Model& model = in_.model;
    ForceLift forces(model, lift_);
    Vector elastic(x_.size(), 0.0), total(x_.size());
    for (const auto& V : model.elasticity) V->add_gradient(x_, 1, elastic);
    if (norm_of(elastic) == 0) return "nothing is strained";
    total = elastic;
    BlockSparse held(in_.pattern);
    Vector f(x_.size());
    const auto force_of = [&](const ActiveTerm& term) {
      std::fill(f.begin(), f.end(), 0.0);
      term.add_gradient(x_, -1, f);
      for (size_t i = 0; i < f.size(); ++i) total[i] -= f[i];
    };
    const auto add_outer = [&](const ActiveTerm& term) {
      force_of(term);
      forces.add(f);
      term.add_hessian(x_, 1, {Definiteness::clamped}, held);
    };
    for (const ActiveTerm& term : in_.terms.loads()) {
      if (dynamic_cast<const TetEnergy*>(&term.energy()))
        force_of(term);
      else
        add_outer(term);
    }
    for (const ActiveTerm& term : in_.terms.damping()) {
      if (&term.energy() == static_cast<const Energy*>(model.friction) ||
          dynamic_cast<const PressureRim*>(&term.energy())) {
        add_outer(term);
        continue;
      }
      force_of(term);
      move_mass_damping(term, f, forces);
      if (norm_of(f) > kSmallForce * norm_of(elastic))
        return "the forces of '" + std::string(term.name()) + "' are not small at this time";
    }
    if (!in_.is_static) forces.add_acceleration(accelerations(total), -1);
    r_ = forces.take(*raised_.mass);
    for (size_t i = 3 * static_cast<size_t>(lift_.vertices()); i < r_.size(); ++i) r_[i] -= inner_[i];
    lift_.balance(r_);
    raised_.loads.push_back(std::make_unique<HeldStiffness>(std::move(held)));
    return "";
  }

  // Moves the share -a M v of a damping force to the accelerations.
  void move_mass_damping(const ActiveTerm& term, std::span<double> f, ForceLift& forces) const {
    const auto* damping = dynamic_cast<const Damping*>(&term.energy());
    if (!damping) return;
    Vector rate(in_.state.qdot), product(f.size());
    for (size_t i = 0; i < rate.size(); ++i) rate[i] *= damping->mass_factor(static_cast<int>(i / 3));
    in_.model.mass->multiply(rate, product);
    for (size_t i = 0; i < f.size(); ++i) f[i] += product[i];
    forces.add_acceleration(rate, -1);
  }

  // Returns the accelerations of free vertices from their forces -dV/dx, and those of pins from their motion.
  Vector accelerations(std::span<const double> gradient) const {
    Vector before(x_), earlier(x_), a(x_.size());
    in_.pins.place(in_.state.time - in_.h, before);
    in_.pins.place(in_.state.time - 2 * in_.h, earlier);
    const std::span<const double> mass = in_.model.mass->row_sums();
    for (int v = 0; v < in_.pins.rows(); ++v) {
      const Vec3d moved = (1 / (in_.h * in_.h)) * (point(x_, v) - 2.0 * point(before, v) + point(earlier, v));
      const Vec3d free = mass[v] > 0 ? (-1 / mass[v]) * point(gradient, v) : Vec3d{};
      const Vec3d sum = in_.pins.held_part(v, moved) + in_.pins.free_part(v, free);
      for (int r = 0; r < 3; ++r) a[3 * v + r] = sum[r];
    }
    return a;
  }

  MeshErrorEstimate solve(const StopToken& stop) {
    const Pins pins(raised_.pins, y_);
    IncrementalPotential E(raised_, pins);
    E.at({.predicted = y_, .inertia = inertia(E.sizes().growth_stiffness()), .context = step()});
    pins.set_zero(r_);
    Vector g(y_.size()), d(y_.size(), 0.0);
    for (size_t i = 0; i < g.size(); ++i) g[i] = -r_[i];
    Newton newton(make_linear_solver("auto"));
    newton.begin();
    DirectionReport work;
    const bool is_solved = newton.compute({E, y_, g, {.loosest = kResidual, .enough = kResidual}, stop}, d, work);
    if (work.stopped) return refused("it was interrupted");
    if (!is_solved) return refused("the linear system of quadratic tets was not solved");
    return report(d, !work.projected);
  }

  bool all_are_pinned() const {
    return std::all_of(in_.model.bodies.begin(), in_.model.bodies.end(), [&](const BodyRange& body) {
      for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v)
        if (!in_.pins.is_free(v)) return true;
      return false;
    });
  }

  // Returns a factor of the mass that keeps free bodies in place: in dynamics, the time that d had to develop; else, a
  // small part of the squared rate of uniform growth.
  double inertia(double growth_stiffness) const {
    const double tau = std::max(in_.since, in_.h);
    if (!in_.is_static && !all_are_pinned()) return 1 / (tau * tau);
    Vec3d center{};
    const std::vector<Vec3d>& X = in_.model.mesh.rest;
    for (const Vec3d& Xv : X) center = center + (1.0 / in_.pins.rows()) * Xv;
    double growth_inertia = 0;
    for (int v = 0; v < in_.pins.rows(); ++v)
      growth_inertia += in_.model.mass->vertex_mass()[v] * squared_norm(X[v] - center);
    return growth_inertia > 0 ? kSmallInertia * growth_stiffness / growth_inertia : 0;
  }

  MeshErrorEstimate report(const Vector& d, bool is_reliable) const {
    const Model& model = in_.model;
    MeshErrorEstimate found;
    found.is_reliable = is_reliable;
    found.correction.assign(d.begin(), d.begin() + static_cast<std::ptrdiff_t>(x_.size()));
    found.density = densities(d);
    std::vector<int> body_of;  // of each vertex
    for (size_t b = 0; b < model.bodies.size(); ++b)
      body_of.resize(body_of.size() + model.bodies[b].vertex_count, static_cast<int>(b));
    std::vector<double> energy(model.bodies.size(), 0.0), work(model.bodies.size(), 0.0);  // r . d / 2 and f . d
    const auto add = [&](int node, int vertex) {
      energy[body_of[vertex]] += 0.5 * dot(point(r_, node), point(d, node));
      work[body_of[vertex]] += dot(point(r_, node) + point(inner_, node), point(d, node));
    };
    for (int v = 0; v < lift_.vertices(); ++v) add(v, v);
    for (size_t e = 0; e < lift_.ends().size(); ++e) add(lift_.middle(static_cast<int>(e)), lift_.ends()[e][0]);
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const BodyRange& body = model.bodies[b];
      BodyMeshError& error = found.bodies.emplace_back(BodyMeshError{.energy = energy[b]});
      const std::vector<MaterialParameters> parameters = model.elasticity[b]->parameters();
      double stiffness = 0;
      for (int t = body.first_tet; t < body.first_tet + body.tet_count; ++t) {
        stiffness += volume(model.mesh, t) * parameters[t - body.first_tet].lame.mu;
        if (found.density[t] > (error.worst_tet < 0 ? 0 : found.density[error.worst_tet])) error.worst_tet = t;
      }
      error.motion = motion_of(body, d);
      const double V = elastic_energy(b), least = std::min(V, V + work[b] - error.energy);
      error.stiffness = V > kUnstrained * kUnstrained * stiffness && least > 0
                            ? error.energy / least
                            : std::numeric_limits<double>::quiet_NaN();
    }
    return found;
  }

  // NaN in motion, where the displacement may be small at any time, and for bodies without pins, which move rigidly.
  double motion_of(const BodyRange& body, const Vector& d) const {
    bool is_pinned = false;
    double correction = 0, displacement = 0;
    for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v) {
      is_pinned |= !in_.pins.is_free(v);
      correction = std::max(correction, norm(point(d, v)));
      displacement = std::max(displacement, norm(point(x_, v) + point(d, v) - in_.model.mesh.rest[v]));
    }
    return in_.is_static && is_pinned && displacement > 0 ? correction / displacement
                                                          : std::numeric_limits<double>::quiet_NaN();
  }

  double elastic_energy(size_t body) const {
    const BodyRange& range = in_.model.bodies[body];
    double V = in_.model.elasticity[body]->value(x_);
    for (const ActiveTerm& term : in_.terms.loads())
      if (const auto* in_tets = dynamic_cast<const TetEnergy*>(&term.energy()))
        if (in_tets->first_tet() >= range.first_tet && in_tets->first_tet() < range.first_tet + range.tet_count)
          V += term.value(x_);
    return V;
  }

  // Returns the energy of the part of d that is not linear, by second differences.
  Vector densities(const Vector& d) const {
    const Vector linear = lift_(std::span(d).first(x_.size()));
    Vector w(d.size());
    double ratio = 0;  // largest displacement relative to the edge
    for (size_t e = 0; e < lift_.ends().size(); ++e) {
      const int middle = lift_.middle(static_cast<int>(e));
      for (int r = 0; r < 3; ++r) w[3 * middle + r] = d[3 * middle + r] - linear[3 * middle + r];
      const auto& [a, b] = lift_.ends()[e];
      ratio = std::max(ratio, norm(point(w, middle)) / norm(in_.model.mesh.rest[a] - in_.model.mesh.rest[b]));
    }
    Vector density(raised_.mesh.tet_count(), 0.0);
    if (ratio == 0) return density;
    const double step = kProbe / ratio;
    const auto energies = [&](double factor) {
      Vector z(y_);
      for (size_t i = 0; i < z.size(); ++i) z[i] += factor * w[i];
      const size_t tets = density.size();
      TetFields fields{Vector(tets), Vector(tets), Vector(6 * tets), Vector(tets)};
      for (const auto& V : raised_.elasticity) V->evaluate(z, fields);
      return std::move(fields.energy_density);
    };
    const Vector more = energies(step), less = energies(-step), here = energies(0);
    for (size_t t = 0; t < density.size(); ++t)
      density[t] = std::max(0.0, (more[t] + less[t] - 2 * here[t]) / (2 * step * step));
    return density;
  }

  const MeshErrorInput& in_;
  Lift lift_;
  const Vector& x_;
  Model raised_;
  Vector y_, inner_, r_;  // positions, dV2/dy and r of all nodes
};

}  // namespace

MeshErrorEstimate estimate_mesh_error(const MeshErrorInput& input, const StopToken& stop) {
  MeshErrorEstimate none;
  const double gigabytes = 1e-9 * kBytesPerTet * input.model.mesh.tet_count();
  const double available = 1e-9 * static_cast<double>(free_memory());
  if (!input.model.share.is_whole()) {
    none.reason = "the mesh is distributed over processes";
  } else if (!input.model.mesh.mids.empty()) {
    none.reason =
        "order = 2; quadratic tets are the reference of the estimate (their error is 0 to 4 % with two tets across, "
        "more with one)";
  } else if (!input.model.mesh.sheet.empty()) {
    none.reason = "the scene has sheets";
  } else if (!input.model.mesh.rods.empty()) {
    none.reason = "the scene has rods";
  } else if (gigabytes > available) {
    none.reason = formatted("quadratic tets need about %.2g GB; %.2g GB of memory are free", gigabytes, available);
  } else {
    return Estimator(input).compute(stop);
  }
  return none;
}

// From k to `target` by h^2. Measured on beams of 1 to 3 cells, k falls more slowly the larger it is.
double edge_factor(double stiffness, double target) { return std::sqrt(target / stiffness); }

}  // namespace aspic
