// Time in a session: playing, single steps and iterations, rewinding, and the replay of a recording.
#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "viewer/commands.h"
#include "viewer/stage.h"

namespace aspic::viewer {

class Playback {
 public:
  // Adds play, pause, step, iterate, reset, rewind and speed to the commands. A replay calls any of them. `wants_stop`
  // also stops steps; empty: never.
  Playback(Stage& stage, Commands& commands, std::function<bool()> wants_stop);

  // Shows other sides: paused at their start, or playing their recording.
  void install(std::vector<ShownSide> sides, std::optional<Recording::Comparison> comparison = std::nullopt,
               std::optional<Recording> recording = std::nullopt);
  // Takes the next step while playing, and further ones while `is_next_due` returns true.
  void advance(const std::function<bool()>& is_next_due);
  bool is_playing() const { return is_playing_; }
  bool is_replaying() const { return replayed_.has_value(); }
  void end_replay() { replayed_.reset(); }
  double speed() const { return speed_; }       // [simulated s / s]
  void set_rate(double rate) { rate_ = rate; }  // measured speed
  void send_state();                            // also sends the steps since the last call
  StopToken stop_token() const;                 // stopped from interrupt() until allow(), and by `wants_stop`
  void interrupt() { is_interrupted_ = true; }  // from any thread
  void allow() { is_interrupted_ = false; }

 private:
  void step();
  void iterate();
  void set_speed(Arguments& arguments);
  void rewind_to(int step);
  void move(ShownSide& shown, Progress (Side::*by)(const StopToken&));
  void take_turn();
  void repeat_due_events();
  bool is_replay_done();

  struct Replay {
    Recording recording;
    size_t next = 0;  // event
  };

  Stage& stage_;
  const Commands& commands_;
  std::function<bool()> wants_stop_;
  std::optional<Replay> replayed_;
  bool is_playing_ = false;
  double speed_ = 1, rate_ = 0;
  std::atomic<bool> is_interrupted_ = false;
};

}  // namespace aspic::viewer
