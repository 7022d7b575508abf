#include "viewer/page.h"

#include "base/check.h"
#include "io/gzip.h"

// The assembler embeds the file ASPIC_PAGE of the build.
asm(".section .rodata\n"
    ".balign 16\n"
    "aspic_page_begin:\n"
    ".incbin \"" ASPIC_PAGE
    "\"\n"
    "aspic_page_end:\n"
    ".previous\n"
    ".globl aspic_page_begin, aspic_page_end\n"
    ".hidden aspic_page_begin, aspic_page_end\n");
extern "C" const char aspic_page_begin[], aspic_page_end[];

namespace aspic::viewer {
namespace {

constexpr size_t kLargestPage = size_t{64} << 20;  // [bytes]
constexpr std::string_view kPlaceOfRecording = "<!-- recording -->";

}  // namespace

const std::string& page() {
  static const std::string html = gunzipped({aspic_page_begin, aspic_page_end}, kLargestPage);
  return html;
}

std::string page_with(std::string_view html) {
  std::string filled = page();
  const size_t place = filled.find(kPlaceOfRecording);
  ASPIC_CHECK(place != std::string::npos);
  return filled.replace(place, kPlaceOfRecording.size(), html);
}

}  // namespace aspic::viewer
