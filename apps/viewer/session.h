// What a page of the viewer talks to: one simulation, or two side by side, under one mouse. Knows no network, no thread
// and no clock; docs/viewer_protocol.md describes the messages.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/fit_job.h"

namespace aspic::viewer {

struct Message {
  bool is_binary = false;
  std::string bytes;  // JSON text, or a picture or geometry
};
using Messages = std::vector<Message>;

struct Answer {
  Messages to_sender, to_all;  // to_all: the sender, too
};

// A page of a lecture, opened in the viewer: which scene, compared with what, moved by which mouse, seen in which
// panel.
struct Lesson {
  std::string id, pages, title, claim, look;
  std::string panel = "energy";  // "energy", "microscope", "landscape" or "functions"
  std::string function;          // JSON of the question for the functions panel; empty: none
  std::string missing;           // why it cannot be shown; empty: it can
  std::filesystem::path scene;   // empty: no other scene
  std::vector<std::string> overrides;
  std::string field;  // that colors the body; empty: none
  struct Comparison {
    std::vector<std::string> overrides;
    std::string label;
  };
  std::vector<Comparison> comparison;      // none or one
  std::function<std::string()> recording;  // JSON of a recorded session, made when it is needed; empty: none
};

// A scene that a page may offer to its reader.
struct OfferedScene {
  std::string name, about;  // "bunny.toml"; one sentence
  std::filesystem::path path;
};

struct Gallery {
  std::vector<OfferedScene> scenes;           // those that come with the program
  std::vector<std::filesystem::path> recent;  // what was loaded before, the newest first
};

struct SessionOptions {
  std::vector<Lesson> lessons = {};
  std::function<Gallery()> gallery = {};                                     // empty: nothing is offered
  std::function<void(const std::filesystem::path& scene)> note_loaded = {};  // for Gallery::recent
  size_t timeline_bytes = size_t{256} << 20;                                 // what rewinding may hold, per side
  double most_tets = 1e18;                                     // per side; fewer where the memory is smaller
  std::function<void(const std::string& what)> announce = {};  // before something that takes a while; "" after it
};

enum class Role { steers, watches };

class Session {
 public:
  // Throws InvalidInput: a scene that cannot be loaded.
  Session(const std::filesystem::path& scene, const std::vector<std::string>& overrides, SessionOptions options = {});
  ~Session();

  Messages greeting(Role role) const;  // for a page that has just come: everything but the newest picture

  // A text from a page. Never throws: what is malformed, forbidden or impossible is refused in words.
  Answer handle(std::string_view text, Role role);

  bool is_playing() const;
  double speed() const;         // simulated seconds per second that play aims at
  double time() const;          // simulated so far, of the side that is behind [s]
  void note_rate(double rate);  // measured by who knows the time, for the pages
  // The next step of the side that is behind, and further ones as long as `is_next_due`; what is new, for all pages.
  Messages advance(const std::function<bool()>& is_next_due = {});

  // A requested fit: run by the owner of threads and reported by note_fit(), until wants_fit() is false or it has
  // ended. Returns the news for all pages.
  std::optional<FitTask> take_fit();
  bool wants_fit() const;
  Messages note_fit(const FitNews& news);

  Messages pictures() const;     // the newest of every side
  long picture_version() const;  // another number when they are others

  // From any thread: a step under way ends at its next iteration and is dropped.
  void interrupt();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic::viewer
