#include "io/gltf_reader.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/folder_test.h"
#include "io/gltf.h"
#include "io/mesh_examples_test.h"
#include "io/mesh_file.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class GltfReading : public FolderTest {
 public:
  TriMesh read(const std::string& name, const std::string& contents) {
    write_file(folder / name, contents);
    return read_tri_mesh(folder / name);
  }
  // Message of an error after a replacement in the text of the square.
  std::string refusal(const std::string& old, const std::string& replacement) {
    std::string text = gltf_square(false);
    text.replace(text.find(old), old.size(), replacement);
    return message_of([&] { read("a.gltf", text); });
  }
};

TEST_F(GltfReading, PlacesMeshesAndMergesVertices) {
  for (const bool is_binary : {true, false}) {
    const TriMesh mesh = read(is_binary ? "a.glb" : "a.gltf", gltf_square(is_binary));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{3, 0, 2}));
    EXPECT_EQ(mesh.vertices[1][0], 1);
    EXPECT_EQ(mesh.vertices[1][2], 2);
  }
}

TEST_F(GltfReading, TextureIsThatOfTheCorners) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 3, 4}};  // vertices 2 and 3 are at the same place
  const GltfMesh mesh{.name = "a",
                      .triangles = triangles,
                      .frames = {{0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1, 0, 0, 1, 0}},
                      .uv = {0, 0, 1, 0, 0.5F, 0.25F, -1, 3, 2, 1}};
  EXPECT_EQ(read("a.glb", glb({.meshes = {mesh}, .times = {0}})).triangles[1], (Triangle{0, 2, 3}));
  std::vector<std::string> notes;
  EXPECT_THAT(read_texture(folder / "a.glb", 2, notes),
              ElementsAre(TriangleUv{{{0, 1}, {1, 1}, {0.5F, 0.75F}}}, TriangleUv{{{0, 1}, {-1, -2}, {2, 0}}}));
  read("b.glb", glb({.meshes = {mesh, {.name = "b", .triangles = triangles, .frames = mesh.frames}}, .times = {0}}));
  EXPECT_TRUE(read_texture(folder / "b.glb", 4, notes).empty());
  EXPECT_THAT(notes, ElementsAre(HasSubstr("some triangles have no TEXCOORD_0")));
}

TEST_F(GltfReading, MirroredNodesKeepOutsideOut) {
  std::string text = gltf_square(false);
  const std::string old = R"("translation":[0,0,2])";
  text.replace(text.find(old), old.size(), R"("scale":[-2,1,1])");
  const TriMesh mesh = read("a.gltf", text);
  EXPECT_EQ(mesh.vertices[1][0], -2);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 2, 1}));
}

TEST_F(GltfReading, TurnsByQuaternionsAndMatrices) {
  for (const char* turn : {R"("rotation":[0,0,0.70710678118654757,0.70710678118654757])",
                           R"("matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,0,0,0,1])"}) {
    std::string text = gltf_square(false);
    const std::string old = R"("translation":[0,0,2])";
    text.replace(text.find(old), old.size(), turn);
    const TriMesh mesh = read("a.gltf", text);
    EXPECT_NEAR(mesh.vertices[1][0], 0, 1e-15) << turn;
    EXPECT_NEAR(mesh.vertices[1][1], 1, 1e-15) << turn;
  }
}

TEST_F(GltfReading, ReadsWhatIsWritten) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {2, 1, 3}};
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.1F};
  const TriMesh mesh = read("a.glb", glb({.meshes = {{"square", triangles, {points, points}}}, .times = {0, 1}}));
  EXPECT_EQ(mesh.triangles, triangles);
  EXPECT_EQ(mesh.vertices[3][2], double{0.1F});
}

TEST_F(GltfReading, ReadsBinaryFileBesideText) {
  std::string text = gltf_square(false);
  const size_t from = text.find("data:"), to = text.find('"', from);
  std::string_view coded = std::string_view(text).substr(from, to - from);
  coded.remove_prefix(coded.find(',') + 1);
  std::string bytes;
  ASSERT_TRUE(decode_base64(coded, 78, bytes));
  text.replace(from, to - from, "a.bin");
  EXPECT_THAT(message_of([&] { read("a.gltf", text); }), HasSubstr("a.bin"));
  write_file(folder / "a.bin", bytes);
  EXPECT_EQ(read("a.gltf", text).triangles.size(), 2u);
}

