#include "dynamics/step_derivatives.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "contact/barrier.h"
#include "dynamics/explanation_places.h"
#include "dynamics/incremental_potential.h"
#include "energy/dense_energy.h"
#include "math/vectors.h"
#include "mesh/box.h"
#include "mesh/tet_nodes.h"

namespace aspic {
namespace {

struct NamedState {
  std::string name;
  std::vector<double> q;
};

double mean_edge(const TetMesh& mesh) {
  double sum = 0, count = 0;
  const auto add = [&](const auto& corners) {
    for (size_t i = 0; i < corners.size(); ++i)
      for (size_t j = 0; j < i; ++j) sum += norm(mesh.rest[corners[i]] - mesh.rest[corners[j]]), ++count;
  };
  for (const Tet& tet : mesh.tets) add(tet);
  for (const Triangle& triangle : mesh.sheet) add(triangle);
  for (const Segment& segment : mesh.rods) add(segment);
  return count == 0 ? 1 : sum / count;
}

// Random values, uniform in [-1, 1], equal on all systems.
class Noise {
 public:
  double operator()() { return 2 * (static_cast<double>(random_() >> 11) * 0x1p-53) - 1; }

 private:
  std::mt19937_64 random_{11};
};

constexpr const char* kTouching = "touching";
constexpr double kNegligible = 1e-12;  // stiffness of a term relative to that of the stiffest, such as slack fibres

std::vector<double> near_rest(const Model& model, double edge) {
  Noise noise;
  std::vector<double> q;
  for (const Vec3d& X : model.mesh.rest)
    for (int r = 0; r < 3; ++r) q.push_back(X[r] + 0.01 * edge * noise());
  while (q.size() < 3 * static_cast<size_t>(model.rows())) q.push_back(0.01 * edge * noise());
  return q;
}

// Returns positions deformed about the origin: a stretch by `amount` along x, a contraction by half of it along y, a
// shear, and random displacements.
std::vector<double> deformed(const std::vector<double>& q, double amount, double edge) {
  Noise noise;
  std::vector<double> x(q.size());
  for (size_t i = 0; i < q.size(); i += 3) {
    x[i] = (1 + amount) * q[i] + 0.5 * amount * q[i + 1];
    x[i + 1] = (1 - 0.5 * amount) * q[i + 1];
    x[i + 2] = q[i + 2] + 0.3 * amount * q[i];
    for (size_t r = 0; r < 3; ++r) x[i + r] += 0.3 * amount * edge * noise();
  }
  return x;
}

class StepCheck {
 public:
  StepCheck(const Simulation& simulation, double tolerance)
      : simulation_(simulation),
        model_(simulation.model()),
        state_(simulation.state()),
        start_(simulation.snapshot().start.q),
        pins_(model_.pins, start_),
        E_(model_, pins_),
        edge_(mean_edge(model_.mesh)),
        tolerance_(tolerance),
        time_(state_.time + simulation.options().h) {
    const double h = simulation.options().h;
    const bool is_static = simulation.integrator().is_static();
    const StepContext context{state_.q, is_static ? 0 : h, time_};
    std::vector<double> predicted = state_.q;
    if (!is_static)
      for (size_t i = 0; i < predicted.size(); ++i) predicted[i] += h * state_.qdot[i];
    inertia_ = is_static ? 0 : 1;
    E_.at({.predicted = predicted,
           .inertia = inertia_,
           .factor = is_static ? 1 : h * h,
           .context = context,
           .internal = state_.internal,
           .duration = h});
    predicted_ = std::move(predicted);
  }

  std::vector<TermDerivatives> run() {
    for (const NamedState& at : states()) {
      if (at.name == kTouching) E_.terms().update_lagged(at.q, false);
      negligible_ = kNegligible * stiffness(at.q);
      const std::vector<std::string> names = simulation_.potential_names();
      for (size_t k = 0; k < E_.terms().potential().size(); ++k)
        check(names[k], at, differentiable(E_.terms().potential()[k], E_.pattern()));
      for (const ActiveTerm& D : E_.terms().damping())
        check(std::string(D.name()), at, differentiable(D, E_.pattern()));
      if (inertia_ != 0) check("inertia", at, inertia());
      check_E(at);
    }
    return std::move(results_);
  }

 private:
  std::vector<NamedState> states() {
    std::vector<NamedState> all = {{"start", near_start()}, {"rest", near_rest(model_, edge_)}};
    if (!is_finite(all.back().q)) all.pop_back();
    double amount = 0.15;
    for (int attempt = 0; attempt < 10; ++attempt, amount /= 2) {
      NamedState strained{"deformed", deformed(state_.q, amount, edge_)};
      if (!is_finite(strained.q)) continue;
      all.push_back(std::move(strained));
      break;
    }
    if (std::vector<double> q = touching(); !q.empty() && is_finite(q)) all.push_back({kTouching, std::move(q)});
    return all;
  }

  // Returns the current state, with contact or damping perturbed by up to a hundredth of an edge, because the second
  // derivatives of friction and of muscle_velocity have a kink at rest.
  std::vector<double> near_start() {
    std::vector<double> q = state_.q;
    if (!model_.contact && model_.damping.empty()) return q;
    std::vector<double> d(q.size());
    std::generate(d.begin(), d.end(), [this, noise = Noise{}]() mutable { return 0.01 * edge_ * noise(); });
    add_scaled(0.5 * std::min(1.0, E_.max_step(q, d)), d, q);
    return q;
  }

