#include "viewer/session.h"

#include <algorithm>
#include <new>
#include <utility>

#include "base/error.h"
#include "viewer/session_impl.h"

namespace aspic::viewer {
namespace {

constexpr size_t kMostBytes = 32 << 20;  // of a text: recordings are long

}  // namespace

// ---------------------------------------------------------------- messages

void Session::Impl::tell_state() {
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown || shown->told_steps >= shown->side.steps_taken()) continue;
    tell(steps_message(*shown, shown->told_steps));
    shown->told_steps = shown->side.steps_taken();
  }
  tell(text({{"kind", "state"},
             {"playing", playing},
             {"speed", speed},
             {"rate", playing ? rate : 0},
             {"replaying", replaying.has_value()},
             {"a", state_of(*a)},
             {"b", b ? state_of(*b) : Json()}}));
}

void Session::Impl::tell_side(const ShownSide& shown) {
  tell(scene_message(shown, field));
  tell(geometry_message(shown));
  tell(steps_message(shown, 0));
  tell(pins_message(shown));
}

Answer Session::Impl::handle(std::string_view text, Role role) {
  Answer answer;
  Json id;
  news.clear();
  stop = false;
  try {
    const Json message = parse_json(text, kMostBytes);
    if (message.is_object() && message.contains("id")) {
      if (!message["id"].is_number_integer()) refuse("id", message["id"], "a whole number is expected");
      id = message["id"];
    }
    Json reply;
    if (message.is_object() && message.contains("ask")) {
      reply = query(message);
    } else {
      command(message, role);
    }
    if (!id.is_null()) answer.to_sender.push_back(viewer::text({{"kind", "reply"}, {"id", id}, {"reply", reply}}));
  } catch (const std::bad_alloc&) {
    answer.to_sender.push_back(refusal(id, "there is not enough memory for this; nothing was changed"));
  } catch (const std::exception& e) {
    answer.to_sender.push_back(refusal(id, e.what()));
  }
  answer.to_all = std::move(news);
  news.clear();
  return answer;
}

// ---------------------------------------------------------------- sides

std::unique_ptr<ShownSide> Session::Impl::loaded(const std::string& name, const std::filesystem::path& path,
                                                 const std::vector<std::string>& overrides) {
  Busy busy(options);
  return std::make_unique<ShownSide>(
      ShownSide{name,
                {},
                Side(load_steered(path, overrides, busy.announce(), options.most_tets), options.timeline_bytes),
                {},
                0});
}

void Session::Impl::show_surface(ShownSide& shown) {
  const Scene& scene = shown.side.steered().scene;
  shown.surface = wants_skin && has_fine_skin(scene) ? fine_surface(scene) : boundary_of(shown.side.model());
  shown.generation = ++generation;
}

void Session::Impl::install(std::unique_ptr<ShownSide> first, std::unique_ptr<ShownSide> second,
                            std::optional<Recording::Comparison> compared) {
  const bool had_b = b != nullptr;
  a = std::move(first);
  b = std::move(second);
  if (b) b->side.set_stiffness(a->side.stiffness());  // one mouse, one spring, however stiff the bodies
  comparison = std::move(compared);
  base_overrides = a->side.steered().overrides;
  log.clear();
  replaying.reset();
  playing = false;
  wants_skin = true;
  ++version;
  for (ShownSide* shown : {a.get(), b.get()}) {
    if (!shown) continue;
    show_surface(*shown);
    if (comparison) shown->label = shown == b.get() ? comparison->label : "";
  }
  keep_bench();
  if (!a->side.has_field(field)) field.clear();
  for (const ShownSide* shown : {a.get(), b.get()})
    if (shown) tell_side(*shown);
  if (had_b && !b) tell(text({{"kind", "end_compare"}}));
  tell_state();
}

