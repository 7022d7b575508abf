// Interface of the engine for web/src/worker.ts: a session whose messages go to the page by postMessage().
#include <emscripten.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include "aspic/lecture/lessons.h"
#include "aspic/lecture/result_json.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "engine/self_test.h"
#include "viewer/offered_scenes.h"
#include "viewer/pacing.h"
#include "viewer/scene_json.h"

EM_JS(void, post_text, (const char* text, int size), { Module.post(UTF8ToString(text, size)); });
EM_JS(bool, is_stop_requested, (), { return Module.isStopRequested(); });
EM_JS(int, worker_count, (), { return Module.workers || 0; });
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
          .wants_stop = [] { return is_stop_requested(); },
          .announce =
              [](const std::string& what) {
                post_json({{"kind", "busy"}, {"what", what}});
              }};
}

struct Engine {
  explicit Engine(const std::string& scene) : session(scene, {}, options()), paced(session) {}

  Session session;
  PacedSession paced;
};

std::unique_ptr<Engine> engine;

// Throws std::runtime_error.
void prepare() {
  set_thread_count(1 + worker_count());
  if (const std::string wrong = self_test(); !wrong.empty())
    throw std::runtime_error("this engine is miscompiled: " + wrong + " has a wrong result");
}

// Returns whether there was no exception; otherwise posts {"kind": "ended", "why": ...}.
template <class Work>
bool carry_out(Work work) {
  try {
    prepare();
    work();
    return true;
  } catch (const std::exception& e) {
    post_json({{"kind", "ended"}, {"why", e.what()}});
    return false;
  }
}

cli::lecture::Result judge(const std::string& lesson) {
  namespace lecture = cli::lecture;
  for (const lecture::Demonstration& demonstration : lecture::demonstrations()) {
    if (!lesson.starts_with(demonstration.key)) continue;
    Stopwatch stopwatch;
    lecture::Sheet sheet("/lecture", lecture::Pictures::none);
    lecture::run_demonstration(demonstration, lecture::Stage("", "/meshes"), sheet);
    return {&demonstration, std::move(sheet), stopwatch.lap()};
  }
  throw InvalidInput("no lesson '" + lesson + "'");
}

}  // namespace
}  // namespace aspic::engine

using namespace aspic::engine;

extern "C" {

// Opens a session of the scene and posts its greeting.
EMSCRIPTEN_KEEPALIVE bool engine_open(const char* scene) {
  return carry_out([&] {
    engine = std::make_unique<Engine>(scene);
    post(engine->session.greeting(Role::steers));
  });
}

// Runs the demonstration of a lesson as `aspic lecture` does, and posts its measures.
EMSCRIPTEN_KEEPALIVE bool engine_judge(const char* lesson) {
  return carry_out([&] { post_json({{"kind", "judged"}, {"result", aspic::cli::lecture::to_json(judge(lesson))}}); });
}

EMSCRIPTEN_KEEPALIVE void engine_handle(const char* text) {
  const Answer answer = engine->session.handle(text, Role::steers);
  post(answer.to_all);
  post(answer.to_sender);
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
