// Small grids in every encoding of VTK.
#include <zlib.h>

#include "io/base64.h"
#include "io/number_text.h"
#include "seeds.h"

namespace aspic::fuzz {
namespace {

enum class Stored { ascii, inline_base64, appended_base64, appended_raw };

// Bytes with the header of VTK: their size, or number of blocks, block size, last size, compressed sizes.
std::string framed(const std::string& bytes, bool compressed) {
  std::string framed_bytes;
  if (!compressed) {
    append_bytes(framed_bytes, static_cast<uint32_t>(bytes.size()));
    return framed_bytes + bytes;
  }
  std::string packed(compressBound(bytes.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  for (const size_t number : {size_t{1}, bytes.size(), size_t{0}, size_t{size}})
    append_bytes(framed_bytes, static_cast<uint32_t>(number));
  return framed_bytes + packed.substr(0, size);
}

class Grid {
 public:
  Grid(Stored stored, bool compressed) : stored_(stored), compressed_(compressed) {}

  template <class Number>
  std::string array(const std::string& type, const std::string& name, int components, std::vector<Number> numbers) {
    std::string tag = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                      std::to_string(components) + "\" NumberOfTuples=\"" +
                      std::to_string(numbers.size() / static_cast<size_t>(components)) + "\" format=\"";
    if (stored_ == Stored::ascii) {
      tag += "ascii\">";
      for (const Number x : numbers) tag += ' ' + std::to_string(x);
      return tag + "</DataArray>\n";
    }
    std::string bytes;
    for (const Number x : numbers) append_bytes(bytes, x);
    bytes = framed(bytes, compressed_);
    if (stored_ == Stored::appended_raw) {
      tag += "appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
      appended_ += bytes;
      return tag;
    }
    std::string text;
    append_base64(bytes, text);
    if (stored_ == Stored::inline_base64) return tag + "binary\">" + text + "</DataArray>\n";
    tag += "appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
    appended_ += text;
    return tag;
  }

  std::string text() {
    std::string body =
        "<Points>" +
        array("Float64", "Points", 3, std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, .5, .25, 1}) +
        "</Points>\n<Cells>" + array("Int64", "connectivity", 1, std::vector<int64_t>{0, 1, 2, 3, 1, 2, 3, 4}) +
        array("Int32", "offsets", 1, std::vector<int32_t>{4, 8}) +
        array("UInt8", "types", 1, std::vector<uint8_t>{10, 10}) + "</Cells>\n<PointData>" +
        array("Float32", "u", 3, std::vector<float>(15, 1.5f)) + "</PointData>\n<CellData>" +
        array("Int32", "region", 1, std::vector<int32_t>{7, -2}) + "</CellData>";
    const std::string fields =
        "<FieldData>" + array("Float64", "TimeValue", 1, std::vector<double>{.5}) + "</FieldData>";
    std::string file =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt32\"";
    if (compressed_) file += " compressor=\"vtkZLibDataCompressor\"";
    file += ">\n<UnstructuredGrid>" + fields + "<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n" + body +
            "</Piece></UnstructuredGrid>";
    if (!appended_.empty())
      file += std::string("<AppendedData encoding=\"") + (stored_ == Stored::appended_raw ? "raw" : "base64") + "\">_" +
              appended_ + "</AppendedData>";
    return file + "</VTKFile>\n";
  }

 private:
  Stored stored_;
  bool compressed_;
  std::string appended_;
};

}  // namespace

std::vector<Seed> vtu_seeds() {
  std::vector<Seed> seeds = {{"vtu", "ascii", Grid(Stored::ascii, false).text()}};
  for (const bool compressed : {false, true}) {
    const std::string end = compressed ? "_zlib" : "";
    seeds.push_back({"vtu", "inline" + end, Grid(Stored::inline_base64, compressed).text()});
    seeds.push_back({"vtu", "appended_base64" + end, Grid(Stored::appended_base64, compressed).text()});
    seeds.push_back({"vtu", "appended_raw" + end, Grid(Stored::appended_raw, compressed).text()});
  }
  return seeds;
}

}  // namespace aspic::fuzz
