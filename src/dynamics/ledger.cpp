#include "dynamics/ledger.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/barrier.h"
#include "contact/friction.h"
#include "energy/wind.h"

namespace aspic {
namespace {

// A few units in the last place of a position, and of a strain energy relative to the modulus.
constexpr double kLastDigits = 8 * std::numeric_limits<double>::epsilon();

// Compensated summation [Neumaier 1974], because the work terms of single vertices cancel if the body moves far.
class LongSum {
 public:
  void add(double term) {
    const double sum = high_ + term;
    low_ += std::abs(high_) >= std::abs(term) ? (high_ - sum) + term : (term - sum) + high_;
    high_ = sum;
  }
  double value() const { return high_ + low_; }
  // Adds the sums of all processes, in their order.
  void sum(const Share& share) {
    if (share.is_whole()) return;
    const double own[] = {high_, low_};
    high_ = low_ = 0;
    for (const double part : share.ranks().gather(own)) add(part);
  }

 private:
  double high_ = 0, low_ = 0;
};

// Adds sign * (energy of each load except contact, which may be infinite) to V. Returns their sum.
double add_load_energies(std::span<const ActiveTerm> loads, const Energy* contact, std::span<const double> x,
                         double sign, std::vector<double>& V) {
  double sum = 0;
  for (size_t k = 0; k < loads.size(); ++k) {
    if (&loads[k].energy() == contact) continue;
    const double value = loads[k].value(x);
    V[k] += sign * value;
    sum += value;
  }
  return sum;
}

// Adds the creep of sticking contacts, and the change of friction by the last update of the normal forces, to the
// report.
void note_friction(const StepTools& tools, const ActiveTerm& term, std::span<const double> q, StepReport& report) {
  const Friction& friction = *tools.model.friction;
  std::vector<double> change(q.size());
  friction.add_change(q, term.context(), change);
  double squares = 0, most = 0;
  int worst = -1;
  for (int v = 0; v < tools.pins.rows(); ++v) {
    const Vec3d free = tools.pins.free_part(v, point(change, v));
    const double square = dot(free, free);
    squares += square;
    if (square > most) most = square, worst = v;
  }
  report.friction_residual = std::sqrt(squares);
  // Slips refer to a step of length beta.
  const double beta = term.context().h;
  report.friction_creep = friction.creep(q, term.context()) * (beta > 0 ? tools.h / beta : 1);
  const auto parts = friction.parts_at(worst, term.context());
  if (parts[0] >= 0) report.friction_pair = tools.model.contact->mesh().pair_name(parts);
}

int own_rows(const StepTools& tools) { return tools.model.own_rows(); }

struct ObstacleWork {
  double contact = 0, friction = 0;  // [J]
};

// Returns the work of obstacles, and adds friction to the report.
ObstacleWork work_of_obstacles(const StepTools& tools, const State& end, StepReport& report) {
  ObstacleWork work;
  if (!tools.model.contact) return work;
  work.contact = tools.model.contact->obstacle_work(end.q, tools.obstacle_start, tools.obstacle_end);
  std::vector<double> force(end.q.size());
  for (const ActiveTerm& D : tools.E.terms().damping()) {
    if (&D.energy() != tools.model.friction || tools.obstacle_start == tools.obstacle_end) continue;
    work.friction += tools.model.friction->obstacle_work(end.q, D.context());
    note_friction(tools, D, end.q, report);
    D.add_gradient(end.q, 1, force);
  }
  report.friction_loss = work.friction;
  for (size_t i = 0; i < force.size(); ++i) report.friction_loss += force[i] * (end.q[i] - tools.start.q[i]);
  return work;
}

// Returns the work of the moving air in the step [J].
double work_of_wind(const StepTools& tools, const State& end) {
  for (const ActiveTerm& D : tools.E.terms().damping()) {
    if (&D.energy() != tools.model.wind) continue;
    const double h = D.context().h;  // of a stage
    return h > 0 ? tools.h / h * tools.model.wind->work(end.q, D.context()).wind : 0;
  }
  return 0;
}

}  // namespace

// Sums and counts of a step, over the own rows.
struct Ledger::Works {
  LongSum inertia, gradient, damping, reaction, residual, rims;  // force . dx [J]
  double jump = 0, round_off = 0;                                // [J]
  bool pins_moved = false;

