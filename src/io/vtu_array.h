// Numbers of a VTK <DataArray> in any encoding of VTK.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/xml.h"

namespace aspic {

// Properties that the header of the file gives for all its arrays.
struct VtkFile {
  std::string name;                  // name in messages
  bool swapped = false;              // byte order differs from this machine
  size_t header_size = 4;            // size of the counts before binary data: 4 or 8 bytes
  bool compressed = false;           // vtkZLibDataCompressor
  std::string_view appended;         // data after the underscore of <AppendedData>
  mutable size_t appended_left = 0;  // bytes of it that no array has used yet
  bool appended_base64 = false;
  bool has_appended = false;
};

// Reads the attributes of <VTKFile> and its <AppendedData>. Throws InvalidInput if the grid has not the given `type` or
// uses an unsupported encoding.
VtkFile vtk_file(const XmlElement& root, std::string_view type, std::string name);

// Reads exactly `count` numbers. Allocates no more than the file can fill. Throws InvalidInput with file, line and
// array.
std::vector<double> read_reals(const VtkFile& file, const XmlElement& array, size_t count);
std::vector<int64_t> read_integers(const VtkFile& file, const XmlElement& array, size_t count);

[[noreturn]] void fail_at(const VtkFile& file, const XmlElement& element, const std::string& what);

// Reads an attribute as a number in [0, limit]; `fallback` if it is absent.
int64_t count_attribute(const VtkFile& file, const XmlElement& element, std::string_view name, int64_t fallback,
                        int64_t limit);

}  // namespace aspic
