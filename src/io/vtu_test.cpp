#include "io/vtu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/base64.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using testing::HasSubstr;

class VtuFile : public FolderTest {
 protected:
  static Vtu read_text(const std::string& text) { return parse_vtu(text, "text.vtu"); }

  static std::string message(const std::string& text) {
    return message_of<InvalidInput>([&] { read_text(text); });
  }
};

// Two tets on five points; `array(type, name, components, numbers)` encodes the arrays.
template <class ArrayText>
std::string grid(const std::string& head, ArrayText array, const std::string& tail = "") {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" " + head +
         ">\n<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n<Points>" +
         array("Float64", "Points", 3, std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0.25, 1e-3}) +
         "</Points>\n<Cells>" + array("Int64", "connectivity", 1, std::vector<double>{0, 1, 2, 3, 1, 2, 3, 4}) +
         array("Int64", "offsets", 1, std::vector<double>{4, 8}) +
         array("UInt8", "types", 1, std::vector<double>{10, 10}) + "</Cells>\n<CellData>" +
         array("Int32", "region", 1, std::vector<double>{7, -2}) + "</CellData>" + "</Piece></UnstructuredGrid>" +
         tail + "</VTKFile>\n";
}

std::string array_tag(const std::string& type, const std::string& name, int components, const std::string& rest) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(components) +
         "\" " + rest;
}

std::string ascii(const std::string& type, const std::string& name, int components,
                  const std::vector<double>& numbers) {
  std::ostringstream text;
  for (const double x : numbers) text << x << "\n ";
  return array_tag(type, name, components, "format=\"ascii\">") + text.str() + "</DataArray>";
}

template <class Stored>
std::string stored(double number, bool swapped) {
  const auto value = static_cast<Stored>(number);
  std::string bytes(sizeof(Stored), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Stored));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string stored(const std::string& type, const std::vector<double>& numbers, bool swapped) {
  std::string bytes;
  for (const double x : numbers) {
    bytes += type == "Float64" ? stored<double>(x, swapped)
             : type == "Int64" ? stored<int64_t>(x, swapped)
             : type == "Int32" ? stored<int32_t>(x, swapped)
                               : stored<uint8_t>(x, swapped);
  }
  return bytes;
}

std::string base64(const std::string& bytes) {
  std::string text;
  append_base64(bytes, text);
  return text;
}

void expect_two_tets(const Vtu& vtu) {
  ASSERT_EQ(vtu.mesh.vertex_count(), 5);
  EXPECT_EQ(vtu.mesh.rest[4][0], 0.5);
  EXPECT_EQ(vtu.mesh.rest[4][2], 1e-3);
  EXPECT_EQ(vtu.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
  EXPECT_EQ(vtu.mesh.region, (std::vector<int>{7, -2}));
}

TEST_F(VtuFile, WrittenGridsReadBackExactly) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr int kPoints = 30000;  // several compressed blocks
  std::vector<double> points(3 * kPoints);
  for (double& x : points) x = uniform(random);
  std::vector<Tet> tets;
  for (int i = 0; i + 3 < kPoints; i += 3) tets.push_back({i, i + 1, i + 2, i + 3});
  Field velocity{"velocity", 3, points}, stress{"cauchy <&\">", 6, {}, FieldType::float32},
      region{"region", 1, {}, FieldType::int32};
  for (size_t i = 0; i < 6 * tets.size(); ++i) stress.values.push_back(static_cast<float>(uniform(random)));
  for (size_t i = 0; i < tets.size(); ++i) region.values.push_back(static_cast<double>(i % 5));
  velocity.values[0] = std::numeric_limits<double>::infinity();
  velocity.values[1] = std::numeric_limits<double>::denorm_min();

  write_vtu(path("a.vtu"), points, tets, {{velocity}, {stress, region}});
  const Vtu vtu = read_vtu(path("a.vtu"));

  ASSERT_EQ(vtu.mesh.vertex_count(), kPoints);
  for (int i = 0; i < kPoints; ++i) {
    for (int k = 0; k < 3; ++k) ASSERT_EQ(vtu.mesh.rest[i][k], points[3 * i + k]);
  }
  EXPECT_EQ(vtu.mesh.tets, tets);
  ASSERT_EQ(vtu.point_fields.size(), 1u);
  EXPECT_EQ(vtu.point_fields[0].name, "velocity");
  EXPECT_EQ(vtu.point_fields[0].values, velocity.values);
  ASSERT_EQ(vtu.cell_fields.size(), 2u);
  EXPECT_EQ(vtu.cell_fields[0].name, stress.name);
  EXPECT_EQ(vtu.cell_fields[0].components, 6);
  EXPECT_EQ(vtu.cell_fields[0].values, stress.values);
  EXPECT_EQ(vtu.cell_fields[0].type, FieldType::float32);
  EXPECT_EQ(vtu.cell_fields[1].type, FieldType::int32);
  EXPECT_EQ(vtu.mesh.region[6], 1);

  write_vtu(path("b.vtu"), points, vtu.mesh.tets, {vtu.point_fields, vtu.cell_fields});
  EXPECT_EQ(read_file(path("a.vtu")), read_file(path("b.vtu")));
}

