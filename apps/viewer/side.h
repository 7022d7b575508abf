// One simulation that is steered: stepped, pulled, pinned, changed and taken back while it runs.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer/fields.h"
#include "viewer/settings.h"
#include "viewer/steered_scene.h"
#include "viewer/step_rows.h"
#include "viewer/timeline.h"

namespace aspic::viewer {

enum class Progress {
  interrupted,  // nothing changed
  iterated,     // the step under way shows one iterate more
  stepped,      // a step is complete
  blown_up      // a step is complete, but there is no state to continue from
};

class Side {
 public:
  Side(SteeredScene steered, size_t timeline_bytes);

  // ---- what it is
  const SteeredScene& steered() const { return steered_; }
  const Simulation& simulation() const { return steered_.scene.simulation; }
  const Model& model() const { return simulation().model(); }
  int steps_taken() const { return simulation().steps_taken(); }
  double time() const { return simulation().state().time; }
  int iteration() const { return iteration_; }  // of the step under way; -1 between steps
  const std::vector<IterationRow>& iterations() const { return iterations_.rows(); }  // of the step under way, so far
  bool is_blown_up() const { return is_blown_up_; }
  View view() const;  // what is to be seen now
  const StepRows& rows() const { return rows_; }
  const Timeline& timeline() const { return timeline_; }
  const State& start() const { return *start_; }
  std::vector<Field> fields() const;
  bool has_field(const std::string& name) const;
  // What the mouse did in each of the steps taken, where it held the body.
  struct Pull {
    int step = 0;
    Grab grab;  // from the start of the step to its end
  };
  const std::vector<Pull>& pulls() const { return pulls_; }
  // At the start, and as the scene has them.
  const std::vector<Pin>& start_pins() const { return *timeline_.nearest(0).pins; }
  const std::vector<Pin>& scene_pins() const { return *scene_pins_; }
  const std::vector<Pin>& pins() const { return *pins_; }                              // now
  void show_further(std::vector<TetField> further) { further_ = std::move(further); }  // beside those of the model

  // ---- steps
  Progress step(const StopToken& stop);     // the next one, or what is left of the one under way
  Progress iterate(const StopToken& stop);  // one more iteration of the step under way, or the first of the next
  // To the end of that step, or of the nearest earlier one that is held; lets go of the body.
  void rewind(int step);

  // ---- settings
  struct Change {
    std::vector<std::string> overrides;
    Table document;
    std::optional<SteeredScene> reloaded;
    std::optional<SolverOptions> solver;
  };
  // A key alone drops its override. Throws InvalidInput; nothing has changed before apply().
  Change prepared(const std::string& override_text, const Announce& announce) const;
  void apply(Change change);

  // ---- the mouse
  void grab(const TetPoint& point, const Vec3d& target);
  void move(const Vec3d& target);  // reached at the end of the next step
  void release();
  void set_stiffness(double stiffness);
  double stiffness() const { return stiffness_; }  // [N/m]
  bool is_grabbed() const { return grab_.stiffness > 0; }
  Vec3d grabbed_point() const { return grab_.point(view().x); }
  Vec3d mouse_target() const { return wanted_; }
  Vec3d mouse_force() const;  // on the body [N]

  // ---- the probe
  void touch(std::shared_ptr<const Touch> touch);  // throws InvalidInput; nothing has changed then
  void press(const TipPose& pose);                 // reached at the end of the next step
  void lift();
  const Touch* touched() const { return poke_.touch.get(); }   // null: there is no tip
  const TipPose& tip_pose() const { return poke_.to; }         // now
  const TipPose& wanted_pose() const { return wanted_pose_; }  // by the end of the next step
  Wrench tip_wrench() const { return steered_.tip->wrench(view().x); }
  int touched_points() const { return steered_.tip->touched_points(view().x); }

  // ---- pins by hand
  void pin(const std::vector<int>& vertices, bool pinned);  // by the numbers of the model; throws InvalidInput
  bool is_pinned(int vertex) const { return pinned_[vertex]; }

  // ---- a step again, as it was taken
  // Repeats the step with an observer, and returns to now. Throws InvalidInput when that cannot be done any more.
  StepReport repeat(int step, const IterationObserver& observe, const StopToken& stop);

 private:
  Simulation& simulated() { return steered_.scene.simulation; }
  Moment moment() const;
  void stand_at(const Moment& moment);
  Simulation::Snapshot snapshot_of(const Moment& moment) const;
  Grab resting() const;
  Grab acting() const;
  void let_mouse_rest();
  Poke resting_poke() const;
  Poke acting_poke() const;
  void let_tip_rest();
  void change_poke(const Poke& poke);
  void hold_again(const Poke& poke);
  double end_of_next_step() const;
  void change_grab(const Grab& grab);
  void leave_step();  // forgets the iterates of the step under way
  void note_edit();   // the moment of now is another one
  void note_pins();
  Progress complete(const StepReport& report);

  SteeredScene steered_;
  std::shared_ptr<const State> start_;  // to which pins and ledger refer
  double start_time_ = 0;               // [s] where the first step would have begun, had all had the length h
  std::shared_ptr<const std::vector<Pin>> pins_, scene_pins_;
  std::vector<char> pinned_;
  Timeline timeline_;
  StepRows rows_;
  long settings_ = 0;  // changes with every setting and pin

  Grab grab_;             // as it rests
  Vec3d wanted_{};        // where the hand is by now
  double stiffness_ = 0;  // for the next grab [N/m]
  std::vector<Pull> pulls_;
  double mouse_jumps_ = 0;  // work of grabbing, letting go and stiffening since the last step [J]

  Poke poke_;             // as it rests
  TipPose wanted_pose_;   // where the tip is by now
  double tip_jumps_ = 0;  // work of touching and lifting since the last step [J]

  int iteration_ = -1;
  std::vector<double> iterate_;
  IterationRows iterations_;  // of the step that is being taken
  bool is_blown_up_ = false;
  std::vector<TetField> further_;
};

}  // namespace aspic::viewer
