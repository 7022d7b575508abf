// `aspic render`: draws pictures and videos of a run without a display.
#include "viewer/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include "aspic/commands.h"
#include "aspic/interrupt.h"
#include "aspic/progress.h"
#include "aspic/sweep/outcome.h"
#include "base/error.h"
#include "base/number_chars.h"
#include "dynamics/model.h"
#include "io/atomic_file.h"
#include "results/run_directory.h"
#include "viewer/recording.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct RenderArguments {
  fs::path run, out;
  std::string size = "1280x720", view = "isometric", color, preset;
  double fps = 30, speed = 1;
  int step = -1, samples = 0;
  bool wires = true, thickness = false, dark = false, transparent = false, every_frame = false;
};

constexpr size_t kMaxBytes = 100'000'000;  // limit of the page, for browsers

class PictureCount : public StatusLine {
 public:
  PictureCount() : StatusLine(stdout) {}
  void show(int drawn, int count) {
    if (!terminal_ && (count == 1 || seconds() - shown_at_ < kLineInterval)) return;
    shown_at_ = seconds();
    if (drawn == 1) first_at_ = shown_at_;
    std::string text = fmt::format("{} of {} pictures", drawn, count);
    if (drawn > 1)
      text += fmt::format("  {} left", duration_text((shown_at_ - first_at_) / (drawn - 1) * (count - drawn)));
    draw(std::move(text));
  }
  void finish() { erase(); }

 private:
  double first_at_ = 0;  // end of the first picture, which includes the start of the browser [s]
};

viewer::RenderOptions render_options(const RenderArguments& arguments) {
  if (!std::isfinite(arguments.fps) || !std::isfinite(arguments.speed))
    throw InvalidInput("--fps and --speed must be finite numbers");
  viewer::RenderOptions options{.view = arguments.view,
                                .color = arguments.color,
                                .preset = arguments.preset,
                                .wires = arguments.wires,
                                .dark = arguments.dark || arguments.preset == "talk",
                                .transparent = arguments.transparent,
                                .thickness = arguments.thickness,
                                .samples = arguments.samples > 0 ? arguments.samples
                                           : arguments.step < 0  ? 8
                                                                 : 32,
                                .step = arguments.step};
  const char* end = arguments.size.data() + arguments.size.size();
  const auto [x, width_error] = from_chars(arguments.size.data(), end, options.width);
  const bool has_both = width_error == std::errc() && x != end && *x == 'x' &&
                        from_chars(x + 1, end, options.height).ptr == end && x + 1 != end;
  if (!has_both || std::min(options.width, options.height) < 16 || std::max(options.width, options.height) > 8192)
    throw InvalidInput(
        fmt::format("--size {}: write WIDTHxHEIGHT, each from 16 to 8192, such as 1280x720", arguments.size));
  return options;
}

// Destination of the pictures.
class Output {
 public:
  virtual ~Output() = default;
  virtual void add(int index, std::string_view png) = 0;
  virtual void finish(int count) = 0;
};

class OnePicture : public Output {
 public:
  explicit OnePicture(fs::path path) : path_(std::move(path)) {}
  void add(int, std::string_view png) override { write_file(path_, png); }
  void finish(int) override {}

 private:
  fs::path path_;
};

class Video : public Output {
 public:
  Video(const fs::path& path, double fps) : file_(path, fps) {}
  void add(int, std::string_view png) override { file_.add(png); }
  void finish(int) override { file_.finish(); }

 private:
  viewer::VideoFile file_;
};

class Folder : public Output {
 public:
  explicit Folder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) throw InvalidInput(fmt::format("{}: cannot be created: {}", path_.string(), error.message()));
  }
  void add(int index, std::string_view png) override { write_file(file(index), png); }
  // Removes frames of an earlier, longer rendering.
  void finish(int count) override {
    std::error_code none;
    while (fs::remove(file(count), none)) ++count;
  }

 private:
  fs::path file(int index) const { return path_ / fmt::format("frame_{:06}.png", index + 1); }
  fs::path path_;
};

bool is_picture(const fs::path& path) { return path.extension() == ".png"; }

std::unique_ptr<Output> open_output(const RenderArguments& arguments, const viewer::RenderOptions& options) {
  const fs::path& out = arguments.out;
  if (is_picture(out)) return std::make_unique<OnePicture>(out);
  if (viewer::VideoFile::is_video(out)) {
    if (options.transparent && out.extension() == ".mp4")
      throw InvalidInput(out.string() + ": MP4 has no transparency; write .webm, .gif or a folder of pictures");
    if (options.width % 2 || options.height % 2)
      throw InvalidInput(fmt::format("--size {}: a video needs even width and height", arguments.size));
    return std::make_unique<Video>(out, arguments.fps);
  }
  if (out.has_extension() && !fs::is_directory(out))
    throw InvalidInput(fmt::format("{}: must be .png, .mp4, .webm, .gif, or a folder such as frames/", out.string()));
  return std::make_unique<Folder>(out);
}

