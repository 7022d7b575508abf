// The history of one side: its start, its snapshots and a row for each step.
#pragma once
#include <memory>
#include <vector>

#include "viewer/step_rows.h"
#include "viewer/timeline.h"

namespace aspic::viewer {

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
