// The snapshots to which a session can rewind, within a bound of memory.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "energy/grab_spring.h"
#include "energy/held_tip.h"

namespace aspic::viewer {

// The state between two steps: everything except the settings that the next steps depend on.
struct Snapshot {
  int step = 0;  // number of steps taken
  State state;
  std::optional<State> previous;  // see Simulation::Snapshot
  double level = 0;               // see Simulation::Snapshot
  double obstacle_time = 0;       // see Simulation [s]
  double outside_work = 0;        // see Simulation::Snapshot
  double start_time = 0, h = 0;   // [s] see History
  std::string integrator;
  Grab grab;                                     // at rest, after the edits before the next step
  Poke poke;                                     // at rest, after these edits
  std::shared_ptr<const std::vector<Pin>> pins;  // after these edits
  Grab acted;                                    // motion in the last step
  Poke poked;                                    // motion in the last step
  long settings = 0;                             // counter of settings at the last step

  size_t bytes() const;
};

class Timeline {
 public:
  explicit Timeline(size_t most_bytes) : most_bytes_(most_bytes) {}

  void add(Snapshot snapshot);  // Requires a later step than those of all others. The first snapshot always remains.
  const std::vector<Snapshot>& snapshots() const { return snapshots_; }  // in ascending order of steps
  const Snapshot& last() const { return snapshots_.back(); }
  const Snapshot& nearest(int step) const;                       // the latest one up to that step
  const Snapshot* find(int step) const;                          // null: none
  const Snapshot* at_time(double time, double tolerance) const;  // the latest one at that time [s]; null: none
  void drop_after(int step);

 private:
  void thin_out();  // drops every other snapshot of the older half

  size_t most_bytes_, bytes_ = 0;
  std::vector<Snapshot> snapshots_;
};

}  // namespace aspic::viewer
