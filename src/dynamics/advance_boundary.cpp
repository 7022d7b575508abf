#include "dynamics/advance_boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "contact/barrier.h"

namespace aspic {
namespace {

constexpr double kSmallestPart = 1.0 / 1024;
constexpr double kShortPart = 0.1;  // share of the remaining way; shorter moves are followed by a few iterations
constexpr int kMaxParts = 200;
// Obstacles that approach a body from a distance beyond the reach of contact move by the small share of their way that
// the gap is. Afterwards, Newton directions carry the body along.
constexpr double kSmallestApproach = 1e-8;
constexpr int kPatience = 20;  // moves by less than kSmallestPart in a row
// Largest rise of E when all pins move at once, and when they move in fractions, relative to the energy of doubling the
// body. Newton's method reduces the exponent of an exponential law by about 1 per iteration.
constexpr double kMostRise = 1e3, kMostRiseOfPart = 1;

MinimizeOptions rough(const MinimizeOptions& options) {
  MinimizeOptions few = options;
  few.max_iterations = std::min(options.max_iterations, 8);
  few.criterion = Criterion::scale;
  few.tolerance = 1e-2;
  few.stop = options.stop.without_deadline();  // a step needs a start
  return few;
}

// Pins and obstacles on their way to the positions at the end of the step.
class Boundary {
 public:
  Boundary(const StepTools& tools, double time, std::span<const double> from, std::span<const double> to,
           MinimizeReport& work)
      : tools_(tools),
        time_(time),
        to_(to.begin(), to.end()),
        from_(from),
        reached_(from.begin(), from.end()),
        work_(work) {}

  // Limits the rise of E in each move, from `value` at the start.
  void limit_rise(double value, double most) { here_ = value, most_ = most; }
  double done() const { return done_; }
  std::span<const double> reached() const { return reached_; }
  const Evaluation& value() const { return *value_; }  // there, after a move

  // Moves them to a part of the whole way, and the free vertices by alpha d. Returns false if that is blocked.
  bool move(double next, double alpha = 0, std::span<const double> d = {}) {
    trial_ = reached_;
    for (size_t i = 0; i < d.size(); ++i) trial_[i] += alpha * d[i];
    between_ = to_;
    if (next < 1)
      for (size_t i = 0; i < to_.size(); ++i) between_[i] = from_[i] + next * (to_[i] - from_[i]);
    tools_.pins.copy_held(between_, trial_);
    tools_.E.terms().move_obstacles(time_at(next));
    const Evaluation there = tools_.E.evaluate(trial_);
    ++work_.values;
    const bool is_low = std::isfinite(there.value) && there.value - here_ <= most_;
    if (!is_low || !is_free(tools_, {reached_, trial_, time_at(done_), time_at(next)})) return false;
    done_ = next;
    value_ = there;
    here_ = there.value;
    reached_.swap(trial_);
    return true;
  }

  // The same, and the free vertices along the secant of the last two states at which they settled.
  bool move_along_secant(double next) {
    if (before_.empty()) return false;
    secant_.resize(reached_.size());
    for (size_t i = 0; i < secant_.size(); ++i) secant_[i] = reached_[i] - before_[i];
    return move(next, (next - done_) / (done_ - done_before_), secant_);
  }

  // Moves obstacles and free vertices along a Newton direction that includes the motion of the obstacles, as far as
  // contact allows. Returns the share of the remaining way.
  double carry() {
    g_.resize(reached_.size()), d_.resize(reached_.size());
    tools_.E.terms().move_obstacles(time_at(done_), time_);
    tools_.E.gradient(reached_, g_);
    ++work_.gradients, ++work_.carries;
    tools_.direction.begin();
    DirectionReport made;
    const bool is_made = tools_.direction.compute({tools_.E, reached_, g_, {}, tools_.options.stop}, d_, made);
    work_.add(made);
    const double reach = is_made ? tools_.E.max_step(reached_, d_) : 0;
    for (double part = std::min(1.0, reach); part > kSmallestApproach; part /= 2)
      if (move(part < 1 ? done_ + part * (1 - done_) : 1, part, d_)) return part;
    return 0;
  }