  // Returns the first state in which a body that moves along an axis and slightly sideways touches; empty without
  // contact.
  std::vector<double> touching() {
    constexpr double kFar = 3, kAside = 0.3;  // relative to the size of the scene, and to the path
    std::vector<double> nearest;
    if (!model_.contact) return nearest;
    const double far = kFar * size_of(model_.mesh);
    double least = 1;
    for (const BodyRange& body : model_.bodies)
      for (int way = 0; way < 6; ++way) {
        std::vector<double> d(state_.q.size());
        for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v)
          for (int r = 0; r < 3; ++r) d[3 * v + r] = r == way / 2 ? (way % 2 ? -far : far) : kAside * far;
        const double step = E_.max_step(state_.q, d);
        if (!(step < least)) continue;
        least = step;
        nearest = state_.q;
        add_scaled(step, d, nearest);
      }
    return nearest;
  }
  bool is_finite(const std::vector<double>& q) { return std::isfinite(E_.value(q)); }

  // Describes where a surface is at or behind an obstacle; empty: nowhere.
  std::string overlap(const std::vector<double>& q) const {
    if (!model_.contact) return "";
    const std::vector<Vec3d> x = model_.contact->points(q, time_);
    const auto stencils = model_.contact->stencils(q, time_);
    for (const ContactStencil& stencil : *stencils)
      if (!std::isfinite(stencil.value(x)))
        return model_.contact->mesh().pair_name(stencil.parts) + " overlap at " +
               places::point_text(x[stencil.point[0]].a, 0) + ", t = " + places::text(time_) + " s";
    return "";
  }

  void check(const std::string& term, const NamedState& at, const Differentiable& f) {
    check(term, at, f, {.length = edge_, .tolerance = tolerance_, .negligible = negligible_, .fixed = {}});
  }
  void check(const std::string& term, const NamedState& at, const Differentiable& f,
             const DerivativeCheckOptions& options) {
    if (!std::isfinite(f.value(at.q))) {
      const std::string place = overlap(at.q);
      results_.push_back({term, at.name, {}, place.empty() ? "the energy is not finite" : place});
      return;
    }
    results_.push_back({term, at.name, check_derivatives(f, at.q, options)});
  }

  // Returns the largest change of a force of one term of V per unit of random displacements [N/m].
  double stiffness(const std::vector<double>& q) const {
    std::vector<double> d(q.size()), Hd(q.size());
    std::generate(d.begin(), d.end(), Noise());
    double largest = 0;
    for (const ActiveTerm& V : E_.terms().potential()) {
      differentiable(V, E_.pattern()).hessian_times(q, d, Hd);
      largest = std::max(largest, max_abs(Hd));
    }
    return largest;
  }

  void check_E(const NamedState& at) {
    std::vector<char> fixed(at.q.size());
    for (size_t i = 0; i < at.q.size(); ++i) fixed[i] = pins_.holds(static_cast<int>(i / 3), static_cast<int>(i % 3));
    check("E", at, differentiable(E_), {.length = edge_, .tolerance = tolerance_, .fixed = std::move(fixed)});
  }

  // 1/2 (q - q~)' M (q - q~)
  Differentiable inertia() const {
    const auto offset = [this](std::span<const double> q) {
      std::vector<double> r(q.begin(), q.end());
      for (size_t i = 0; i < r.size(); ++i) r[i] -= predicted_[i];
      return r;
    };
    return {.value =
                [this, offset](std::span<const double> q) {
                  const std::vector<double> r = offset(q);
                  std::vector<double> Mr(r.size());
                  model_.mass->multiply(r, Mr);
                  double sum = 0;
                  for (size_t i = 0; i < r.size(); ++i) sum += 0.5 * r[i] * Mr[i];
                  return sum;
                },
            .gradient = [this, offset](std::span<const double> q,
                                       std::span<double> g) { model_.mass->multiply(offset(q), g); },
            .hessian_times =
                [this](std::span<const double>, std::span<const double> d, std::span<double> Hd) {
                  BlockSparse H(E_.pattern());
                  model_.mass->add_to(1, H);
                  H.multiply(d, Hd);
                }};
  }

  const Simulation& simulation_;
  const Model& model_;
  const State& state_;
  std::vector<double> start_;
  Pins pins_;
  IncrementalPotential E_;
  double edge_, tolerance_, time_, inertia_ = 1, negligible_ = 0;
  std::vector<double> predicted_;
  std::vector<TermDerivatives> results_;
};

}  // namespace

Differentiable differentiable(const ActiveTerm& V, const BlockPattern& pattern) {
  return {.value = [&V](std::span<const double> x) { return V.value(x); },
          .gradient =
              [&V](std::span<const double> x, std::span<double> g) {
                std::fill(g.begin(), g.end(), 0.0);
                V.add_gradient(x, 1, g);
              },
          .hessian_times =
              [&V, &pattern](std::span<const double> x, std::span<const double> d, std::span<double> Hd) {
                BlockSparse H(pattern);
                V.add_hessian(x, 1, {}, H);
                H.multiply(d, Hd);
                DenseRows rows;
                if (const auto* dense = dynamic_cast<const DenseEnergy*>(&V.energy()))
                  dense->add_dense_rows(x, V.context(), 1, rows);
                add_product(rows, d, Hd);
              }};
}

std::vector<TermDerivatives> check_step_derivatives(const Simulation& simulation, double tolerance) {
  return StepCheck(simulation, tolerance).run();
}

std::string entry_name(int entry) {
  return "vertex " + std::to_string(entry / 3) + ", " + std::string(1, "xyz"[entry % 3]);
}

int tet_with(const TetMesh& mesh, int vertex, int other) {
  for (int t = 0; t < mesh.element_count(); ++t) {
    const TetNodes tet = nodes_of(mesh, t);
    const auto holds = [&](int v) { return std::find(tet.begin(), tet.end(), v) != tet.end(); };
    if (holds(vertex) && holds(other)) return t;
  }
  return -1;
}

}  // namespace aspic