TEST_F(VtuFile, FileFieldsHaveIndependentLengths) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  write_vtu(path("a.vtu"), points, {{0, 1, 2, 3}},
            {.cell_fields = {{"young", 1, {1e5}}},
             .file_fields = {{"model <neo>", 1, {1}, FieldType::int32}, {"lines", 2, {1, 2, 3, 4, 5, 6}}}});
  const Vtu vtu = read_vtu(path("a.vtu"));
  ASSERT_EQ(vtu.file_fields.size(), 2u);
  EXPECT_EQ(vtu.file_fields[0].name, "model <neo>");
  EXPECT_EQ(vtu.file_fields[0].values, std::vector<double>{1});
  EXPECT_EQ(vtu.file_fields[1].components, 2);
  EXPECT_EQ(vtu.file_fields[1].values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(vtu.cell_fields[0].values, std::vector<double>{1e5});

  std::string text = grid("", ascii);
  text.insert(text.find("<Piece"),
              "<FieldData><DataArray type=\"String\" Name=\"note\" NumberOfTuples=\"1\" format=\"ascii\">104 105 0"
              "</DataArray><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.5"
              "</DataArray></FieldData>");
  ASSERT_EQ(message(text), "");
  ASSERT_EQ(read_text(text).file_fields.size(), 1u);
  EXPECT_EQ(read_text(text).file_fields[0].values, std::vector<double>{0.5});
  text.replace(text.find("NumberOfTuples=\"1\" format=\"ascii\">0.5"), 18, "NumberOfTuples=\"2\"");
  EXPECT_THAT(message(text), HasSubstr("TimeValue"));
}

TEST_F(VtuFile, ThePointsAloneAreThoseOfTheWhole) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1.0 / 3};
  write_vtu(path("tet.vtu"), points, {{0, 1, 2, 3}});
  EXPECT_EQ(read_vtu_points(path("tet.vtu")), points);
  std::string text = read_file(path("tet.vtu"));
  write_file(path("tet.vtu"), text.replace(text.find("NumberOfPoints=\"4\""), 18, "NumberOfPoints=\"9\""));
  EXPECT_THROW(read_vtu_points(path("tet.vtu")), InvalidInput);
}

TEST_F(VtuFile, EmptyGridsAreWrittenAndRead) {
  write_vtu(path("a.vtu"), {}, TetMesh{});
  const Vtu vtu = read_vtu(path("a.vtu"));
  EXPECT_EQ(vtu.mesh.tet_count(), 0);
  EXPECT_EQ(vtu.triangles.vertex_count(), 0);
}

TEST_F(VtuFile, ReadsAscii) { expect_two_tets(read_text(grid("version=\"0.1\"", ascii))); }

TEST_F(VtuFile, ReadsInlineBase64InAllVariants) {
  for (const bool wide : {false, true}) {
    for (const bool swapped : {false, true}) {
      for (const bool apart : {false, true}) {
        const auto array = [&](const std::string& type, const std::string& name, int components,
                               const std::vector<double>& numbers) {
          const std::string bytes = stored(type, numbers, swapped);
          const auto size = static_cast<double>(bytes.size());
          const std::string header = wide ? stored<uint64_t>(size, swapped) : stored<uint32_t>(size, swapped);
          const std::string text = apart ? base64(header) + base64(bytes) : base64(header + bytes);
          return array_tag(type, name, components, "format=\"binary\">\n  ") + text + "\n</DataArray>";
        };
        const std::string head = std::string("version=\"1.0\" header_type=\"") + (wide ? "UInt64" : "UInt32") +
                                 "\" byte_order=\"" + (swapped ? "BigEndian" : "LittleEndian") + "\"";
        expect_two_tets(read_text(grid(head, array)));
      }
    }
  }
}

