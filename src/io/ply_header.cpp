#include "io/ply_header.h"

#include <array>
#include <utility>

#include "base/error.h"
#include "io/text_scanner.h"

namespace aspic {
namespace {

PlyScalar scalar_type(TextScanner& text) {
  constexpr std::pair<std::string_view, PlyScalar> kNames[] = {
      {"char", PlyScalar::int8},      {"int8", PlyScalar::int8},       {"uchar", PlyScalar::uint8},
      {"uint8", PlyScalar::uint8},    {"short", PlyScalar::int16},     {"int16", PlyScalar::int16},
      {"ushort", PlyScalar::uint16},  {"uint16", PlyScalar::uint16},   {"int", PlyScalar::int32},
      {"int32", PlyScalar::int32},    {"uint", PlyScalar::uint32},     {"uint32", PlyScalar::uint32},
      {"float", PlyScalar::float32},  {"float32", PlyScalar::float32}, {"double", PlyScalar::float64},
      {"float64", PlyScalar::float64}};
  const std::string_view word = text.word("the type of a property");
  std::vector<std::string> known;
  for (const auto& [name, type] : kNames) {
    if (name == word) return type;
    known.emplace_back(name);
  }
  text.fail("the type of a property is " + shown(word) + suggestion(word, known) + "; export the file again");
}

PlyFormat format(TextScanner& text) {
  const std::string_view word = text.word("the format");
  if (word == "ascii") return PlyFormat::ascii;
  if (word == "binary_little_endian") return PlyFormat::binary_little_endian;
  if (word == "binary_big_endian") return PlyFormat::binary_big_endian;
  text.fail("the format is " + shown(word) + "; it must be ascii, binary_little_endian or binary_big_endian");
}

PlyProperty property(TextScanner& text) {
  PlyProperty result;
  if (text.peek() == "list") {
    text.word("list");
    result.is_list = true;
    result.count_type = scalar_type(text);
    if (result.count_type >= PlyScalar::float32) text.fail("a list's length is not a whole number; use uchar or int");
  }
  result.type = scalar_type(text);
  result.name = text.word("the name of a property");
  return result;
}

PlyElement element(TextScanner& text) {
  PlyElement result;
  result.name = text.word("the name of an element");
  result.count = text.integer("the number of elements");
  if (result.count < 0)
    text.fail("the number of elements is " + std::to_string(result.count) + "; it must not be negative");
  return result;
}

}  // namespace

size_t size(PlyScalar scalar) {
  constexpr std::array<size_t, 8> kBytes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<size_t>(scalar)];
}

PlyHeader parse_ply_header(const std::string& file, std::string_view contents) {
  TextScanner text(file, contents, TextScanner::kNoComments);
  PlyHeader header;
  bool has_format = false;
  if (const auto magic = text.word("'ply'"); magic != "ply")
    text.fail("found " + shown(magic) + " where 'ply' should be; is this a PLY file?");
  for (;;) {
    text.skip_line();
    const std::string_view keyword = text.word("the end of the header");
    if (keyword == "end_header") break;
    if (keyword == "format") {
      header.format = format(text);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(element(text));
    } else if (keyword == "property") {
      if (header.elements.empty()) text.fail("a property comes before any element; export the file again");
      header.elements.back().properties.push_back(property(text));
    } else if (keyword != "comment" && keyword != "obj_info") {
      text.fail("unknown header line " + shown(keyword) +
                suggestion(keyword, {"format", "element", "property", "comment", "end_header"}) +
                "; is this a PLY file?");
    }
  }
  if (!has_format) text.fail("the header has no format; add 'format ascii 1.0'");
  text.skip_line();  // the binary part begins after this line break
  header.end = text.position();
  return header;
}

}  // namespace aspic
