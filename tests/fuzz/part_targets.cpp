#include <string>

#include "io/base64.h"
#include "io/gzip.h"
#include "io/xml.h"
#include "targets.h"

namespace aspic::fuzz {
namespace {

constexpr size_t kLimit = 1 << 20;  // limit after decompression [bytes]

int depth_of(const XmlElement& element) {
  int deepest = 0;
  for (const XmlElement& child : element.children) deepest = std::max(deepest, depth_of(child));
  return deepest + 1;
}

}  // namespace

void gzip(std::string_view bytes) {
  require(gunzipped(gzipped(bytes), bytes.size()) == bytes, "compressed data decompress to the original");
  require(gunzipped(bytes, kLimit).size() <= kLimit, "decompressed data are within the limit");
}

void base64(std::string_view bytes) {
  std::string text, back;
  append_base64(bytes, text);
  std::string_view rest = text;
  require(decode_base64(rest, bytes.size(), back) && back == bytes && rest.empty(),
          "encoded data decode to the original");
  for (std::string_view left = bytes; !left.empty();) {
    const size_t before = left.size();
    std::string decoded;
    if (!decode_base64(left, 1 + bytes.size() / 3, decoded)) break;
    require(left.size() < before || decoded.empty(), "decoding consumes its input");
    if (left.size() == before) break;
  }
}

void xml(std::string_view bytes) {
  require(depth_of(parse_xml(bytes, "file", "AppendedData")) <= 32, "elements nest at most 32 deep");
}

}  // namespace aspic::fuzz