  void sum(const Share& share) {
    for (LongSum* part : {&inertia, &gradient, &damping, &reaction, &residual, &rims}) part->sum(share);
    for (double* part : {&jump, &round_off}) *part = share.sum(*part);
    pins_moved = share.max(pins_moved) > 0;
  }
};

double kinetic_energy(const Model& model, std::span<const double> qdot, std::span<double> momentum) {
  model.mass->multiply(qdot, momentum);
  double T = 0;
  const int own = 3 * model.own_rows();
  for (int i = 0; i < own; ++i) T += 0.5 * qdot[i] * momentum[i];
  return model.share.sum(T);
}

// Returns the energy that the loads gain from the motion of their targets during the step: with the body at its start,
// or for schemes of higher order the mean of the values with the body at the start and at the end.
double Ledger::target_work(const StepTools& tools, int order, const State& end, double& loads_before,
                           StepReport& report) {
  const State& start = tools.start;
  const StepContext before{start.q, tools.h, start.time}, after{start.q, tools.h, tools.end_time};
  const Energy* contact = tools.model.contact;
  const std::span<const ActiveTerm> at_end = tools.E.terms().loads();
  const size_t loads = at_end.size();
  for (auto* v : {&early_, &late_}) v->assign(loads, 0.0);
  if (at_start_.size() != loads) {
    at_start_.clear();
    for (const auto& load : tools.model.loads) at_start_.emplace_back(*load);
  }
  for (ActiveTerm& V : at_start_) V.begin_step(before);
  loads_before = add_load_energies(at_start_, contact, start.q, -1, early_);
  if (order > 1) add_load_energies(at_start_, contact, end.q, -1, late_);
  tools.E.terms().begin_potential(after);
  tools.E.terms().move_obstacles(tools.obstacle_end);
  add_load_energies(at_end, contact, start.q, 1, early_);
  if (order > 1) add_load_energies(at_end, contact, end.q, 1, late_);
  if (contact) {
    Energy::Context before_step;
    before_step.time = tools.obstacle_start;
    loads_before += contact->value(start.q, before_step);
  }
  report.target_work.resize(loads);
  double sum = 0;  // exactly zero if no load depends on the time
  for (size_t k = 0; k < loads; ++k) {
    const double work = order > 1 ? (early_[k] + late_[k]) / 2 : early_[k];
    const bool is_muscle = tools.E.terms().loads()[k].energy().name().starts_with("muscle");
    report.target_work[k] += work;
    (is_muscle ? report.muscle_work : report.load_work) += work;
    sum += work;
  }
  return sum;
}

void Ledger::begin(const Model& model, std::span<const double> q) {
  Work uncounted;
  at_start_.clear();
  last_q_.clear();
  residual_.clear();
  elastic_energies(model, q, {}, uncounted);
}

std::span<const double> Ledger::elastic_energies(const Model& model, std::span<const double> q,
                                                 std::span<const double> known, Work& work) {
  if (model.share.all(std::equal(q.begin(), q.end(), last_q_.begin(), last_q_.end()))) return elastic_;
  elastic_.clear();
  if (known.empty()) {
    for (const auto& V : model.elasticity) elastic_.push_back(V->value(q));
    ++work.values;
  } else {
    elastic_.assign(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(model.elasticity.size()));
  }
  last_q_.assign(q.begin(), q.end());
  return elastic_;
}

void Ledger::note_worst_vertex(const StepTools& tools, int part, StepReport& report) const {
  double most = 0;
  for (int v = 0; v < own_rows(tools); ++v) {
    if (tools.E.sizes().part_of(v) != part) continue;
    const Vec3d left = tools.pins.free_part(v, point(residual_, v));
    const double size = std::hypot(left[0], left[1], left[2]);
    if (size > most) most = size, report.worst_vertex = tools.model.vertex_of_row(v);
  }
  tools.model.share.find_largest(most, report.worst_vertex);
  report.worst_residual = most;
}

void Ledger::note_residual(const StepTools& tools, const StepForces& forces, StepReport& report) {
  const auto ratio = [](double residual, double threshold) { return threshold > 0 ? residual / threshold : residual; };
  const auto bound = [](const std::vector<double>& of_parts, int part) {
    return of_parts.empty() ? 0.0 : of_parts[part];
  };
  int worst = -1;
  double residual = report.residual, threshold = report.residual_threshold;
  for (int k = 0; k < tools.E.sizes().part_count(); ++k) {
    const double r = std::sqrt(squares_[k]), limit = bound(forces.thresholds, k);
    const bool is_first = worst < 0 && report.worst_vertex < 0 && report.residual == 0;
    if (!is_first && ratio(r, limit) <= ratio(residual, threshold)) continue;  // keeps NaN
    worst = k, residual = r, threshold = limit;
  }
  if (worst < 0) return;
  report.residual = residual;
  report.residual_threshold = threshold;
  report.residual_round_off = bound(forces.round_offs, worst);
  note_worst_vertex(tools, worst, report);
}

void Ledger::allow_moved_pins(const StepTools& tools, const State& end, BoundedEnergies& bounded, Work& work) {
  const State& start = tools.start;
  double V = 0, D = 0, T = 0;
  moved_ = start.q;
  tools.pins.copy_held(end.q, moved_);
  for (const ActiveTerm& term : tools.E.terms().potential()) {
    const double value = term.value(moved_);
    V += value, bounded.magnitude += std::abs(value);
  }
  ++work.values;
  tools.E.terms().begin_damping({start.q, tools.h, tools.end_time, start.q, tools.obstacle_start});
  tools.E.terms().set_internal(start.internal, tools.h);
  for (const ActiveTerm& term : tools.E.terms().damping()) D += term.value(moved_);
  for (size_t i = 0; i < moved_.size(); ++i) moved_[i] = (moved_[i] - start.q[i]) / tools.h - start.qdot[i];
  T = kinetic_energy(tools.model, moved_, momentum_);
  bounded.allowed = V + D + T;
  bounded.magnitude += D + T;
}

InternalEnergies Ledger::internal_energies(const StepTools& tools, const State& end) {
  if (tools.E.terms().internal().empty()) return {};
  const State& start = tools.start;
  const StepContext step{start.q, tools.h, tools.end_time, start.q, tools.obstacle_start};
  tools.E.terms().begin_internal(step, start.internal, tools.is_dropped ? 0 : tools.h);
  return tools.E.terms().internal_energies({start.q, end.q, end.internal});
}

// Requires that residual_ is r of this step, and that the contexts of the loads are at its end.
void Ledger::add_resultants(const StepTools& tools, const State& end, const StepForces& forces, Resultants& sums) {
  const Model& model = tools.model;
  sums.pins.resize(model.pins.size());
  sums.loads.resize(model.loads.size());
  sums.bodies.resize(model.bodies.size());
  sums.time += tools.h;
  const double part = tools.h / sums.time;
  const auto add = [&](int vertex, const Vec3d& force, Resultant& sum) {
    sum.force = sum.force + force;
    sum.moment = sum.moment + cross(point(end.q, vertex), force);
  };
  const int own = model.own_vertices();
  const auto sum = [&model](Resultant& now) {
    model.share.sum(now.force.a);
    model.share.sum(now.moment.a);
  };
  const auto update = [&sum, part](Resultant& now, Resultant& mean) {
    sum(now);
    mean.force = mean.force + part * (now.force - mean.force);
    mean.moment = mean.moment + part * (now.moment - mean.moment);
  };
  for (size_t p = 0; p < model.pins.size(); ++p) {
    Resultant now;
    const std::vector<int>& vertices = model.pins[p].vertices;
    for (size_t i = 0; i < vertices.size(); ++i)
      if (vertices[i] < own)
        add(vertices[i],
            tools.pins.reaction_of(static_cast<int>(p), static_cast<int>(i), point(residual_, vertices[i])), now);
    update(now, sums.pins[p]);
  }
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const BodyRange& body = model.bodies[b];
    Resultant now;
    for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v)  // elastic forces cancel
      add(v, tools.pins.held_part(v, point(residual_, v)) - point(forces.gradient, v) - point(forces.rims, v), now);
    update(now, sums.bodies[b]);
  }
  load_.resize(end.q.size());
  for (size_t k = 0; k < model.loads.size(); ++k) {
    tools.E.terms().loads()[k].add_gradient(end.q, -1, load_);
    tools.E.terms().add_rim_gradient(end.q, -1, load_, model.loads[k].get());
    sums.loads[k] = {};
    for (int v = 0; v < own; ++v) add(v, point(load_, v), sums.loads[k]);
    sum(sums.loads[k]);
    std::fill(load_.begin(), load_.end(), 0.0);
  }
}

