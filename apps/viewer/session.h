// An interactive session of one simulation, or of two in a comparison. Independent of network, threads and clocks.
// apps/viewer/protocol.md describes the messages.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/extension.h"

namespace aspic::viewer {

struct Message {
  bool is_binary = false;
  std::string bytes;  // JSON text, or a picture or geometry
};
using Messages = std::vector<Message>;

struct Answer {
  Messages to_sender, to_all;  // all pages include the sender
};

// A page of a lecture in the viewer: its scene, comparison, recorded mouse and panel.
struct Lesson {
  std::string id, pages, title, claim, exercise;
  std::string question, answer;  // for the reader; empty: none
  std::string panel = "energy";  // "energy", "microscope", "landscape" or "functions"
  bool is_log = false;           // logarithmic energies
  std::string function;          // JSON of a question for the functions panel; empty: none
  std::string missing;           // reason why it cannot be shown; empty: none
  std::filesystem::path scene;   // empty: the scene stays
  std::vector<std::string> overrides;
  std::string field;  // field of the colors; empty: none
  struct Comparison {
    std::vector<std::string> overrides;
    std::string label;
  };
  std::vector<Comparison> comparison;      // none or one
  std::function<std::string()> recording;  // returns the JSON of a recorded session; empty: none
};

// A scene that a page offers.
struct OfferedScene {
  std::string name, about;  // file name; one sentence
  std::filesystem::path path;
  std::string picture;  // URL of its data; empty: none
};

struct Gallery {
  std::vector<OfferedScene> scenes;           // scenes of the program
  std::vector<std::filesystem::path> recent;  // loaded before, newest first
};

struct SessionOptions {
  std::vector<Lesson> lessons = {};
  std::function<Gallery()> gallery = {};                                     // empty: no scenes
  std::function<void(const std::filesystem::path& scene)> note_loaded = {};  // for Gallery::recent
  size_t timeline_bytes = size_t{256} << 20;                                 // memory for snapshots, per side
  double most_tets = 1e18;                                     // per side; also limited by the free memory
  std::function<bool()> wants_stop = {};                       // polled by long work in a program without threads
  std::function<void(const std::string& what)> announce = {};  // announces a long operation; "" at its end
  SessionExtension extension = {};
};

enum class Role { steers, watches };

class Session {
 public:
  // Throws InvalidInput if the scene cannot be loaded.
  Session(const std::filesystem::path& scene, const std::vector<std::string>& overrides, SessionOptions options = {});
  ~Session();

  Messages greeting(Role role) const;  // for a new page: everything except pictures

  // Carries out a message of a page. Never throws: malformed, forbidden and impossible requests get a refusal.
  Answer handle(std::string_view text, Role role);

  bool is_playing() const;
  double speed() const;         // target of playing [simulated s / s]
  double time() const;          // simulated time of the side that is behind [s]
  void note_rate(double rate);  // measured speed for the pages [simulated s / s]
  // Takes the next step of the side that is behind, and further ones while `is_next_due` returns true. Returns the
  // messages for all pages.
  Messages advance(const std::function<bool()>& is_next_due = {});

  Messages pictures() const;     // one for each side
  long picture_version() const;  // changes with the pictures

  // Drops the current step at its next iteration. May be called from any thread.
  void interrupt();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic::viewer
