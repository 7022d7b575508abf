// Interface of the engine for web/src/worker.ts: a session whose messages go to the page by postMessage().
#include <emscripten.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include "aspic/lecture/lessons.h"
#include "base/parallel.h"
#include "engine/self_test.h"
#include "viewer/offered_scenes.h"
#include "viewer/pacing.h"
#include "viewer/scene_json.h"

EM_JS(void, post_text, (const char* text, int size), { Module.post(UTF8ToString(text, size)); });
EM_JS(void, post_bytes, (const char* bytes, int size), { Module.post(HEAPU8.slice(bytes, bytes + size).buffer); });

namespace aspic::engine {
namespace {

using namespace viewer;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr size_t kTimelineBytes = size_t{64} << 20;
constexpr double kMostTets = 60'000;
const char kScenes[] = "/scenes";  // a folder in memory

void post(const Message& message) {
  const int size = static_cast<int>(message.bytes.size());
  (message.is_binary ? post_bytes : post_text)(message.bytes.data(), size);
}

void post(const Messages& messages) {
  for (const Message& message : messages) post(message);
}

void post_json(const Json& json) { post(Message{false, json.dump(-1, ' ', false, Json::error_handler_t::replace)}); }

SessionOptions options() {
  return {.lessons = cli::lecture::lessons("/meshes"),
          .gallery =
              [] {
                return Gallery{scenes_below(kScenes), {}};
              },
          .timeline_bytes = kTimelineBytes,
          .most_tets = kMostTets,
          .announce =
              [](const std::string& what) {
                post_json({{"kind", "busy"}, {"what", what}});
              }};
}

struct Engine {
  explicit Engine(const std::string& scene) : session(scene, {}, options()), paced(session) {}

  // A fit ends before the next message is read: there is one thread.
  void serve_fit() {
    const std::optional<FitTask> task = session.take_fit();
    if (!task) return;
    run_fit(*task, [&](FitNews news) {
      news.task = task->number;
      post(session.note_fit(news));
    });
  }

  Session session;
  PacedSession paced;
};

std::unique_ptr<Engine> engine;

}  // namespace
}  // namespace aspic::engine

using namespace aspic::engine;

extern "C" {

// Opens a session of the scene and posts its greeting. Returns false after posting {"kind": "ended", "why": ...}.
EMSCRIPTEN_KEEPALIVE bool engine_open(const char* scene) {
  aspic::set_thread_count(1);
  try {
    if (const std::string wrong = self_test(); !wrong.empty())
      throw std::runtime_error("this engine is miscompiled: " + wrong + " has a wrong result");
    engine = std::make_unique<Engine>(scene);
    post(engine->session.greeting(Role::steers));
    return true;
  } catch (const std::exception& e) {
    post_json({{"kind", "ended"}, {"why", e.what()}});
    return false;
  }
}

EMSCRIPTEN_KEEPALIVE void engine_handle(const char* text) {
  const Answer answer = engine->session.handle(text, Role::steers);
  post(answer.to_all);
  post(answer.to_sender);
  engine->serve_fit();
}

// Takes the steps that are due and posts pictures if requested.
// Returns whether it posted pictures.
EMSCRIPTEN_KEEPALIVE bool engine_run(bool wants_pictures) {
  PacedSession& paced = engine->paced;
  if (paced.is_step_due()) post(paced.advance([] { return false; }));
  const bool shows = wants_pictures && paced.are_pictures_due();
  if (shows) post(paced.pictures());
  return shows;
}

// Returns the time until the next call of engine_run() [ms]; -1: none before the next message.
EMSCRIPTEN_KEEPALIVE double engine_pause(bool wants_pictures) {
  const auto next = engine->paced.next(wants_pictures);
  return next ? std::max(0.0, Milliseconds(*next - Pacing::Clock::now()).count()) : -1;
}

}  // extern "C"
