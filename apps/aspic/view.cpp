// `aspic view`: interactive session in the browser.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "aspic/commands.h"
#include "aspic/gallery.h"
#include "aspic/interrupt.h"
#include "aspic/lecture/lessons.h"
#include "base/error.h"
#include "base/parallel.h"
#include "io/child_process.h"
#include "io/external_program.h"
#include "results/run_directory.h"
#include "viewer/page.h"
#include "viewer/recording.h"
#include "viewer/server.h"
#include "viewer/session.h"
#ifdef ASPIC_HAS_BENCH
#include "bench/bench.h"
#endif

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;
using viewer::Role;
using viewer::Server;
using viewer::Session;

namespace fs = std::filesystem;

viewer::SessionExtension extension() {
#ifdef ASPIC_HAS_BENCH
  return bench::bench();
#else
  return {};
#endif
}

bool has_display() {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value && *value;
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

// Returns false if there is no display, or no program to open the address.
bool open_browser(const std::string& address) {
  if (!has_display()) return false;
  try {
    const fs::path opener = find_program("xdg-open", {}, "");
    const ChildProcess process({.command = {opener.string(), address}, .lifetime = Lifetime::detached});
    return true;
  } catch (const InvalidInput&) {
    return false;
  }
}

struct ViewArguments {
  fs::path input;
  std::vector<std::string> overrides;
  int port = 0, threads = 0;  // 0: any; all
  std::string embed;
  bool no_browser = false, play = false;
};

constexpr size_t kLargestRun = size_t{200} << 20;  // size limit of the page [bytes]; larger runs omit frames
constexpr std::chrono::milliseconds kSignalPeriod(20);
constexpr std::chrono::seconds kPatience(2);  // wait for a step in progress at the end

void print_scene(const Session& session) {
  for (const viewer::Message& message : session.greeting(Role::watches)) {
    if (message.is_binary) continue;
    const auto scene = nlohmann::json::parse(message.bytes);
    if (scene.value("kind", "") != "scene") continue;
    for (const auto& note : scene.at("notes")) fmt::print("note: {}\n", note.get<std::string>());
    fmt::print("{}: {} vertices, {} tets; {} threads\n", scene.at("name").get<std::string>(),
               scene.at("vertices").get<int>(), scene.at("tets").get<int>(), thread_count());
  }
}

void print_address(const Server& server, bool no_browser) {
  fmt::print("{}\n", server.address());
  const bool is_opened = !no_browser && open_browser(server.address());
  fmt::print("{}; Ctrl-C ends it\n", is_opened ? "opened in your browser" : "open this address in a browser");
  std::fflush(stdout);
}

void log_line(const std::string& line) { fmt::print(stderr, "{}\n", line); }

// Nothing needs to be stored, so an unfinished step is abandoned.
int serve_until_interrupted(Server& server) {
  while (!interrupt_signal()) {
    server.check();
    std::this_thread::sleep_for(kSignalPeriod);
  }
  if (!server.stop(kPatience)) {
    std::fflush(nullptr);
    std::_Exit(exit_done);
  }
  return exit_done;
}

int view_run(const ViewArguments& arguments) {
  if (!arguments.overrides.empty() || arguments.play)
    throw InvalidInput("--set and --play need a scene; a run has already been simulated");
  const viewer::RecordedRun report =
      viewer::make_report(arguments.input, load_scene(scene_of_run(arguments.input)), {.max_bytes = kLargestRun});
  if (!report.note.empty()) fmt::print("note: {}\n", report.note);
  fmt::print("{}: {} frames of a run\n", arguments.input.string(), report.frames);
  Server server({.port = arguments.port, .page = report.text, .embed = arguments.embed, .log = log_line});
  catch_interrupts();
  print_address(server, arguments.no_browser);
  return serve_until_interrupted(server);
}

int view_scene(const ViewArguments& arguments) {
  std::atomic<Server*> listener = nullptr;
  const auto announce = [&](const std::string& what) {
    if (Server* server = listener) return server->announce(what);
    if (!what.empty()) fmt::print("{} ...\n", what);
    std::fflush(stdout);
  };
  const RecentScenes recent(RecentScenes::default_file());
  Session session(arguments.input, arguments.overrides,
                  {.lessons = lecture::lessons(fs::path("out") / "lecture" / "meshes"),
                   .gallery =
                       [&] {
                         return viewer::Gallery{viewer::scenes_below(shipped_scenes()), recent.read()};
                       },
                   .note_loaded = [&](const fs::path& scene) { recent.note(scene); },
                   .announce = announce,
                   .extension = extension()});
  recent.note(arguments.input);
  print_scene(session);
  if (arguments.play) session.handle(R"({"do":"play"})", Role::steers);

  Server server(
      {.port = arguments.port, .page = viewer::page(), .session = &session, .embed = arguments.embed, .log = log_line});
  listener = &server;
  catch_interrupts();
  print_address(server, arguments.no_browser);
  return serve_until_interrupted(server);
}

int view(const ViewArguments& arguments) {
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  return fs::is_directory(arguments.input) ? view_run(arguments) : view_scene(arguments);
}

}  // namespace

void add_view(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* command = app.add_subcommand("view", "Shows a scene in the browser, live and interactive");
  command->footer(R"(
Examples:
  aspic view scenes/bunny.toml                    print an address, and open it if there is a display
  aspic view bunny.obj --play                     a closed surface, filled with tets; starts immediately
  aspic view beam.toml --set material.young=2e5   with other values; the page can change them live
  aspic view out/bunny                            a finished run, as recorded
  aspic view beam.toml --port 8080 --no-browser   on another machine; locally: ssh -L 8080:127.0.0.1:8080 HOST

The address works on this machine only and contains a token. Several pages can watch, one controls. Ctrl-C exits with 0.)");
  command->add_option("INPUT", arguments->input, "Scene (.toml), mesh, or directory of a run")->required();
  command->add_option("--set", arguments->overrides, "Override values: material.young=2e5; several may follow")
      ->allow_extra_args(false);
  command->add_option("--port", arguments->port, "Port to listen on; any free port by default")
      ->check(CLI::Range(1, 65535));
  command->add_option("--embed", arguments->embed, "Site that may show the page in a frame, such as a notebook server")
      ->type_name("ORIGIN");
  command->add_flag("--no-browser", arguments->no_browser, "Only print the address");
  command->add_flag("--play", arguments->play, "Start the simulation immediately");
  command->add_option("--threads", arguments->threads, "Threads; all cores by default; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  command->callback([arguments, &action] { action = [arguments] { return view(*arguments); }; });
}

}  // namespace aspic::cli
