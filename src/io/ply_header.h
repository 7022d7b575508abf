// Header of a PLY file: its elements and their properties.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };
enum class PlyScalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

size_t size(PlyScalar scalar);  // [bytes]

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::float32;  // type of the values
  bool is_list = false;
  PlyScalar count_type = PlyScalar::uint8;  // type of a list's length
};

struct PlyElement {
  std::string name;
  int64_t count = 0;  // as stated in the file; not trusted
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  size_t end = 0;  // start of the elements [bytes]
};

PlyHeader parse_ply_header(const std::string& file, std::string_view contents);

}  // namespace aspic
