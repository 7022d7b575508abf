// One simulation that is stepped, edited and rewound interactively.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "energy/grab_spring.h"
#include "viewer/held_tool.h"
#include "viewer/history.h"
#include "viewer/pin_set.h"
#include "viewer/steered_scene.h"
#include "viewer/surface.h"

namespace aspic::viewer {

class Hand : public HeldTool<Grab, Vec3d> {
 public:
  explicit Hand(double stiffness) : stiffness_(stiffness) {}

  bool is_grabbing() const { return held_.stiffness > 0; }
  double stiffness() const { return stiffness_; }  // stiffness of current and later grabs [N/m]
  Vec3d point(Positions x) const { return held_.point(x); }
  Vec3d force(Positions x) const { return is_grabbing() ? held_.stiffness * (place() - point(x)) : Vec3d{}; }  // [N]
  double energy(Positions x) const { return held_.value(x, place()); }                                         // [J]

  void grab(const TetPoint& point, const Vec3d& target, Positions x) {
    held_ = {.vertices = point.vertices, .weights = point.weights, .stiffness = stiffness_};
    held_.from = held_.to = held_.point(x);
    move(target);
  }
  void release() { held_ = {}; }
  void set_stiffness(double stiffness) {
    stiffness_ = stiffness;
    if (is_grabbing()) held_.stiffness = stiffness;
  }

 private:
  double stiffness_;
};

struct Tools {
  Hand& hand;
  SideTool& further;  // of the extension
};

enum class Progress {
  interrupted,  // nothing changed
  iterated,     // the next iterate of the current step is shown
  stepped,      // a step is complete
  blown_up      // a step is complete, but its state is not finite
};

class Side {
 public:
  Side(SteeredScene steered, size_t timeline_bytes);

  const SteeredScene& steered() const { return steered_; }
  const Simulation& simulation() const { return steered_.scene.simulation; }
  const Model& model() const { return simulation().model(); }
  const History& history() const { return history_; }
  const Hand& hand() const { return hand_; }
  const SideTool& tool() const { return *steered_.tool; }
  const PinSet& pins() const { return pins_; }
  int steps_taken() const { return simulation().steps_taken(); }
  double time() const { return simulation().state().time; }  // [s]
  int iteration() const { return iteration_; }               // index in the current step; -1 between steps
  const std::vector<IterationRow>& iterations() const { return iterations_.rows(); }  // rows of the current step
  bool is_blown_up() const { return is_blown_up_; }
  Positions positions() const { return iteration_ >= 0 ? Positions(iterate_) : Positions(simulation().state().q); }

  Progress step(const StopToken& stop);     // the rest of the current step, or the next one
  Progress iterate(const StopToken& stop);  // one iteration of the current or next step
  // Restores the latest snapshot up to that step, and releases the hand.
  void rewind(int step);
  // Repeats a step with an observer, and restores the current state. Throws InvalidInput if it cannot be repeated.
  // `finish` is called at the end of the step.
  StepReport repeat(int step, const IterationObserver& observe, const StopToken& stop,
                    const std::function<void()>& finish = {});
  // Estimates the error of the mesh after the last step and writes it into its row. Repeats the step, which defines the
  // forces. Throws InvalidInput if the step cannot be repeated or did not converge.
  void estimate_mesh_error(const StopToken& stop);
  // Density of the estimate in each tet [J/m^3]. Empty: there is none of the current state.
  std::span<const double> mesh_error() const;

  // Each of these ends the current step.
  void apply(SceneChange change);
  // Changes the tools between two steps, at positions x. A change that throws must have changed nothing.
  void edit(const std::function<void(Tools& tools, Positions x)>& change);
  void aim(const std::function<void(Tools& tools)>& change);  // changes only the wanted places of the tools
  void pin(const std::vector<int>& vertices, bool pinned);    // vertices of the model
  // Stiffness of the spring of the hand [N/m]. Ends the current step only if the hand holds the body.
  void set_stiffness(double stiffness);

 private:
  Simulation& simulated() { return steered_.scene.simulation; }
  void rest();  // sets the loads of the tools to their places
  void act();   // sets them to their motion in the next step
  StepReport acted_step(const IterationObserver& observe, const StopToken& stop);
  Progress complete(const StepReport& report);
  Snapshot snapshot() const;
  void record_edit();

  SteeredScene steered_;
  PinSet pins_;
  Hand hand_;
  ToolMotions acted_;  // in the step under way or the last one
  History history_;
  double hand_work_ = 0, tool_work_ = 0;  // work of the edits since the last step [J]

  int iteration_ = -1;
  std::vector<double> iterate_;
  IterationRows iterations_;
  bool is_blown_up_ = false;
};

}  // namespace aspic::viewer
