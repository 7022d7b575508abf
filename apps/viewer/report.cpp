#include "viewer/report.h"

#include <fmt/format.h>

#include "base/error.h"
#include "viewer/page.h"
#include "viewer/recording.h"

namespace aspic::viewer {
namespace {

constexpr std::string_view kRecordingBegin = "<script type=\"application/json\" id=\"recording\">\"",
                           kRecordingEnd = "\"</script>";

}  // namespace

Report make_report(const std::filesystem::path& run, const Scene& scene, const ReportOptions& options) {
  const size_t page_alone = page_with("").size() + kRecordingBegin.size() + kRecordingEnd.size();
  if (page_alone >= options.max_bytes)
    throw InvalidInput(fmt::format("--max-size: the page alone takes {:.1f} MB; allow more", page_alone / 1e6));
  const RecordedRun recording = record(run, scene, {.max_bytes = options.max_bytes - page_alone});
  std::string html = page_with(fmt::format("{}{}{}", kRecordingBegin, recording.text, kRecordingEnd));
  return {std::move(html), recording.frames_of_run, recording.frames, recording.note};
}

}  // namespace aspic::viewer
