#include "dynamics/adaptive_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "dynamics/advance_boundary.h"

namespace aspic {
namespace {

constexpr int kMaxLevel = 20;           // the smallest substep is h / 2^20
constexpr int kTicks = 1 << kMaxLevel;  // per step
constexpr double kGrowthSafety = 0.5;   // maximum predicted error of twice the length, relative to the tolerance

double diagonal(const TetMesh& mesh, const BodyRange& body) {
  double squared = 0;
  for (int r = 0; r < 3; ++r) {
    double low = INFINITY, high = -INFINITY;
    for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v) {
      low = std::min(low, mesh.rest[v][r]);
      high = std::max(high, mesh.rest[v][r]);
    }
    squared += (high - low) * (high - low);
  }
  return std::sqrt(squared);
}

double time_at(const StepTools& whole, int tick) {
  return tick == kTicks ? whole.end_time : whole.start.time + whole.h * tick / kTicks;
}

StepTools tools_of_substep(const StepTools& whole, const State& start, const State* previous, int first, int size) {
  return {static_cast<const SolveTools&>(whole), start, previous, whole.h * size / kTicks,
          time_at(whole, first + size)};
}

}  // namespace

AdaptiveStep::AdaptiveStep(const Model& model, double tolerance, bool remembers)
    : model_(model), tolerance_(tolerance), remembers_(remembers) {
  for (const BodyRange& body : model.bodies) size_.push_back(diagonal(model.mesh, body));
}

void AdaptiveStep::set_level(double level) {
  if (!(level >= 0 && level < kMaxLevel))
    throw InvalidInput("the checkpoint's adaptive step has level " + std::to_string(level) + "; it must be from 0 to " +
                       std::to_string(kMaxLevel - 1));
  level_ = static_cast<int>(level);
}

bool AdaptiveStep::solve_substep(Integrator& integrator, const StepTools& tools, Substep& substep) {
  substep.solve = integrator.advance(tools, substep.end, substep.forces);
  add_work(substep.solve.work, total_.work);
  failure_ = substep.solve.work.status;
  return is_success(failure_);
}

AdaptiveStep::Verdict AdaptiveStep::attempt(Integrator& integrator, const StepTools& whole, Pair pair) {
  // Substeps of explicit schemes do not poll the token.
  if (whole.options.stop.requested()) return failure_ = Status::interrupted, Verdict::interrupted;
  const auto [first, size] = pair;
  const int half = size / 2;
  const State *before = has_previous_ ? &previous_ : nullptr, *now = remembers_ ? &now_ : nullptr;
  const auto unsuccessful = [&] { return failure_ == Status::interrupted ? Verdict::interrupted : Verdict::rejected; };
  if (!has_whole_ && !solve_substep(integrator, tools_of_substep(whole, now_, before, first, size), whole_))
    return unsuccessful();
  has_whole_ = false;
  if (!solve_substep(integrator, tools_of_substep(whole, now_, before, first, half), first_)) return unsuccessful();
  const bool taken = solve_substep(integrator, tools_of_substep(whole, first_.end, now, first + half, half), second_);
  has_whole_ = true;  // if the attempt is rejected
  if (!taken) return std::swap(whole_, first_), unsuccessful();

  const double h = whole.h * size / kTicks;
  error_ = error(whole.pins, h) / (std::pow(2, integrator.facts().order) - 1) / (static_cast<double>(size) / kTicks);
  if (error_ <= 1) return Verdict::accepted;
  failure_ = Status::inaccurate;
  std::swap(whole_, first_);
  return Verdict::rejected;
}

double AdaptiveStep::error(const Pins& pins, double h) const {
  const State &a = whole_.end, &b = second_.end;
  double largest = 0;
  for (size_t body = 0; body < size_.size(); ++body) {
    const BodyRange& range = model_.bodies[body];
    for (int v = range.first_vertex; v < range.first_vertex + range.vertex_count; ++v) {
      if (pins.holds(v)) continue;
      double dq = 0, dv = 0;
      for (int i = 3 * v; i < 3 * v + 3; ++i) {
        dq += (a.q[i] - b.q[i]) * (a.q[i] - b.q[i]);
        dv += (a.qdot[i] - b.qdot[i]) * (a.qdot[i] - b.qdot[i]);
      }
      const double e = (std::sqrt(dq) + h * std::sqrt(dv)) / (tolerance_ * size_[body]);
      if (!(e <= largest)) largest = e;  // keeps NaN
    }
  }
  return largest;
}

void AdaptiveStep::keep(Integrator& integrator, const StepTools& whole, Pair pair, Ledger& ledger, StepReport& report) {
  const auto [first, size] = pair;
  const int half = size / 2;
  const auto enter = [&](const StepTools& tools, const Substep& substep) {
    const BoundedEnergies bounded = ledger.add(tools, integrator, substep.end, substep.forces, report);
    if (integrator.facts().is_backward_euler && !tools.E.terms().has_rims())  // their forces have no potential
      check_energy_bound(bounded, substep.solve.work.value / (tools.h * tools.h), report);
  };
  enter(tools_of_substep(whole, now_, nullptr, first, half), first_);
  enter(tools_of_substep(whole, first_.end, nullptr, first + half, half), second_);
  report.substeps += 2;
  for (const Substep* substep : {&first_, &second_}) {
    total_.decrement = std::max(total_.decrement, substep->solve.decrement);
    if (substep->solve.work.status == Status::round_off) total_.work.status = Status::round_off;
  }
  total_.guess = second_.solve.guess;
  total_.work.value = second_.solve.work.value;
  total_.work.gradient_norm = second_.solve.work.gradient_norm;
  std::swap(previous_, first_.end);
  std::swap(now_, second_.end);
  has_previous_ = remembers_;
  has_whole_ = false;
}

StepSolve AdaptiveStep::advance(Integrator& integrator, const StepTools& whole, Ledger& ledger, State& end,
                                StepReport& report) {
  now_ = whole.start;
  has_previous_ = whole.previous != nullptr;
  if (has_previous_) previous_ = *whole.previous;
  has_whole_ = false;
  total_ = {};
  report.substeps = 0;
  const int first_level = level_;
  for (int done = 0; done < kTicks;) {
    const int size = kTicks >> level_;
    const Verdict verdict = attempt(integrator, whole, {done, size});
    if (verdict == Verdict::interrupted) level_ = first_level;  // the step will be repeated identically
    if (verdict == Verdict::accepted) {
      keep(integrator, whole, {done, size}, ledger, report);
      done += size;
      const double predicted =
          error_ *
          std::pow(2, integrator.facts().order);  // error of twice the length, relative to its share of the tolerance
      if (level_ > 0 && done % (2 * size) == 0 && predicted <= kGrowthSafety) --level_;
      continue;
    }
    ++report.rejected;
    if (verdict == Verdict::interrupted || level_ + 1 == kMaxLevel) {
      total_.work.status = failure_;
      return total_;
    }
    ++level_;
  }
  end = now_;
  return total_;
}

}  // namespace aspic