// Computes r of the step and the work of its forces.
Ledger::Works Ledger::works_of(const StepTools& tools, const State& end, const StepForces& forces) {
  const State& start = tools.start;
  for (auto* v : {&Ma_, &residual_}) v->assign(end.q.size(), 0.0);
  tools.model.mass->multiply(forces.acceleration, Ma_);
  squares_.assign(tools.E.sizes().part_count(), 0.0);
  Works works;
  LongSum* const sums[] = {&works.inertia, &works.gradient, &works.damping};
  for (int v = 0; v < own_rows(tools); ++v) {
    const Vec3d x = point(end.q, v), dx = x - point(start.q, v);
    for (int i = 3 * v; i < 3 * v + 3; ++i) {
      residual_[i] = Ma_[i] + forces.gradient[i] + forces.damping[i];
      works.jump += 0.5 * tools.h * tools.h * forces.acceleration[i] * Ma_[i];
      works.round_off += kLastDigits * std::abs(end.q[i] * Ma_[i]);
    }
    // Uses the same products on both sides of the balance, so that only the sums have rounding errors.
    const Vec3d acting[] = {point(Ma_, v), point(forces.gradient, v), point(forces.damping, v)};
    Vec3d held[3];
    for (int k = 0; k < 3; ++k) held[k] = tools.pins.held_part(v, acting[k]);
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 3; ++k) {
        sums[k]->add(acting[k][r] * dx[r]);
        if (!tools.pins.holds(v)) works.residual.add((acting[k][r] - held[k][r]) * dx[r]);
        if (!tools.pins.is_free(v)) works.reaction.add(held[k][r] * dx[r]);
      }
    for (int r = 0; r < 3; ++r) works.rims.add(forces.rims[3 * v + r] * dx[r]);
    const Vec3d left = tools.pins.free_part(v, point(residual_, v)), moved = tools.pins.held_part(v, dx);
    for (int r = 0; r < 3; ++r) {
      squares_[tools.E.sizes().part_of(v)] += left[r] * left[r];
      works.pins_moved |= std::abs(moved[r]) > std::numeric_limits<double>::epsilon() * std::abs(x[r]);
    }
  }
  works.sum(tools.model.share);
  tools.model.share.sum(squares_);
  return works;
}