TEST_F(VtuFile, ReadsAppendedRawAndBase64) {
  for (const bool raw : {false, true}) {
    std::string appended;
    const auto array = [&](const std::string& type, const std::string& name, int components,
                           const std::vector<double>& numbers) {
      const std::string bytes = stored(type, numbers, false);
      const std::string block = stored<uint32_t>(static_cast<double>(bytes.size()), false) + bytes;
      const size_t offset = appended.size();
      appended += raw ? block : base64(block);
      return array_tag(type, name, components, "format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>");
    };
    std::string text = grid("", array, "APPENDED");
    const std::string encoding = raw ? "raw" : "base64";
    text.replace(text.find("APPENDED"), 8,
                 "<AppendedData encoding=\"" + encoding + "\">\n _" + appended + "\n</AppendedData>");
    expect_two_tets(read_text(text));
  }
}

// A small file that would exhaust the memory: many arrays that share the same bytes.
TEST_F(VtuFile, RefusesAppendedArraysThatShareTheirBytes) {
  const std::string block = stored<uint32_t>(40, false) + std::string(40, '\0');
  std::string fields;
  for (int i = 0; i < 3; ++i)
    fields += array_tag("Float64", "u" + std::to_string(i), 1, "format=\"appended\" offset=\"0\"/>");
  const std::string text =
      "<VTKFile type=\"UnstructuredGrid\">\n<UnstructuredGrid><Piece NumberOfPoints=\"5\" "
      "NumberOfCells=\"0\"><Points>" +
      ascii("Float64", "Points", 3, std::vector<double>(15, 0.0)) + "</Points><PointData>" + fields +
      "</PointData></Piece></UnstructuredGrid>\n<AppendedData encoding=\"raw\">_";
  EXPECT_EQ(read_text(text + block + block + block + "</AppendedData></VTKFile>").point_fields.size(), 3u);
  EXPECT_THAT(message(text + block + "</AppendedData></VTKFile>"),
              HasSubstr("array 'u1': the arrays of <AppendedData> overlap"));
}

TEST_F(VtuFile, JoinsPieces) {
  std::string text = grid("", ascii);
  const size_t start = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  text.insert(end, text.substr(start, end - start));
  const Vtu vtu = read_text(text);
  EXPECT_EQ(vtu.mesh.vertex_count(), 10);
  EXPECT_EQ(vtu.mesh.tets[3], (Tet{6, 7, 8, 9}));
  EXPECT_EQ(vtu.mesh.region, (std::vector<int>{7, -2, 7, -2}));
}

TEST_F(VtuFile, GivesTrianglesAndSplitQuadsWithoutTets) {
  std::string text = grid("", ascii);
  text.replace(text.find("10\n 10"), 6, "9\n 5");
  text.replace(text.find("4\n 8\n"), 5, "4\n 7\n");
  text.replace(text.find("0\n 1\n 2\n 3\n 1\n 2\n 3\n 4"), 23, "0\n 1\n 2\n 3\n 1\n 2\n 4  ");
  const Vtu vtu = read_text(text);
  EXPECT_EQ(vtu.mesh.tet_count(), 0);
  EXPECT_EQ(vtu.triangles.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 2, 4}}));
  EXPECT_EQ(vtu.cell_fields[0].values, (std::vector<double>{7, 7, -2}));
}

struct Fault {
  std::string was, becomes, complaint;
};

