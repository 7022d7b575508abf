// The numbers of a VTK <DataArray>, in any of the ways in which VTK stores them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/xml.h"

namespace aspic {

// What the head of the file says about all its arrays.
struct VtkFile {
  std::string name;                  // for messages
  bool swapped = false;              // byte order differs from this machine's
  size_t header_size = 4;            // bytes of the counts in front of binary data: 4 or 8
  bool compressed = false;           // vtkZLibDataCompressor
  std::string_view appended;         // after the underscore of <AppendedData>
  mutable size_t appended_left = 0;  // [bytes] of it that no array has taken yet
  bool appended_base64 = false;
  bool has_appended = false;
};

// Reads the attributes of <VTKFile> and its <AppendedData>. Throws InvalidInput when it is no grid of `type` or is
// stored in a way that is not supported.
VtkFile vtk_file(const XmlElement& root, std::string_view type, std::string name);

// Exactly `count` numbers; nothing is allocated that the file is too short to hold. Throws InvalidInput naming file,
// line and array.
std::vector<double> read_reals(const VtkFile& file, const XmlElement& array, size_t count);
std::vector<int64_t> read_integers(const VtkFile& file, const XmlElement& array, size_t count);

[[noreturn]] void fail_at(const VtkFile& file, const XmlElement& element, const std::string& what);

// An attribute as a number in [0, limit]; `fallback` when it is absent.
int64_t count_attribute(const VtkFile& file, const XmlElement& element, std::string_view name, int64_t fallback,
                        int64_t limit);

}  // namespace aspic
