// Pictures of a recorded run, drawn by the viewer's page in a browser without a window.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/stop_token.h"
#include "viewer/browser_pictures.h"

namespace aspic::viewer {

struct RenderOptions {
  int width = 1280, height = 720;  // [px]
  std::string view = "isometric";  // a name, or the direction "x,y,z" that the camera looks from
  std::string color = {};          // a field; empty: none
  bool wires = true, dark = false;
  int step = -1;     // one picture, of the frame nearest to that step; -1: of the whole run
  double every = 0;  // simulated time from picture to picture [s]; 0: one of each frame
};

// `page` is the viewer's page with the recording. Does and throws what draw_in_browser() does.
RenderEnd render(const std::string& page, const RenderOptions& options, const Pictures& pictures,
                 const StopToken& stop);

// Makes a video of PNG pictures of the same even size; the file appears as a whole at the end.
class VideoFile {
 public:
  // .mp4, .webm or .gif. Throws InvalidInput for another extension and when ffmpeg is missing.
  VideoFile(std::filesystem::path path, double frames_per_second);
  ~VideoFile();  // without finish(): no file
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  void add(std::string_view png);  // throws InvalidInput: ffmpeg gave up
  void finish();

  static bool is_video(const std::filesystem::path& path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic::viewer
