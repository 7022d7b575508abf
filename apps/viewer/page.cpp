#include "viewer/page.h"

#include "base/check.h"
#include "io/gzip.h"

namespace aspic::viewer {
namespace {

constexpr size_t kLargestPage = size_t{64} << 20;  // [bytes]
constexpr char kPacked[] =
#include "page.inc"  // made with the page
    ;
constexpr std::string_view kPlaceOfRecording = "<!-- recording -->";

}  // namespace

const std::string& page() {
  static const std::string html = gunzipped({kPacked, sizeof kPacked - 1}, kLargestPage);
  return html;
}

std::string page_with(std::string_view html) {
  std::string filled = page();
  const size_t place = filled.find(kPlaceOfRecording);
  ASPIC_CHECK(place != std::string::npos);
  return filled.replace(place, kPlaceOfRecording.size(), html);
}

}  // namespace aspic::viewer
