// Surfaces and regions of mesh files by name.
#include <gmock/gmock.h>

#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Two tets that share the triangle 2 3 4: "base" in the plane z = 0, and a surface without a name.
const std::string kGroups = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 1 "base"
3 3 "inside part"
3 4 "tip"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
$EndNodes
$Elements
4
1 2 2 1 1 1 3 2
2 2 2 6 2 2 3 5
3 4 2 3 1 1 2 3 4
4 4 2 4 2 2 3 4 5
$EndElements
)";

class NamedParts : public ::testing::Test {
 protected:
  NamedParts() { folder_.write("groups.msh", kGroups); }

  std::filesystem::path with(const std::string& text) const {
    return folder_.write("s.toml", "[[body]]\nmesh = \"groups.msh\"\n" + text);
  }

  TestFolder folder_;
};

std::vector<int> first_pin(const Scene& scene) {
  return scene.simulation.model().numbering.vertex.to_user(scene.simulation.model().pins.at(0).vertices);
}

TEST_F(NamedParts, SurfacePinsItsVertices) {
  EXPECT_EQ(first_pin(load_scene(with("[[body.pin]]\nwhere = { surface = \"base\" }\n"))), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(first_pin(load_scene(with("[[body.pin]]\nwhere = { surface = 6 }\n"))), (std::vector<int>{1, 2, 4}));
}

TEST_F(NamedParts, SurfacePinsMidEdgeNodes) {
  const Scene scene = load_scene(with("order = 2\n[[body.pin]]\nwhere = { surface = \"base\" }\n"));
  EXPECT_EQ(first_pin(scene).size(), 6u);
  for (const int v : first_pin(scene)) EXPECT_EQ(rest(scene, v)[2], 0);
}

TEST_F(NamedParts, LoadActsOnTrianglesOfItsSurface) {
  Scene scene = load_scene(with("[[body.traction]]\nwhere = { surface = \"base\" }\nvalue = [0, 0, 6]\n"));
  const StepReport report = scene.simulation.step();
  ASSERT_FALSE(report.resultants.loads.empty());
  EXPECT_NEAR(report.resultants.loads.back().force[2], 3, 1e-12) << "area 1/2";
}

TEST_F(NamedParts, ResolvedSceneKeepsNames) {
  const Scene scene = load_scene(with("[[body.pin]]\nwhere = { surface = \"base\" }\n"));
  write_inputs(scene, folder_ / "run");
  EXPECT_EQ(first_pin(load_scene(folder_.write("run/scene.toml", scene.resolved))), first_pin(scene));
}

TEST_F(NamedParts, RegionsHaveNamesAndLabels) {
  const Scene scene = load_scene(with("material = { density = { regions = { \"inside part\" = 100, 4 = 300 } } }\n"));
  const Model& model = scene.simulation.model();
  EXPECT_EQ(model.numbering.tet.to_user(model.density), (std::vector<double>{100, 300}));
}

TEST_F(NamedParts, ErrorsListTheKnownNames) {
  EXPECT_THAT(refusal_of(with("[[body.pin]]\nwhere = { surface = \"bases\" }\n")),
              AllOf(HasSubstr("s.toml:4:"), HasSubstr("surface = \"bases\""), HasSubstr("the surfaces 'base' (1), 6")));
  EXPECT_THAT(refusal_of(with("[[body.force]]\nwhere = { surface = 1 }\nvalue = [0, 0, 1]\n")),
              HasSubstr("a surface has no tets"));
  EXPECT_THAT(refusal_of(with("material = { density = { regions = { tip = 1 } } }\n")),
              HasSubstr("a value for region 3 is missing (the mesh has: 3 'inside part', 4 'tip')"));
  EXPECT_THAT(refusal_of(with("material = { density = { regions = { 3 = 1, tip = 1, 4 = 2 } } }\n")),
              HasSubstr("region 4 is 'tip' and has two values"));
  EXPECT_THAT(refusal(kCube + "[[body.pin]]\nwhere = { surface = 1 }\n"), HasSubstr("has no surfaces (save physical"));
}

}  // namespace
}  // namespace aspic
