// Pictures of a recorded run that the viewer's page draws in a headless browser.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/stop_token.h"
#include "viewer/browser_pictures.h"

namespace aspic::viewer {

struct RenderOptions {
  int width = 1280, height = 720;  // [px]
  std::string view = "isometric";  // a name, or the direction "x,y,z" to the camera
  std::string color = {};          // a field; empty: none
  std::string preset = {};         // "paper", "talk", or none
  bool wires = true, dark = false, transparent = false, thickness = false;
  int samples = 1;   // directions of light per picture; 1: a sun with sharp shadows
  int step = -1;     // one picture of the frame nearest to that step; -1: the whole run
  double every = 0;  // simulated time between pictures [s]; 0: one picture per frame
};

// `page`: the viewer's page with the recording. Calls draw_in_browser() and throws its errors.
RenderEnd render(const std::string& page, const RenderOptions& options, const Pictures& pictures,
                 const StopToken& stop);

// Encodes PNG pictures of the same even size as a video. finish() creates the complete file.
class VideoFile {
 public:
  // .mp4, .webm or .gif. Throws InvalidInput for another extension and when ffmpeg is missing.
  VideoFile(std::filesystem::path path, double frames_per_second);
  ~VideoFile();  // removes the file without finish()
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  void add(std::string_view png);  // throws InvalidInput if ffmpeg fails
  void finish();

  static bool is_video(const std::filesystem::path& path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic::viewer
