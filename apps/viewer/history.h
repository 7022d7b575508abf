// The history of one side: its start, its snapshots and a row for each step.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "energy/grab_spring.h"
#include "viewer/extension.h"
#include "viewer/step_rows.h"

namespace aspic::viewer {

struct ToolMotions {
  Grab grab;
  ToolMotion tool;
};

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
  ToolMotion tool;                               // at rest, after these edits
  std::shared_ptr<const std::vector<Pin>> pins;  // after these edits
  ToolMotions acted;                             // in the last step
  long settings = 0;                             // counter of settings at the last step

  size_t bytes() const;
};

// The snapshots to which a session can rewind, within a bound of memory.
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

class History {
 public:
  History(const Simulation& simulation, size_t timeline_bytes);

  const State& start() const { return *start_; }
  const Timeline& timeline() const { return timeline_; }
  const StepRows& rows() const { return rows_; }
  struct Pull {  // pull of the hand in one step
    int step = 0;
    Grab grab;  // motion from the start of the step to its end
  };
  const std::vector<Pull>& pulls() const { return pulls_; }
  double end_of_next_step(const Simulation& simulation) const;  // [s]

  Snapshot snapshot_of(const Simulation& simulation) const;  // without tools and pins
  void add(Snapshot snapshot);
  void add(Snapshot snapshot, StepRow row);
  void replace_last(Snapshot snapshot);  // after an edit
  void set_mesh_error(StepReport estimate) { rows_.set_mesh_error(std::move(estimate)); }
  // Drops all later snapshots and returns the latest one up to that step.
  Snapshot return_to(int step);
  void restore(const Snapshot& snapshot, Simulation& simulation);
  void change_settings() { ++settings_; }  // or pins; steps taken before can no longer be repeated

  // Restores the start of a step. Returns the snapshot after the step, or null if it is the next step. Throws
  // InvalidInput if the step cannot be repeated.
  const Snapshot* restore_start_of(int step, Simulation& simulation) const;

 private:
  Simulation::Snapshot simulation_state(const Snapshot& snapshot, const SimulationOptions& options) const;

  std::shared_ptr<const State> start_;
  double start_time_ = 0;  // time of the first step if all steps had the current length [s]
  Timeline timeline_;
  StepRows rows_;
  std::vector<Pull> pulls_;
  long settings_ = 0;
};

}  // namespace aspic::viewer
