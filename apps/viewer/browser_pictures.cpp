#include "viewer/browser_pictures.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <vector>

#include "base/error.h"
#include "base/number_chars.h"
#include "io/child_process.h"
#include "io/external_program.h"
#include "viewer/server.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLongestSilence(180);
constexpr std::chrono::milliseconds kPeriod(50);  // interval of checks of browser and stop token

fs::path find_browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    try {
      return find_program(name, {}, "");
    } catch (const InvalidInput&) {
    }
  }
  throw InvalidInput(
      "neither chromium, chromium-browser nor google-chrome is on the PATH; the pictures are drawn by one of them "
      "(Debian: apt-get install chromium)");
}

// Command of a headless browser without GPU and network services. It writes only into `folder`.
std::vector<std::string> browser_command(const fs::path& folder, const std::string& address) {
  const fs::path browser = find_browser(), env = find_program("env", {}, "");
  std::vector<std::string> command = {env.string(),
                                      "TMPDIR=" + folder.string(),
                                      browser.string(),
                                      "--headless=new",
                                      "--user-data-dir=" + (folder / "profile").string(),
                                      "--use-gl=angle",
                                      "--use-angle=swiftshader",
                                      "--enable-unsafe-swiftshader",
                                      "--force-device-scale-factor=1",
                                      "--hide-scrollbars",
                                      "--mute-audio",
                                      "--disable-background-networking",
                                      "--disable-background-timer-throttling",
                                      "--disable-renderer-backgrounding",
                                      "--disable-component-update",
                                      "--disable-default-apps",
                                      "--disable-dev-shm-usage",
                                      "--disable-extensions",
                                      "--disable-sync",
                                      "--no-default-browser-check",
                                      "--no-first-run"};
  if (::geteuid() == 0) command.emplace_back("--no-sandbox");  // the sandbox does not work for root
  command.push_back(address);
  return command;
}

// Passes the pictures of the page from the server's thread to the waiting thread.
class Arrivals {
 public:
  Arrivals(const PageOfPictures& page, const Pictures& pictures) : page_(page), pictures_(pictures) {}

  std::string receive(const std::string& path, std::string_view body) {
    const std::lock_guard lock(mutex_);
    last_ = Clock::now();
    if (path == "/part" && page_.part) return page_.part(number(body));
    if (path == "/count") {
      count_ = number(body);
    } else if (path == "/frame") {
      add(body);
    } else if (path == "/end") {
      is_whole_ = true;
    } else {
      failure_ = path == "/failed" ? std::string(body) : "the page sent an unknown message";
    }
    changed_.notify_all();
    return "";
  }

  // Returns whether all pictures have arrived. Rethrows errors of the page.
  bool wait(std::chrono::milliseconds period) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, period);
    if (thrown_) std::rethrow_exception(thrown_);
    if (!failure_.empty()) throw InvalidInput(failure_);
    return is_whole_;
  }

  bool is_silent() {
    const std::lock_guard lock(mutex_);
    return Clock::now() - last_ > kLongestSilence;
  }

 private:
  static int number(std::string_view text) {
    int value = 0;
    from_chars(text.data(), text.data() + text.size(), value);
    return value;
  }

  void add(std::string_view png) {
    if (thrown_) return;
    try {
      pictures_(frames_++, count_, png);
    } catch (...) {
      thrown_ = std::current_exception();
    }
  }

  const PageOfPictures& page_;
  const Pictures& pictures_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Clock::time_point last_ = Clock::now();
  int frames_ = 0, count_ = 0;
  bool is_whole_ = false;
  std::string failure_;
  std::exception_ptr thrown_;
};

}  // namespace

RenderEnd draw_in_browser(const PageOfPictures& page, const Pictures& pictures, const StopToken& stop) {
  Arrivals arrivals(page, pictures);
  const TemporaryFolder folder;
  Server server({.page = page.page,
                 .post = [&](const std::string& path, std::string_view body) { return arrivals.receive(path, body); }});
  ChildProcess browser({.command = browser_command(folder.path(), server.address() + page.query),
                        .messages = folder.path() / "messages",
                        .lifetime = Lifetime::own_group});
  while (!arrivals.wait(kPeriod)) {
    if (stop.stopped()) return RenderEnd::interrupted;
    if (!browser.is_running())
      throw InvalidInput("the browser ended before the pictures were drawn: " + browser.message());
    if (arrivals.is_silent())
      throw InvalidInput(fmt::format("the browser sent nothing for {} s; smaller pictures are drawn faster: {}",
                                     kLongestSilence.count(), browser.message()));
  }
  return RenderEnd::done;
}

}  // namespace aspic::viewer