int render(const RenderArguments& arguments) {
  if (!fs::is_directory(arguments.run))
    throw InvalidInput(fmt::format("{}: is not the directory of a run", arguments.run.string()));
  if (arguments.out.empty()) throw InvalidInput("--out is required: a folder, .mp4, .webm, .gif, or with --step .png");
  viewer::RenderOptions options = render_options(arguments);
  if (is_picture(arguments.out) && options.step < 0)
    throw InvalidInput(
        fmt::format("{}: one picture needs --step; for the whole run: -o frames/", arguments.out.string()));
  const bool is_video = viewer::VideoFile::is_video(arguments.out);
  options.every = arguments.every_frame || !is_video ? 0 : arguments.speed / arguments.fps;
  if (const int last = options.step < 0 ? 0 : count_steps(arguments.run, options.step).last; options.step > last)
    throw InvalidInput(fmt::format("--step {}: the run has {} steps", options.step, last));

  const Scene scene = load_scene(scene_of_run(arguments.run));
  const std::vector<BodyRange>& bodies = scene.simulation.model().bodies;
  if (options.thickness && std::none_of(bodies.begin(), bodies.end(), [](const auto& body) { return body.is_sheet(); }))
    throw InvalidInput("--thickness: the run has no sheets");
  const viewer::RecordedRun report = viewer::make_report(arguments.run, scene, {.max_bytes = kMaxBytes});
  if (!report.note.empty()) fmt::print("note: {} of {} frames are drawn\n", report.frames, report.frames_of_run);
  const std::unique_ptr<Output> output = open_output(arguments, options);
  catch_interrupts();
  PictureCount progress;
  int drawn = 0;
  const auto take = [&](int index, int count, std::string_view png) {
    output->add(index, png);
    drawn = index + 1;
    progress.show(drawn, count);
  };
  const viewer::RenderEnd end =
      viewer::render(report.text, options, take, StopToken([] { return interrupt_signal() != 0; }));
  progress.finish();
  if (end == viewer::RenderEnd::interrupted) return exit_signal + interrupt_signal();
  output->finish(drawn);
  fmt::print("{}: {} {}\n", arguments.out.string(), drawn, drawn == 1 ? "picture" : "pictures");
  return exit_done;
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Draws a run as pictures or a video, without a display");
  command->footer(R"(
Examples:
  aspic render out/bunny -o bunny.mp4                          in real time; needs ffmpeg
  aspic render out/bunny -o slow.webm --speed 0.25 --color von_mises
  aspic render out/bunny -o frames/ --size 1920x1080           frame_000001.png, ... of every frame of the run
  aspic render out/bunny -o bunny.png --step 40 --view front --preset paper

Chromium draws them with the page of aspic view and aspic report, on the CPU if there is no graphics card.)");
  command->add_option("RUN", arguments->run, "Directory of a run")->required();
  command->add_option("-o,--out", arguments->out, "Folder, .mp4, .webm, .gif, or with --step .png; required");
  command->add_option("--size", arguments->size, "Width and height in pixels, 1280x720 by default");
  command->add_option(
      "--view", arguments->view,
      "View: front, back, left, right, top, bottom, isometric, or a direction from the scene, \"1,2,0.5\"");
  command->add_option("--color,--colour", arguments->color, "Field for colors, such as von_mises or displacement");
  command->add_option("--fps", arguments->fps, "Pictures per second of a video, 30 by default")
      ->check(CLI::Range(1.0, 240.0));
  command->add_option("--speed", arguments->speed, "Simulated seconds per second of a video, 1 by default")
      ->check(CLI::Range(1e-9, 1e9));
  command->add_flag("--every-frame", arguments->every_frame, "Video with one picture per frame of the run");
  command->add_option("--step", arguments->step, "Draw one picture, of the frame nearest to this step")
      ->check(CLI::Range(0, 1000000000));
  command
      ->add_option(
          "--preset", arguments->preset,
          "paper: white, orthographic, with a scale bar; talk: dark, with large text; plain: no texts; tissue: "
          "plain, as skin; all without wires")
      ->check(CLI::IsMember({"paper", "talk", "plain", "tissue"}));
  command->add_flag("--wires,!--no-wires", arguments->wires, "Draw edges of the mesh, on without a preset");
  command->add_flag("--thickness", arguments->thickness, "Draw sheets with their thickness");
  command->add_flag("--dark", arguments->dark, "Use a dark background");
  command->add_flag("--transparent", arguments->transparent, "Use no background and no floor");
  command
      ->add_option("--samples", arguments->samples,
                   "Directions of light per picture, 32 for one picture, 8 for more by default; 1: sharp shadows")
      ->check(CLI::Range(1, 256));
  command->callback([arguments, command, &action] {
    if (command->count("--wires") == 0) arguments->wires = arguments->preset.empty();
    action = [arguments] { return render(*arguments); };
  });
}

}  // namespace aspic::cli
