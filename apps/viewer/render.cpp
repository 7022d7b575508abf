#include "viewer/render.h"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "io/external_program.h"
#include "viewer/child_process.h"
#include "viewer/server.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLongestSilence(60);
constexpr std::chrono::milliseconds kPeriod(50);  // of looking at the browser and at who may stop it

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

// Without a graphics card, a window, or a word to anyone.
std::vector<std::string> browser_command(const fs::path& profile, const std::string& address) {
  std::vector<std::string> command = {find_browser().string(),
                                      "--headless=new",
                                      "--user-data-dir=" + profile.string(),
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
  if (::geteuid() == 0) command.emplace_back("--no-sandbox");  // the sandbox refuses to serve root
  command.push_back(address);
  return command;
}

std::string percent_coded(std::string_view text) {
  std::string coded;
  for (const char c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    coded += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return coded;
}

std::string query(const RenderOptions& options) {
  std::string text = fmt::format("&render=1&width={}&height={}&view={}&colour={}&wires={}&dark={}&every={}",
                                 options.width, options.height, percent_coded(options.view),
                                 percent_coded(options.colour), int{options.wires}, int{options.dark}, options.every);
  if (options.step >= 0) text += fmt::format("&step={}", options.step);
  return text;
}

// What the page has sent so far, told from the server's thread to the one that waits.
class Arrivals {
 public:
  explicit Arrivals(const Pictures& pictures) : pictures_(pictures) {}

  std::string receive(const std::string& path, std::string_view body) {
    const std::lock_guard lock(mutex_);
    last_ = Clock::now();
    if (path == "/count") {
      std::from_chars(body.data(), body.data() + body.size(), count_);
    } else if (path == "/frame") {
      add(body);
    } else if (path == "/end") {
      is_whole_ = true;
    } else {
      failure_ = path == "/failed" ? std::string(body) : "the page sent something unknown";
    }
    changed_.notify_all();
    return "";
  }

  // False: not yet. Throws what went wrong.
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
  void add(std::string_view png) {
    if (thrown_) return;
    try {
      pictures_(frames_++, count_, png);
    } catch (...) {
      thrown_ = std::current_exception();
    }
  }

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

RenderEnd render(const std::string& page, const RenderOptions& options, const Pictures& pictures,
                 const std::function<bool()>& go_on) {
  Arrivals arrivals(pictures);
  const TemporaryFolder profile;
  const fs::path messages = profile.path() / "messages";
  Server server({.page = page,
                 .post = [&](const std::string& path, std::string_view body) { return arrivals.receive(path, body); }});
  ChildProcess browser(browser_command(profile.path() / "profile", server.address() + query(options)), messages,
                       Input::none);
  while (!arrivals.wait(kPeriod)) {
    if (!go_on()) return RenderEnd::interrupted;
    if (!browser.is_running())
      throw InvalidInput("the browser ended before the pictures were drawn: " + browser.said());
    if (arrivals.is_silent())
      throw InvalidInput(fmt::format("the browser sent nothing for {} s; on a slow machine try a smaller --size: {}",
                                     kLongestSilence.count(), browser.said()));
  }
  return RenderEnd::done;
}

struct VideoFile::Impl {
  Impl(fs::path target, double frames_per_second)
      : path(std::move(target)),
        unfinished(path.parent_path() / fmt::format(".aspic-{}{}", ::getpid(), path.extension().string())) {
    ffmpeg.emplace(command(frames_per_second), folder.path() / "messages", Input::pipe);
  }
  ~Impl() {
    ffmpeg.reset();  // before its file goes
    std::error_code none;
    fs::remove(unfinished, none);
  }

  std::vector<std::string> command(double frames_per_second) const {
    std::vector<std::string> words = {
        find_program("ffmpeg", {}, "a video needs it (Debian: apt-get install ffmpeg); frames/ makes pictures instead")
            .string(),
        "-loglevel",
        "error",
        "-y",
        "-f",
        "image2pipe",
        "-framerate",
        fmt::format("{}", frames_per_second),
        "-c:v",
        "png",
        "-i",
        "-"};
    const std::vector<std::string> coder =
        path.extension() == ".webm"
            ? std::vector<std::string>{"-c:v", "libvpx-vp9", "-b:v", "0",         "-crf",
                                       "30",   "-row-mt",    "1",    "-cpu-used", "4"}
            : std::vector<std::string>{"-c:v", "libx264", "-crf", "18", "-preset", "medium", "-movflags", "+faststart"};
    words.insert(words.end(), coder.begin(), coder.end());
    words.insert(words.end(), {"-pix_fmt", "yuv420p", "file:" + unfinished.string()});
    return words;
  }

  [[noreturn]] void fail() {
    ffmpeg->close_input();
    ffmpeg->wait();
    throw InvalidInput(path.string() + ": ffmpeg failed: " + ffmpeg->said());
  }

  fs::path path, unfinished;
  TemporaryFolder folder;
  std::optional<ChildProcess> ffmpeg;
};

bool VideoFile::is_video(const fs::path& path) { return path.extension() == ".mp4" || path.extension() == ".webm"; }

VideoFile::VideoFile(fs::path path, double frames_per_second) {
  if (!is_video(path)) throw InvalidInput(path.string() + ": a video is .mp4 or .webm");
  impl_ = std::make_unique<Impl>(std::move(path), frames_per_second);
}

VideoFile::~VideoFile() = default;

void VideoFile::add(std::string_view png) {
  if (!impl_->ffmpeg->write(png)) impl_->fail();
}

void VideoFile::finish() {
  impl_->ffmpeg->close_input();
  if (!impl_->ffmpeg->wait()) impl_->fail();
  std::error_code error;
  fs::rename(impl_->unfinished, impl_->path, error);
  if (error) throw InvalidInput(impl_->path.string() + ": cannot be written: " + error.message());
}

}  // namespace aspic::viewer