TEST_F(VtuFile, NamesWhatIsWrong) {
  const std::string good = grid("", ascii);
  const std::vector<Fault> faults = {
      {"NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"", "array 'Points': more than the 12 numbers needed"},
      {"NumberOfPoints=\"5\"", "NumberOfPoints=\"99999999\"", "array 'Points': fewer numbers than"},
      {"NumberOfPoints=\"5\"", "NumberOfPoints=\"999999999999999999\"", "is not a number from 0 to"},
      {"NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\"", "is not a number from 0 to"},
      {"NumberOfCells=\"2\"", "NumberOfCells=\"400000000\"", "array 'offsets': fewer numbers than"},
      {"10\n 10", "10\n 12", "cell 1 has type 12; only tets (10)"},
      {"4\n 8\n", "4\n 7\n", "array 'connectivity': more than the 7"},
      {"4\n 8\n", "5\n 8\n", "cell 0 of type 10 has 5 corners"},
      {"4\n 8\n", "8\n 4\n", "do not ascend"},
      {"0\n 1\n 2\n 3\n 1\n 2\n 3\n 4", "0\n 1\n 2\n 3\n 1\n 2\n 3\n 5", "a cell names point 5 of 5"},
      {"0\n 1\n 2\n 3\n 1\n 2\n 3\n 4", "0\n 1\n 2\n 3\n -1\n 2\n 3\n 4", "a cell names point -1 of 5"},
      {"0.25", "nan", "point 4 is not finite"},
      {"0.25", "frog", "number 14 cannot be read"},
      {"7\n -2", "7\n 0.5", "'region' holds 0.5"},
      {"Name=\"types\"", "Name=\"kinds\"", "<Cells> has no array 'types'"},
      {"type=\"UInt8\"", "type=\"Float64\"", "array 'types': integers are needed"},
      {"type=\"Float64\"", "type=\"Float65\"", "unknown number type 'Float65'"},
      {"UnstructuredGrid\" ", "PolyData\" ", "not a VTK file of type UnstructuredGrid but PolyData"},
      {"format=\"ascii\"", "format=\"appended\"", "the file has no <AppendedData>"},
  };
  ASSERT_EQ(message(good), "");
  for (const Fault& fault : faults) {
    std::string bad = good;
    ASSERT_NE(bad.find(fault.was), std::string::npos) << fault.was;
    bad.replace(bad.find(fault.was), fault.was.size(), fault.becomes);
    EXPECT_THAT(message(bad), HasSubstr(fault.complaint)) << fault.becomes;
    EXPECT_THAT(message(bad), HasSubstr("text.vtu")) << fault.becomes;
  }
}

TEST_F(VtuFile, RefusesOtherCompressors) {
  EXPECT_THAT(message(grid("compressor=\"vtkLZ4DataCompressor\"", ascii)),
              HasSubstr("vtkLZ4DataCompressor is not supported"));
}

TEST_F(VtuFile, RefusesEveryTruncation) {
  write_vtu(path("a.vtu"), std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {{0, 1, 2, 3}},
            {.cell_fields = {{"region", 1, {3}, FieldType::int32}}});
  const std::string whole = read_file(path("a.vtu"));
  for (size_t n = 0; n + 1 < whole.size(); ++n) EXPECT_NE(message(whole.substr(0, n)), "") << n;
}

// For any change of a byte the result is a mesh or an InvalidInput; anything else ends the test.
TEST_F(VtuFile, SurvivesEveryChangedByte) {
  write_vtu(path("a.vtu"), std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {{0, 1, 2, 3}});
  const std::string whole = read_file(path("a.vtu"));
  int refused = 0;
  for (size_t n = 0; n < whole.size(); ++n) {
    for (const char c : {'\0', '9', '<', 'A', '\xff'}) {
      std::string changed = whole;
      changed[n] = c;
      refused += !message(changed).empty();
    }
  }
  EXPECT_GT(refused, static_cast<int>(whole.size()));
}

TEST_F(VtuFile, RefusesCompressedSizesThatDoNotFit) {
  const auto with_header = [&](std::vector<uint32_t> header) {
    const auto array = [&](const std::string& type, const std::string& name, int components,
                           const std::vector<double>&) {
      std::string bytes(reinterpret_cast<const char*>(header.data()), 4 * header.size());
      return array_tag(type, name, components, "format=\"binary\">") + base64(bytes) + base64("12345678") +
             "</DataArray>";
    };
    return message(grid("compressor=\"vtkZLibDataCompressor\"", array));
  };
  EXPECT_THAT(with_header({0xffffffff, 0xffffffff, 0xffffffff, 8}), HasSubstr("do not fit"));
  EXPECT_THAT(with_header({2, 0xffffffff, 1, 4, 4}), HasSubstr("do not fit"));
  EXPECT_THAT(with_header({0, 0, 0}), HasSubstr("holds 0 bytes where 120 are needed"));
  EXPECT_THAT(with_header({1, 120, 0, 0xffffffff}), HasSubstr("cut short"));
  EXPECT_THAT(with_header({1, 120, 0, 8}), HasSubstr("damaged"));
  EXPECT_THAT(with_header({1, 120}), HasSubstr("do not fit"));
}

TEST_F(VtuFile, AMissingFileIsNamed) {
  EXPECT_THROW(read_vtu(path("missing.vtu")), InvalidInput);
  EXPECT_THROW(write_vtu(path("no/such/folder.vtu"), {}, TetMesh{}), InvalidInput);
}

TEST_F(VtuFile, WrittenSurfacesReadBack) {
  const TriMesh surface{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 0.1}}}, {{0, 1, 2}, {0, 3, 1}}};
  write_surface_vtu(path("a.vtu"), surface, {.cell_fields = {{"obstacle", 1, {0, 1}, FieldType::int32}}});
  const Vtu read = read_vtu(path("a.vtu"));
  EXPECT_EQ(read.triangles.triangles, surface.triangles);
  EXPECT_EQ(read.triangles.vertices[3][2], 0.1);
  EXPECT_EQ(read.cell_fields.at(0).values, (std::vector<double>{0, 1}));
}

}  // namespace
}  // namespace aspic
