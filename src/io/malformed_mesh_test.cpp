// Damaged files are read or refused with InvalidInput. They cause no crash, hang or memory exhaustion.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include "base/error.h"
#include "io/gltf_reader.h"
#include "io/gmsh.h"
#include "io/legacy_vtk.h"
#include "io/medit.h"
#include "io/mesh_examples_test.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"
#include "io/tetgen.h"

namespace aspic {
namespace {

const std::string kNode = "# by hand\n5 3 1 1\n1 0 0 0 0.5 1\n2 1 0 0 0.5 1\n3 0 1 0 0 0\n4 0 0 1 0 0\n5 1 1 1 0 0\n";
const std::string kEle = "2 4 1\n1 1 2 3 4 7\n2 2 3 4 5 9\n# end\n";

using Parser = std::function<MeshContent(const std::string&, std::string_view)>;
struct Case {
  std::string name, contents;
  Parser parse;
};

MeshContent legacy_vtk_content(const std::string& file, std::string_view text) {
  Vtu grid = parse_legacy_vtk(text, file);
  const bool has_tets = !grid.mesh.tets.empty();
  return {has_tets ? grid.mesh.rest : grid.triangles.vertices, grid.mesh.tets, grid.mesh.region,
          grid.triangles.triangles};
}

MeshContent gltf_content(const std::string& file, std::string_view bytes) {
  return parse_gltf(file, bytes,
                    [&](auto& name) -> std::string { throw InvalidInput(file + ":1: " + name + "; none"); });
}

std::vector<Case> cases() {
  const std::map<std::string, Parser> parsers = {
      {".msh", parse_gmsh},         {".mesh", parse_medit}, {".obj", parse_obj},
      {".off", parse_off},          {".ply", parse_ply},    {".stl", parse_stl},
      {".vtk", legacy_vtk_content}, {".glb", gltf_content}, {".gltf", gltf_content}};
  std::vector<Case> result;
  for (const MeshExample& example : mesh_examples())
    result.push_back({example.name, example.contents, parsers.at(example.extension)});
  result.push_back({"tetgen node", kNode, [](auto& f, auto text) { return parse_tetgen(f, text, f, kEle); }});
  result.push_back({"tetgen ele", kEle, [](auto& f, auto text) { return parse_tetgen(f, kNode, f, text); }});
  return result;
}

void expect_valid(const MeshContent& mesh, const std::string& context) {
  const int count = static_cast<int>(mesh.vertices.size());
  for (const Vec3d& vertex : mesh.vertices)
    for (const double x : vertex.a) ASSERT_TRUE(std::isfinite(x)) << context;
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) ASSERT_TRUE(v >= 0 && v < count) << context;
  for (const Triangle& triangle : mesh.triangles)
    for (const int v : triangle) ASSERT_TRUE(v >= 0 && v < count) << context;
  ASSERT_TRUE(mesh.region.empty() || mesh.region.size() == mesh.tets.size()) << context;
}

// Returns whether the text was rejected.
bool is_refused(const Case& c, std::string_view contents, const std::string& context) {
  try {
    expect_valid(c.parse("file", contents), context);
    return false;
  } catch (const InvalidInput& error) {
    EXPECT_THAT(error.what(), testing::MatchesRegex("file:([0-9]+:| byte [0-9]+:) [^\n]*;[^\n]*")) << context;
    return true;
  }
}

TEST(MalformedMesh, ExamplesThemselvesAreRead) {
  for (const Case& c : cases()) EXPECT_FALSE(is_refused(c, c.contents, c.name)) << c.name;
}

TEST(MalformedMesh, TruncationsAtEveryByteAreReadOrRefused) {
  for (const Case& c : cases()) {
    int refused = 0;
    for (size_t size = 0; size < c.contents.size(); ++size)
      refused +=
          is_refused(c, std::string_view(c.contents).substr(0, size), c.name + " cut at " + std::to_string(size));
    // OBJ files do not state their size.
    if (c.name != "obj") {
      EXPECT_GT(refused, static_cast<int>(c.contents.size()) / 2) << c.name;
    }
  }
}

// One test per example: under sanitizers they take minutes.
class MutatedMesh : public testing::TestWithParam<Case> {};

TEST_P(MutatedMesh, IsReadOrRefused) {
  std::mt19937 random(7);
  const Case& c = GetParam();
  for (size_t place = 0; place < c.contents.size(); ++place)
    for (const int byte : {0, 0x7f, 0x80, 0xff, int('-'), int('9'), int('\n'), static_cast<int>(random() % 256)}) {
      std::string damaged = c.contents;
      damaged[place] = static_cast<char>(byte);
      is_refused(c, damaged, "byte " + std::to_string(byte) + " at " + std::to_string(place));
    }
}

INSTANTIATE_TEST_SUITE_P(Examples, MutatedMesh, testing::ValuesIn(cases()), [](const auto& test) {
  std::string name = test.param.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

TEST(MalformedMesh, ManyMutationsAtOnceAreReadOrRefused) {
  std::mt19937 random(11);
  for (const Case& c : cases())
    for (int trial = 0; trial < 500; ++trial) {
      std::string damaged = c.contents;
      for (int i = 0; i < 4; ++i) damaged[random() % damaged.size()] = damaged[random() % damaged.size()];
      const size_t from = random() % damaged.size();
      if (trial % 3 == 0) damaged.erase(from, random() % 16);
      if (trial % 3 == 1) damaged.insert(from, damaged.substr(random() % damaged.size(), random() % 16));
      is_refused(c, damaged, c.name + " trial " + std::to_string(trial));
    }
}

// Replaces each number of a text by a huge or negative one; readers must not trust counts.
TEST(MalformedMesh, HugeAndNegativeNumbersAreReadOrRefused) {
  for (const Case& c : cases())
    for (size_t i = 0; i < c.contents.size(); ++i) {
      const bool begins = std::isdigit(static_cast<unsigned char>(c.contents[i])) &&
                          (i == 0 || !std::isdigit(static_cast<unsigned char>(c.contents[i - 1])));
      if (!begins) continue;
      const size_t end = std::min(c.contents.find_first_not_of("0123456789", i), c.contents.size());
      for (const char* number : {"2147483647", "2147483648", "-1", "-2147483649", "4294967295", "9223372036854775807",
                                 "-9223372036854775808", "99999999999999999999", "1e308", "nan", "inf", "0"})
        is_refused(c, c.contents.substr(0, i) + number + c.contents.substr(end), c.name + " with " + number);
    }
}

TEST(MalformedMesh, FilesOfAnotherFormatAreRefused) {
  for (const Case& parser : cases())
    for (const Case& content : cases()) {
      const std::string a = parser.name.substr(0, 3), b = content.name.substr(0, 3);
      if (a != b) {
        EXPECT_TRUE(is_refused(parser, content.contents, parser.name)) << parser.name << " < " << content.name;
      }
    }
}

}  // namespace
}  // namespace aspic
