#include "viewer/session.h"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "base/error.h"
#include "contact/barrier.h"
#include "viewer/picture.h"
#include "viewer/playback.h"

namespace aspic::viewer {
namespace {

constexpr size_t kMaxBytes = 32 << 20;  // maximum size of a text, for recordings

// Throws InvalidInput for a name that is not in the table.
template <class Table>
const auto& named(const Table& table, const std::string& name, const char* kind) {
  if (const auto found = table.find(name); found != table.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [key, unused] : table) known.push_back(key);
  throw InvalidInput(fmt::format("unknown {} '{}'{}", kind, name, suggestion(name, known)));
}

}  // namespace

struct Session::Impl {
  explicit Impl(SessionOptions o) : options(std::move(o)) {
    if (options.extension.make_desk) desk = options.extension.make_desk(options, stage, playback, commands, questions);
    stage.body_changed = [this] {
      if (desk) desk->check_body();
    };
    commands["take"] = {plain([] {}), false};  // the server assigns the roles
    add_hand_commands(stage, commands);
    add_scene_commands(options, stage, playback, commands);
    add_questions(options, stage, playback, questions);
  }

  Json answer(const Json& message);
  void carry_out(const Json& message, Role role);

  SessionOptions options;
  Commands commands;
  Questions questions;
  Stage stage{options};
  Playback playback{stage, commands, options.wants_stop};
  std::unique_ptr<Desk> desk;  // null: none
  PictureEncoder encoder;
};

Json Session::Impl::answer(const Json& message) {
  const std::string name = Arguments(message, "message").text("ask", 100);
  Arguments arguments(message, name);
  arguments.value("ask");
  arguments.value("id");  // identifies the reply
  return named(questions, name, "question")(arguments);
}

void Session::Impl::carry_out(const Json& message, Role role) {
  const std::string name = Arguments(message, "message").text("do", 100);
  const Command& command = named(commands, name, "command");
  if (role != Role::steers && name != "take") throw InvalidInput("this page only watches; press Steer first");
  const bool ends_replay = playback.is_replaying() && command.takes_over;
  Arguments arguments(message, name);
  if (arguments.has("id")) arguments.value("id");
  arguments.value("do");
  command.carry_out(arguments);
  if (ends_replay) playback.end_replay();
  if (name != "take") playback.send_state();
}

Session::Session(const std::filesystem::path& scene, const std::vector<std::string>& overrides, SessionOptions options)
    : impl_(std::make_unique<Impl>(std::move(options))) {
  impl_->playback.install(impl_->stage.loaded(scene, overrides));
  impl_->stage.take_messages();
}
Session::~Session() = default;

Messages Session::greeting(Role role) const {
  Messages messages = {hello(impl_->options.lessons, role)};
  for (const ShownSide& shown : impl_->stage.sides()) impl_->stage.send_all(shown);
  if (impl_->desk) impl_->desk->send();
  impl_->playback.send_state();
  for (Message& message : impl_->stage.take_messages()) messages.push_back(std::move(message));
  return messages;
}

Answer Session::handle(std::string_view text, Role role) {
  Answer answer;
  Json id;
  impl_->playback.allow();
  try {
    const Json message = parse_json(text, kMaxBytes);
    if (message.is_object() && message.contains("id")) {
      if (!message["id"].is_number_integer()) refuse("id", message["id"], "a whole number is expected");
      id = message["id"];
    }
    Json reply;
    if (message.is_object() && message.contains("ask")) {
      reply = impl_->answer(message);
    } else {
      impl_->carry_out(message, role);
    }
    if (!id.is_null()) answer.to_sender.push_back(viewer::text({{"kind", "reply"}, {"id", id}, {"reply", reply}}));
  } catch (const std::bad_alloc&) {
    answer.to_sender.push_back(refusal(id, "there is not enough memory for this; nothing was changed"));
  } catch (const std::exception& e) {
    answer.to_sender.push_back(refusal(id, e.what(), dynamic_cast<const Interrupted*>(&e) != nullptr));
  }
  answer.to_all = impl_->stage.take_messages();
  return answer;
}

Messages Session::advance(const std::function<bool()>& is_next_due) {
  impl_->playback.advance(is_next_due);
  return impl_->stage.take_messages();
}

bool Session::is_playing() const { return impl_->playback.is_playing(); }
double Session::speed() const { return impl_->playback.speed(); }
double Session::time() const { return impl_->stage.next().side.time(); }
void Session::note_rate(double rate) { impl_->playback.set_rate(rate); }
void Session::interrupt() { impl_->playback.interrupt(); }

Messages Session::pictures() const {
  Messages messages;
  for (const ShownSide& shown : impl_->stage.sides()) {
    const Side& side = shown.side;
    const int step = side.steps_taken() + (side.iteration() >= 0 ? 1 : 0);
    const std::string field = shown.has_field(impl_->stage.field()) ? impl_->stage.field() : "";
    const Barrier* contact = side.model().contact;
    if (contact && contact->has_moving_obstacle()) messages.push_back(obstacles_message(shown));
    messages.push_back(
        {true, impl_->encoder.encode({shown.number(), shown.generation}, {step, side.iteration(), side.time(), field},
                                     shown.view(), shown.surface)});
  }
  return messages;
}

long Session::picture_version() const { return impl_->stage.version(); }

}  // namespace aspic::viewer