// Returns the energy stored in internal variables.
double Ledger::write_energies(const StepTools& tools, const State& end, StepReport& report) {
  const StepTerms& terms = tools.E.terms();
  report.potential.clear();
  report.potential.reserve(terms.potential().size());
  report.potential_total = 0;
  for (const double V : elastic_energies(tools.model, end.q, tools.E.known_values(end.q), report))
    report.potential.push_back(V);
  for (const ActiveTerm& V : terms.loads()) report.potential.push_back(V.value(end.q));
  terms.internal().append_stored(end.internal, report.potential);
  for (const double V : report.potential) report.potential_total += V;
  double stored = 0;
  for (size_t k = terms.potential().size(); k < report.potential.size(); ++k) stored += report.potential[k];
  report.kinetic = kinetic_energy(tools.model, end.qdot, momentum_);
  return stored;
}

BoundedEnergies Ledger::add(const StepTools& tools, const Integrator& integrator, const State& end,
                            const StepForces& forces, StepReport& report) {
  const State& start = tools.start;
  momentum_.assign(end.q.size(), 0.0);
  moved_.resize(end.q.size());  // before any pin moves, so that later steps do not allocate
  double potential_before = 0;
  const double target = target_work(tools, integrator.facts().order, end, potential_before, report);
  for (const double V : elastic_energies(tools.model, start.q, {}, report)) potential_before += V;
  const InternalEnergies internal = internal_energies(tools, end);
  const double kinetic_before = kinetic_energy(tools.model, start.qdot, momentum_);
  const Works works = works_of(tools, end, forces);
  const double stored = write_energies(tools, end, report);
  const double potential_after = report.potential_total - stored;

  const double kinetic_gain = report.kinetic - kinetic_before,
               potential_gain = potential_after - potential_before + internal.gain;
  const double pin_work = works.reaction.value() + target;
  const ObstacleWork obstacles = work_of_obstacles(tools, end, report);
  const double conservative = internal.work - internal.loss;  // stored or lost numerically
  const double loss = (works.inertia.value() - kinetic_gain) + works.gradient.value() -
                      (potential_gain - target - obstacles.contact) + conservative;
  const double driven = -works.rims.value() + work_of_wind(tools, end);
  const double dissipated = works.damping.value() + driven + obstacles.friction - conservative;
  note_residual(tools, forces, report);
  report.pin_work += pin_work;
  report.obstacle_work += obstacles.contact + obstacles.friction;
  report.nonconservative_work += driven;
  report.damping_loss += dissipated;
  report.viscoelastic_loss += internal.loss;
  report.numerical_loss += loss;
  report.residual_work += works.residual.value();
  report.ledger_error += kinetic_gain + potential_gain - pin_work - (obstacles.contact + obstacles.friction) - driven +
                         dissipated + loss - works.residual.value();

  add_resultants(tools, end, forces, report.resultants);

  double magnitude = report.kinetic + kinetic_before + works.jump + std::abs(potential_before);
  for (const double V : report.potential) magnitude += std::abs(V);
  BoundedEnergies bounded = {.allowed = potential_before + kinetic_before + target,
                             .reached = potential_after + internal.gain + works.jump,
                             .magnitude = magnitude,
                             .round_off = works.round_off + kLastDigits * tools.E.sizes().growth_stiffness()};
  const bool has_moved =
      works.pins_moved || tools.model.wind || (tools.model.contact && tools.model.contact->has_moving_obstacle());
  if (has_moved && integrator.facts().is_backward_euler) allow_moved_pins(tools, end, bounded, report);
  return bounded;
}

}  // namespace aspic