ShownSide& Session::Impl::next() {
  // An unstable side stays where it is, and the other continues.
  if (!b || b->side.is_blown_up()) return *a;
  if (a->side.is_blown_up()) return *b;
  if (a->side.iteration() >= 0) return *a;
  if (b->side.iteration() >= 0) return *b;
  const double h = std::min(a->side.simulation().options().h, b->side.simulation().options().h);
  return b->side.time() < a->side.time() - kSameTime * h ? *b : *a;
}

// ---------------------------------------------------------------- steps

StopToken Session::Impl::stop_token() {
  return StopToken([this] { return stop.load(std::memory_order_relaxed); });
}

void Session::Impl::note_progress(Progress progress) {
  if (progress == Progress::interrupted) return;
  ++version;
  if (progress == Progress::blown_up && next().side.is_blown_up()) playing = false;
}

void Session::Impl::take_turn() {
  if (replaying) repeat_due_events();
  ShownSide& shown = next();
  Progress progress = Progress::interrupted;
  try {
    progress = shown.side.step(stop_token());
  } catch (...) {
    shown.side.rewind(shown.side.steps_taken());
    throw;
  }
  note_progress(progress);
}

void Session::Impl::advance(const std::function<bool()>& is_next_due) {
  news.clear();
  stop = false;
  if (!playing) return;
  try {
    do {
      take_turn();
      if (replaying && is_replay_done()) {
        replaying.reset();
        playing = false;
      }
    } while (playing && is_next_due && is_next_due());
  } catch (const std::exception& e) {
    playing = false;
    replaying.reset();
    tell(refusal(nullptr, e.what()));
  }
  tell_state();
}

// ---------------------------------------------------------------- the class

Session::Session(const std::filesystem::path& scene, const std::vector<std::string>& overrides, SessionOptions options)
    : impl_(std::make_unique<Impl>(std::move(options))) {
  impl_->install(impl_->loaded("a", scene, overrides), nullptr, std::nullopt);
  impl_->news.clear();
}
Session::~Session() = default;

Messages Session::greeting(Role role) const {
  Messages messages = {hello(impl_->options.lessons, role)};
  Messages pending = std::move(impl_->news);
  impl_->news.clear();
  for (const ShownSide* shown : {impl_->a.get(), impl_->b.get()})
    if (shown) impl_->tell_side(*shown);
  impl_->tell_capture();
  impl_->tell_state();
  for (Message& message : impl_->news) messages.push_back(std::move(message));
  impl_->news = std::move(pending);
  return messages;
}

Answer Session::handle(std::string_view text, Role role) { return impl_->handle(text, role); }

std::optional<FitTask> Session::take_fit() { return std::exchange(impl_->capture.wanted, std::nullopt); }
bool Session::wants_fit() const { return impl_->capture.is_fitting; }

Messages Session::note_fit(const FitNews& news) {
  impl_->news.clear();
  impl_->note_fit(news);
  return std::move(impl_->news);
}

bool Session::is_playing() const { return impl_->playing; }
double Session::speed() const { return impl_->speed; }
double Session::time() const { return impl_->next().side.time(); }
void Session::note_rate(double rate) { impl_->rate = rate; }

Messages Session::advance(const std::function<bool()>& is_next_due) {
  impl_->advance(is_next_due);
  return std::move(impl_->news);
}

Messages Session::pictures() const {
  Messages messages;
  for (const ShownSide* shown : {impl_->a.get(), impl_->b.get()}) {
    if (!shown) continue;
    const Side& side = shown->side;
    const int step = side.steps_taken() + (side.iteration() >= 0 ? 1 : 0);
    const bool shows = side.has_field(impl_->field);
    messages.push_back({true, impl_->encoder.encode({shown->number(), shown->generation},
                                                    {step, side.iteration(), side.time(), shows ? impl_->field : ""},
                                                    side.view(), shown->surface)});
  }
  return messages;
}

long Session::picture_version() const { return impl_->version; }

void Session::interrupt() { impl_->stop = true; }

}  // namespace aspic::viewer
