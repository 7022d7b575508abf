#include "viewer/stage.h"

#include <algorithm>

#include "base/error.h"
#include "viewer/fibre_lines.h"

namespace aspic::viewer {
namespace {

constexpr double kSimultaneous = 1e-6;  // times within this fraction of a step are equal

}  // namespace

std::vector<ShownSide> Stage::loaded(const std::filesystem::path& scene, const std::vector<std::string>& overrides,
                                     const std::optional<std::vector<std::string>>& of_b) const {
  std::vector<ShownSide> sides;
  const auto load = [&](const char* name, const std::vector<std::string>& own) {
    Busy busy(options_);
    sides.push_back({name, {}, Side(load_steered(scene, own, std::ref(busy), options_), options_.timeline_bytes)});
  };
  load("a", overrides);
  if (of_b) load("b", *of_b);
  return sides;
}

void Stage::install(std::vector<ShownSide> sides, std::optional<Comparison> comparison) {
  const bool was_compared = b();
  sides_ = std::move(sides);
  if (b()) b()->side.set_stiffness(a().side.hand().stiffness());  // one hand, one spring
  comparison_ = std::move(comparison);
  base_overrides_ = a().side.steered().overrides;
  log_.clear();
  show_surface(true);
  if (b()) b()->label = comparison_->label;
  body_changed();
  if (!a().has_field(field_)) field_.clear();
  for (const ShownSide& shown : sides_) send_all(shown);
  if (was_compared && !b()) send(text({{"kind", "end_compare"}}));
}

void Stage::end_comparison() {
  if (!b()) throw InvalidInput("nothing is being compared");
  sides_.pop_back();
  comparison_.reset();
  log_.forget_side_b();
  a().label.clear();
  mark_changed();
  send(text({{"kind", "end_compare"}}));
  send_scene(a());
}

ShownSide& Stage::named(Arguments& arguments) {
  const Json& name = arguments.value("side");
  if (name == "a") return a();
  if (name != "b") refuse("side", name, "'a' or 'b' is expected");
  if (!b()) throw InvalidInput("there is no side b; compare opens it");
  return *b();
}

// An unstable side stays where it is, and the other one continues.
ShownSide& Stage::next() {
  if (!b() || b()->side.is_blown_up()) return a();
  if (a().side.is_blown_up()) return *b();
  if (a().side.iteration() >= 0) return a();
  if (b()->side.iteration() >= 0) return *b();
  const double h = std::min(a().side.simulation().options().h, b()->side.simulation().options().h);
  return b()->side.time() < a().side.time() - kSimultaneous * h ? *b() : a();
}

void Stage::show_surface(bool wants_skin) {
  mark_changed();
  for (ShownSide& shown : sides_) {
    const Scene& scene = shown.side.steered().scene;
    shown.surface = wants_skin && has_fine_skin(scene) ? fine_surface(scene) : boundary_of(shown.side.model());
    shown.generation = ++generation_;
  }
}

void Stage::record(Json command) {
  mark_changed();
  log_.add({a().side.steps_taken() + 1, b() ? b()->side.steps_taken() : -1, std::move(command)});
}

void Stage::rewind_record() {
  mark_changed();
  log_.rewind(a().side.steps_taken(), b() ? b()->side.steps_taken() : -1);
}

Recording Stage::recording() {
  if (!log_.is_complete())
    throw InvalidInput("the session has too many commands to be saved; reset starts a new recording");
  return {a().side.steered().path.string(), base_overrides_, comparison_, log_.events(), a().side.steps_taken()};
}

void Stage::send_new_fields() {
  bool is_changed = false;
  for (ShownSide& shown : sides_) {
    const bool offers = !shown.side.mesh_error().empty();
    is_changed = std::exchange(shown.offers_mesh_error, offers) != offers || is_changed;
  }
  if (!is_changed) return;
  if (!a().has_field(field_)) field_.clear();
  for (const ShownSide& shown : sides_) send_scene(shown);
}

void Stage::send_shape(const ShownSide& shown) {
  send(geometry_message(shown));
  if (has_fibres(shown.side.model())) send(fibres_message(shown));
  if (shown.side.model().contact) send(obstacles_message(shown));
}

void Stage::send_all(const ShownSide& shown) {
  send_scene(shown);
  send_shape(shown);
  send(steps_message(shown, 0));
  send(pins_message(shown));
}

}  // namespace aspic::viewer
