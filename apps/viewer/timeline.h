// The states of the steps taken, within a bound of memory: where rewinding can go.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "energy/grab_spring.h"
#include "energy/held_tip.h"

namespace aspic::viewer {

// Between two steps. Everything that the next ones depend on, besides the settings.
struct Moment {
  int step = 0;  // taken so far
  State state;
  std::optional<State> previous;  // see Simulation::Snapshot
  double level = 0;               // see Simulation::Snapshot
  double outside_work = 0;        // see Simulation::Snapshot
  double start_time = 0, h = 0;   // [s] see Side::snapshot_of
  std::string integrator;
  Grab grab;                                     // resting, after what was done at this moment
  Poke poke;                                     // resting
  std::shared_ptr<const std::vector<Pin>> pins;  // after what was done at this moment
  Grab acted;                                    // in the step that led here
  Poke poked;                                    // in that step
  long settings = 0;                             // with which that step was taken

  size_t bytes() const;
};

class Timeline {
 public:
  explicit Timeline(size_t most_bytes) : most_bytes_(most_bytes) {}

  void add(Moment moment);  // of a later step than all others; the first one always stays
  const std::vector<Moment>& moments() const { return moments_; }  // ascending; the first one is the start
  Moment& last() { return moments_.back(); }
  const Moment& nearest(int step) const;                       // of that step, or the next earlier one that is held
  const Moment* find(int step) const;                          // null: not held
  const Moment* at_time(double time, double tolerance) const;  // the latest one then [s]; null: not held
  void drop_after(int step);
  void clear() { moments_.clear(), bytes_ = 0; }
  bool is_empty() const { return moments_.empty(); }
  size_t bytes() const { return bytes_; }
  size_t size() const { return moments_.size(); }

 private:
  void thin_out();  // every other one of the older half goes

  size_t most_bytes_, bytes_ = 0;
  std::vector<Moment> moments_;
};

}  // namespace aspic::viewer
