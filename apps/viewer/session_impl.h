// What is behind a Session: its sides, what was done to them, and the commands and queries by name.
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <optional>

#include "io/external_program.h"
#include "viewer/bench.h"
#include "viewer/command_log.h"
#include "viewer/fit_job.h"
#include "viewer/picture.h"
#include "viewer/session_messages.h"

namespace aspic::viewer {

// While something is prepared that may take long: what is announced meanwhile is taken back at the end.
class Busy {
 public:
  explicit Busy(const SessionOptions& options) : options_(options) {}
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;
  ~Busy() {
    if (spoke_) options_.announce("");
  }
  Announce announce() {
    if (!options_.announce) return {};
    return [this](const std::string& what) {
      spoke_ = true;
      options_.announce(what);
    };
  }

 private:
  const SessionOptions& options_;
  bool spoke_ = false;
};

// What a session knows of its bench and the fit.
struct Capture {
  BenchOptions options;
  std::unique_ptr<Bench> bench;  // null: nothing was measured yet
  std::string body;              // whose bench it is: scene and settings

  std::optional<FitTask> wanted;  // to be begun
  long task = 0;                  // the latest
  long simulated = 0;             // whose material side b has
  bool is_fitting = false;
  std::string stage, words, failure;
  std::vector<FitIteration> history;  // of the stage
  std::vector<double> young;          // fitted, of each tet of the data [Pa]; empty: none
  std::vector<double> deviation;      // of log E; empty: not known
  std::optional<FitOutcome> outcome;
  std::unique_ptr<TemporaryFolder> folder;  // of the material that is simulated, until it is saved
  std::filesystem::path saved;              // the fitted material beside its data set; empty: not saved
};

// The tip that a command describes; what it leaves out is chosen. Throws InvalidInput.
Tip tip_of(Arguments& arguments, const Model& model, const Surface& cage);

struct Session::Impl {
  explicit Impl(SessionOptions o) : options(std::move(o)) {}

  // ---- session.cpp
  Answer handle(std::string_view text, Role role);
  void advance(const std::function<bool()>& is_next_due);  // as play does
  StopToken stop_token();                                  // requested by interrupt()
  void tell(Message message) { news.push_back(std::move(message)); }
  void tell_state();                       // and the steps taken since
  void tell_side(const ShownSide& shown);  // everything but the state and the picture
  std::unique_ptr<ShownSide> loaded(const std::string& name, const std::filesystem::path& path,
                                    const std::vector<std::string>& overrides);
  // Puts fresh sides in the place of what there is; from now on the recording begins with them.
  void install(std::unique_ptr<ShownSide> first, std::unique_ptr<ShownSide> second,
               std::optional<Recording::Comparison> compare);
  void show_surface(ShownSide& shown);
  ShownSide& next();  // the side whose turn it is: the one that is behind
  void take_turn();   // its next step
  void note_progress(Progress progress);

  // ---- session_commands.cpp
  struct Command {
    void (Impl::*carry_out)(Arguments&);
    bool takes_over = true;  // changes the physics, which ends a replay
  };
  static const std::map<std::string, Command>& commands();
  void command(const Json& message, Role role);
  void play(Arguments&);
  void pause(Arguments&);
  void step(Arguments&);
  void iterate(Arguments&);
  void reset(Arguments&);
  void rewind(Arguments&);
  void set_speed(Arguments&);
  void color(Arguments&);
  void surface(Arguments&);
  void take(Arguments& arguments) { arguments.finish(); }  // roles are given by who knows the pages
  void rewind_to(int step);

  // ---- session_scenes.cpp
  void set(Arguments&);
  void load(Arguments&);
  void lesson(Arguments&);
  void compare(Arguments&);
  void end_compare(Arguments&);

  // ---- session_hand.cpp
  void grab(Arguments&);
  void move(Arguments&);
  void release(Arguments&);
  void stiffness(Arguments&);
  void pin(Arguments&);

  // ---- session_tip.cpp
  void touch(Arguments&);
  void touch(const SurfacePoint& point, const Tip& tip);  // of the surface of side a
  void press(Arguments&);
  void lift(Arguments&);

  // ---- session_bench.cpp
  void set_bench(Arguments&);
  void record(Arguments&);
  void poke_all(Arguments&);
  void forget(Arguments&);
  void save_capture(Arguments&);
  Bench& bench();     // made when it is needed
  void keep_bench();  // after another scene was installed: unless the body is another one
  std::string body_text() const;
  void tell_capture();

  // ---- session_fit.cpp
  void fit(Arguments&);
  void stop_fit(Arguments&);
  void simulate_fit(Arguments&);
  void note_fit(const FitNews& update);
  void show_fit();  // as colors
  void forget_fit();
  void save_material(const std::filesystem::path& folder);
  void require_saved_material() const;  // by what side b is made of; throws InvalidInput
  Json fit_json() const;

  // ---- session_replay.cpp
  void replay(Arguments&);
  void note(Json command);  // that it was carried out now
  void start_replay(Recording recording);
  void repeat_due_events();
  bool is_replay_done();

  // ---- session_queries.cpp
  Json query(const Json& message);
  ShownSide& side_of(Arguments& arguments);

  SessionOptions options;
  std::unique_ptr<ShownSide> a, b;  // b: null without a comparison
  std::vector<std::string> base_overrides;
  std::optional<Recording::Comparison> comparison;
  CommandLog log;
  Capture capture;
  struct Replay {
    Recording recording;
    size_t next = 0;
  };
  std::optional<Replay> replaying;

  bool playing = false;
  double speed = 1, rate = 0;
  std::string field;  // shown; empty: none
  bool wants_skin = true;
  uint32_t generation = 0;                    // of the last geometry made
  long version = 0;                           // of what is to be seen
  std::unique_ptr<TemporaryFolder> uploaded;  // the files of the latest scene that a page brought along
  std::atomic<bool> stop = false;
  Messages news;  // for all pages
  PictureEncoder encoder;
};

}  // namespace aspic::viewer