TEST_F(GltfReading, ErrorsNamePlaceAndRemedy) {
  EXPECT_THAT(refusal(R"("count":6)", R"("count":7)"),
              HasSubstr("accessors[0] ends beyond its bufferView of 72 bytes; "));
  EXPECT_THAT(refusal(R"("count":6)", R"("count":1e99)"), HasSubstr("accessors[0] has no integer count; "));
  EXPECT_THAT(refusal(R"("byteOffset":72)", R"("byteOffset":99999999999)"), HasSubstr("bufferViews[1] ends beyond"));
  EXPECT_THAT(refusal(R"("byteLength":78)", R"("byteLength":79)"), HasSubstr("should have 79 bytes, but has 78"));
  EXPECT_THAT(refusal(R"("children":[1])", R"("children":[0])"), HasSubstr("nodes[0] has two parents"));
  EXPECT_THAT(refusal(R"("version":"2.0")", R"("version":"1.0")"), HasSubstr("asset.version is not 2.x; export it as"));
  EXPECT_THAT(refusal(R"("scenes")", R"("extensionsRequired":["KHR_draco_mesh_compression"],"scenes")"),
              HasSubstr("'KHR_draco_mesh_compression'; export it without compression"));
  EXPECT_THAT(refusal("data:application/octet-stream", "../secret"), HasSubstr("no name of a file beside this one"));
  EXPECT_THAT(refusal("[0,0,2]", "[0,0,1e308,1]"), HasSubstr("translation of a node has 4 numbers"));
  EXPECT_THAT(refusal(R"("mesh":0)", R"("mesh":3)"), HasSubstr("meshes[3] is named, but there are 1"));
}

TEST_F(GltfReading, SkinsAndInterpolatesAnimations) {
  write_file(folder / "a.gltf", gltf_arm());
  EXPECT_EQ(read_tri_mesh(folder / "a.gltf").vertices[1][0], 2);
  const GltfMotion motion = read_gltf_motion(folder / "a.gltf", {.rate = 2.4, .animation = "bend"});
  EXPECT_THAT(motion.times, ElementsAre(0, 1 / 2.4, 2 / 2.4, 1));
  const double t = 1 / 2.4, angle = std::acos(0.0) * t, s = std::sin(angle), c = std::cos(angle);
  const double size = 1 + 2 * t * t * (3 - 2 * t);
  const std::vector<Vec3d> expected = {
      {}, {{size * (1 + c), size * s, 0}}, {{size * (1 - s / 2), size * (1 + c) / 2, 0}}};
  for (const int v : {0, 1, 2}) EXPECT_LT(norm(motion.vertices[1][v] - expected[v]), 1e-6) << v;
  EXPECT_LT(norm(motion.vertices[3][1] - Vec3d{{3, 3, 5}}), 1e-6);
}

TEST_F(GltfReading, RefusesDefectiveAnimations) {
  const auto message = [&](const std::string& old, const std::string& replacement, const char* name = "") {
    std::string text = gltf_arm();
    text.replace(text.find(old), old.size(), replacement);
    write_file(folder / "a.gltf", text);
    return message_of([&] { read_gltf_motion(folder / "a.gltf", {.rate = 24, .animation = name}); });
  };
  EXPECT_THAT(message("bend", "bend", "walk"), HasSubstr("animation = 'walk' is none of its 1 animations: 'bend'; "));
  EXPECT_THAT(message("\"animations\"", "\"extras\""), HasSubstr("it has no animation; "));
  EXPECT_THAT(message("[{\"name\"", "[{},{\"name\""), HasSubstr("it has 2 animations: '', 'bend'; choose one"));
  EXPECT_THAT(message("\"joints\":[1,2]", "\"joints\":[1,7]"),
              HasSubstr("joint 1 of skins[0] is no node of the scene"));
  EXPECT_THAT(message("\"joints\":[1,2]", "\"joints\":[1]"),
              HasSubstr("vertex 1 of meshes[0] has the weight 1.000000 at joint 1 of 1"));
  EXPECT_THAT(message("\"joints\":[1,2]", "\"joints\":[1,2,1]"), HasSubstr("3 joints, but 2 inverse bind matrices"));
  EXPECT_THAT(message("\"WEIGHTS_0\":2", "\"WEIGHTS_0\":9"), HasSubstr("accessors[9] is named, but there are 8"));
  EXPECT_THAT(message("\"WEIGHTS_0\":2", "\"WEIGHT\":2"), HasSubstr("meshes[0] has no integer WEIGHTS_0"));
  EXPECT_THAT(message("\"output\":5", "\"output\":1"), HasSubstr("accessors[1] has components of type 5121"));
  EXPECT_THAT(message("\"output\":7", "\"output\":6"), HasSubstr("a sampler has 6 numbers; 18 are needed"));
  EXPECT_THAT(message("\"path\":\"scale\"", "\"path\":\"weights\""), HasSubstr("morph targets of nodes[1]; bake them"));
  EXPECT_THAT(message("\"children\":[2]", "\"children\":[1]"), HasSubstr("nodes[1] has two parents"));
}

}  // namespace
}  // namespace aspic