  // A few iterations where they are. Returns false if the user interrupts.
  bool settle() {
    tools_.E.terms().move_obstacles(time_at(done_));
    before_ = settled_.empty() ? std::vector<double>(from_.begin(), from_.end()) : settled_;
    done_before_ = done_settled_;
    InitialIterate at(reached_);
    at.value = value_;
    const MinimizeReport spent =
        tools_.minimizer.minimize(tools_.E, tools_.direction, at, rough(tools_.options), tools_.observe);
    add_work(spent, work_);
    value_.reset();
    here_ = spent.value;
    settled_ = reached_;
    done_settled_ = done_;
    return spent.status != Status::interrupted;
  }

 private:
  double time_at(double part) const {
    return part < 1 ? tools_.obstacle_start + part * (time_ - tools_.obstacle_start) : time_;
  }

  const StepTools& tools_;
  double time_;
  std::vector<double> to_;
  std::span<const double> from_;
  std::vector<double> reached_;
  MinimizeReport& work_;
  double done_ = 0;
  double here_ = 0, most_ = std::numeric_limits<double>::infinity();  // E at reached_, and its largest rise
  std::optional<Evaluation> value_;                                   // of reached_, if known
  std::vector<double> trial_, between_, g_, d_, secant_;
  std::vector<double> before_, settled_;  // the last two states at which free vertices settled
  double done_before_ = 0, done_settled_ = 0;
};

// Both return whether all are where they belong.
bool move_all(Boundary& boundary) {
  double part = 0.5;  // of the whole way
  int moves = 0;
  while (moves < kMaxParts && part >= kSmallestPart) {
    const double next = std::min(1.0, boundary.done() + part);
    if (!boundary.move_along_secant(next) && !boundary.move(next)) {
      part /= 2;
      continue;
    }
    ++moves;
    if (boundary.done() == 1) return true;
    if (!boundary.settle()) return false;
    part *= 2;
  }
  return false;
}

// is_patient: also by many short moves.
bool carry_all(Boundary& boundary, bool is_patient) {
  for (int i = 0, short_moves = 0; i < kMaxParts && short_moves < kPatience; ++i) {
    const double before = boundary.done(), part = boundary.carry();
    if (boundary.done() == 1) return true;
    short_moves = boundary.done() - before < kSmallestPart ? short_moves + 1 : 0;
    if (part < kShortPart && (!is_patient || !boundary.settle())) return false;
  }
  return false;
}

}  // namespace

bool is_free(const StepTools& tools, const ContactPath& path) {
  if (!tools.model.contact) return true;
  std::vector<double> d(path.to.begin(), path.to.end());
  for (size_t i = 0; i < d.size(); ++i) d[i] -= path.from[i];
  return tools.model.contact->max_step(path.from, d, path.start_time, path.end_time) >= 1;
}

void add_work(const MinimizeReport& spent, MinimizeReport& work) {
  work.add(spent);
  work.iterations += spent.iterations;
  work.carries += spent.carries;
  work.trials += spent.trials;
  work.projected_hessians += spent.projected_hessians;
  work.projected_elements += spent.projected_elements;
  work.fallbacks += spent.fallbacks;
}

Evaluation advance_boundary(const StepTools& tools, double time, std::span<const double> from, std::span<double> q,
                            MinimizeReport& work) {
  tools.pins.place(time, q);
  const Evaluation at_once = tools.E.evaluate(q);
  ++work.values;
  const double most = kMostRise * tools.E.scales().value;
  const bool is_possible = std::isfinite(at_once.value) && is_free(tools, {from, q, tools.obstacle_start, time});
  if (is_possible && std::abs(at_once.value) <= most) return at_once;
  const bool carries = tools.model.contact && tools.model.contact->has_moving_obstacle();
  Boundary boundary(tools, time, from, q, work);
  if (!carries || is_possible) {
    const double at_start = tools.E.value(from);
    ++work.values;
    if (is_possible && !(at_once.value - at_start > most)) return at_once;
    if (!carries) boundary.limit_rise(at_start, kMostRiseOfPart * tools.E.scales().value);
  }
  // A step that failed left body and obstacles where they were, so they block each other unless the obstacles return.
  const bool were_blocked = tools.obstacle_start != tools.start.time;
  if (carries ? carry_all(boundary, !were_blocked) : move_all(boundary)) {
    std::copy(boundary.reached().begin(), boundary.reached().end(), q.begin());
    return boundary.value();
  }
  return tools.model.contact ? Evaluation{std::numeric_limits<double>::infinity()} : at_once;
}

}  // namespace aspic
