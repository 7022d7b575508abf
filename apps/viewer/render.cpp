#include "viewer/render.h"

#include <fmt/format.h>
#include <unistd.h>

#include <optional>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "io/child_process.h"
#include "io/external_program.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

std::string percent_coded(std::string_view text) {
  std::string coded;
  for (const char c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    coded += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return coded;
}

std::string query(const RenderOptions& options) {
  std::string text = fmt::format("&render=1&width={}&height={}&view={}&color={}&wires={}&dark={}&every={}",
                                 options.width, options.height, percent_coded(options.view),
                                 percent_coded(options.color), int{options.wires}, int{options.dark}, options.every);
  text += fmt::format("&preset={}&transparent={}&thickness={}&samples={}", options.preset, int{options.transparent},
                      int{options.thickness}, options.samples);
  if (options.step >= 0) text += fmt::format("&step={}", options.step);
  return text;
}

// Players read high-definition video by BT.709, ffmpeg writes BT.601 by default.
constexpr const char* kColors = "scale=out_color_matrix=bt709:out_range=tv";

// A GIF has one palette of 256 colors for all pictures, and at most 50 pictures per second.
std::vector<std::string> coder_of(const std::string& extension) {
  if (extension == ".gif")
    return {"-vf",
            "fps=fps='min(50,source_fps)',split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=bayer:bayer_scale=4:"
            "diff_mode=rectangle"};
  std::vector<std::string> words = {"-vf",   kColors,      "-colorspace", "bt709", "-color_primaries",
                                    "bt709", "-color_trc", "bt709",       "-c:v"};
  // VP9 holds transparency.
  const std::vector<std::string> coder =
      extension == ".webm" ? std::vector<std::string>{"libvpx-vp9", "-b:v",     "0",         "-crf", "24",
                                                      "-row-mt",    "1",        "-cpu-used", "3",    "-auto-alt-ref",
                                                      "0",          "-pix_fmt", "yuva420p"}
                           : std::vector<std::string>{"libx264",   "-crf",       "18",       "-preset", "medium",
                                                      "-movflags", "+faststart", "-pix_fmt", "yuv420p"};
  words.insert(words.end(), coder.begin(), coder.end());
  return words;
}

}  // namespace

RenderEnd render(const std::string& page, const RenderOptions& options, const Pictures& pictures,
                 const StopToken& stop) {
  return draw_in_browser({.page = page, .query = query(options)}, pictures, stop);
}

struct VideoFile::Impl {
  Impl(fs::path target, double frames_per_second)
      : path(std::move(target)),
        unfinished(path.parent_path() / fmt::format(".aspic-{}{}", ::getpid(), path.extension().string())) {
    ffmpeg.emplace(Launch{.command = command(frames_per_second),
                          .messages = folder.path() / "messages",
                          .has_input = true,
                          .lifetime = Lifetime::own_group});
  }
  ~Impl() {
    ffmpeg.reset();  // ends before its file is removed
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
    const std::vector<std::string> coder = coder_of(path.extension().string());
    words.insert(words.end(), coder.begin(), coder.end());
    words.push_back("file:" + unfinished.string());
    return words;
  }

  [[noreturn]] void fail() {
    ffmpeg->close_input();
    ffmpeg->wait();
    throw InvalidInput(path.string() + ": ffmpeg failed: " + ffmpeg->message());
  }

  fs::path path, unfinished;
  TemporaryFolder folder;
  std::optional<ChildProcess> ffmpeg;
};

bool VideoFile::is_video(const fs::path& path) {
  return path.extension() == ".mp4" || path.extension() == ".webm" || path.extension() == ".gif";
}

VideoFile::VideoFile(fs::path path, double frames_per_second) {
  if (!is_video(path)) throw InvalidInput(path.string() + ": a video is .mp4, .webm or .gif");
  impl_ = std::make_unique<Impl>(std::move(path), frames_per_second);
}

VideoFile::~VideoFile() = default;

void VideoFile::add(std::string_view png) {
  if (!impl_->ffmpeg->write(png)) impl_->fail();
}

void VideoFile::finish() {
  impl_->ffmpeg->close_input();
  if (impl_->ffmpeg->wait() != 0) impl_->fail();
  std::error_code error;
  fs::rename(impl_->unfinished, impl_->path, error);
  if (error) throw InvalidInput(impl_->path.string() + ": cannot be written: " + error.message());
}

}  // namespace aspic::viewer
