// The state that the pages of a session share: one side, or two in a comparison, and the record of the commands.
#pragma once
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "viewer/command_log.h"
#include "viewer/session_messages.h"

namespace aspic::viewer {

// Announces a long operation to the pages. The destructor ends the announcement.
class Busy {
 public:
  explicit Busy(const SessionOptions& options) : options_(options) {}
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;
  ~Busy() {
    if (announced_) options_.announce("");
  }
  void operator()(const std::string& what) {
    if (!options_.announce) return;
    announced_ = true;
    options_.announce(what);
  }

 private:
  const SessionOptions& options_;
  bool announced_ = false;
};

class Stage {
 public:
  using Comparison = Recording::Comparison;

  explicit Stage(const SessionOptions& options) : options_(options) {}

  // ---- sides
  // Loads side a, and side b if it has overrides. Throws InvalidInput.
  std::vector<ShownSide> loaded(const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                                const std::optional<std::vector<std::string>>& of_b = std::nullopt) const;
  // Shows other sides, with an empty record.
  void install(std::vector<ShownSide> sides, std::optional<Comparison> comparison);
  void end_comparison();  // throws InvalidInput without one
  std::vector<ShownSide>& sides() { return sides_; }
  ShownSide& a() { return sides_.front(); }
  ShownSide* b() { return sides_.size() > 1 ? &sides_[1] : nullptr; }  // null: no comparison
  ShownSide& named(Arguments& arguments);                              // side in the argument "side"
  ShownSide& next();                                                   // the side behind in time
  std::optional<Comparison>& comparison() { return comparison_; }

  // ---- how they are shown
  const std::string& field() const { return field_; }  // field of the colors; empty: none
  void set_field(std::string field) { field_ = std::move(field); }
  void show_surface(bool wants_skin);  // applies to all sides
  long version() const { return version_; }
  void mark_changed() { ++version_; }

  // ---- the record
  void record(Json command);
  void rewind_record();   // after all sides were rewound
  Recording recording();  // throws InvalidInput if it is incomplete

  // ---- messages for all pages
  void send(Message message) { outgoing_.push_back(std::move(message)); }
  void send_scene(const ShownSide& shown) { send(scene_message(shown, field_)); }
  void send_new_fields();                   // the scenes, if the color `mesh_error` has come or gone
  void send_shape(const ShownSide& shown);  // geometry and obstacles
  void send_all(const ShownSide& shown);    // scene, geometry, steps and pins
  Messages take_messages() { return std::exchange(outgoing_, {}); }

  std::function<void()> body_changed;  // called after a change of scene, settings or pins

 private:
  const SessionOptions& options_;
  std::vector<ShownSide> sides_;
  std::optional<Comparison> comparison_;
  std::vector<std::string> base_overrides_;  // overrides of side a at the start of the record
  CommandLog log_;
  std::string field_;
  uint32_t generation_ = 0;  // generation of the latest geometry
  long version_ = 0;
  Messages outgoing_;
};

}  // namespace aspic::viewer
