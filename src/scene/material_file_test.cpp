// Files of fitted materials, and scenes that read them.
#include "scene/material_file.h"
#include "mesh/tet_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/atomic_file.h"
#include "io/mesh_file.h"
#include "io/vtu.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

using Values = std::vector<double>;

// E grows along x, from 1e4 to 2e4.
double young_at(const Vec3d& X) { return 1e4 * (1 + X[0]); }

FittedMaterial graded(int cells, const std::string& model = "neo_hookean") {
  FittedMaterial material{.mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells}), .model = model};
  Values E, nu, density, deviation;
  for (int t = 0; t < material.mesh.tet_count(); ++t) {
    E.push_back(young_at(centroid(material.mesh, t)));
    nu.push_back(0.4);
    density.push_back(900 + t);
    deviation.push_back(0.1);
  }
  material.values = {{"young", E}, {"poisson", nu}, {"density", density}};
  material.further = {{"young_deviation", deviation}};
  return material;
}

void set(FittedMaterial& material, const std::string& name, int tet, double value) {
  for (auto& [known, numbers] : material.values)
    if (known == name) numbers[tet] = value;
}

class MaterialFile : public FolderTest {
 protected:
  MaterialFile() { write_material(path("material.vtu"), graded(4)); }

  fs::path scene(const std::string& body) const { return folder.write("s.toml", "[[body]]\nname = \"cube\"\n" + body); }
  Scene load_with(const std::string& body) const { return load_scene(scene(body)); }
  std::string refusal_with(const std::string& body) const { return refusal_of(scene(body)); }
  std::string reading(const FittedMaterial& material) const {
    write_material(path("bad.vtu"), material);
    return message_of([&] { read_material(path("bad.vtu")); });
  }

  static const Values& exported(const Scene& scene, int field) {
    return scene.simulation.model().tet_fields[field].second;
  }
  static Values young(const Scene& scene) { return by_user(scene, exported(scene, 0)); }
  static Values density(const Scene& scene) { return by_user(scene, scene.simulation.model().density); }
  static Values by_user(const Scene& scene, const Values& values) {
    return scene.simulation.model().numbering.tet.to_user(values);
  }

  const std::string box = "shape = { box = { upper = [1, 1, 1], cells = [4, 4, 4] } }\n";
  const std::string file = "material = { file = \"material.vtu\" }\n";
};

MATCHER_P(EachIsNear, expected, "") {
  if (arg.size() != expected.size()) return false;
  for (size_t i = 0; i < arg.size(); ++i)
    if (std::abs(arg[i] - expected[i]) > 1e-9 * std::abs(expected[i])) return false;
  return true;
}

TEST_F(MaterialFile, OfQuadraticTetsHasTheirCornersOnly) {
  FittedMaterial material = graded(2);
  material.mesh = raise_order(material.mesh);
  write_material(path("quadratic.vtu"), material);
  const FittedMaterial again = read_material(path("quadratic.vtu"));
  EXPECT_EQ(again.mesh.vertex_count(), 27);
  EXPECT_EQ(again.mesh.tets, graded(2).mesh.tets);
  EXPECT_EQ(again.values, material.values);
}

TEST_F(MaterialFile, ReadsBackWhatIsWritten) {
  FittedMaterial material = graded(2, "fung");
  material.values.emplace_back("b", Values(48, 2.5));
  material.mesh.region.assign(48, 3);
  write_material(path("a.vtu"), material);
  const FittedMaterial read = read_material(path("a.vtu"));
  EXPECT_EQ(read.model, "fung");
  EXPECT_EQ(read.values, material.values);
  EXPECT_EQ(read.further, material.further);
  EXPECT_EQ(read.mesh.tets, material.mesh.tets);
  EXPECT_EQ(read.mesh.region, material.mesh.region);
  EXPECT_EQ(*read.find("b"), Values(48, 2.5));
  EXPECT_EQ(read.find("lambda"), nullptr);
}

TEST_F(MaterialFile, TetsKeepValuesOnSameMesh) {
  const Scene scene = load_with(box + file);
  const FittedMaterial material = graded(4);
  EXPECT_THAT(young(scene), EachIsNear(*material.find("young")));
  EXPECT_EQ(density(scene), *material.find("density"));
  for (const std::string& note : scene.notes) EXPECT_EQ(note.find("material.vtu"), std::string::npos) << note;
}

TEST_F(MaterialFile, TetsTakeCentroidValuesOnOtherMesh) {
  const Scene scene = load_with("shape = { box = { upper = [1, 1, 1.125], cells = [8, 8, 9] } }\n" + file);
  const Values E = young(scene);
  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1.125}}, {8, 8, 9});
  for (int t = 0; t < mesh.tet_count(); ++t) EXPECT_NEAR(E[t], young_at(centroid(mesh, t)), 0.25e4);
  const std::string note = scene.notes.back();
  EXPECT_THAT(note, AllOf(HasSubstr("3456 tets"), HasSubstr("384 of material.vtu"), HasSubstr("384 of the nearest")));
  EXPECT_THAT(note, HasSubstr("up to 0.09375 m away"));  // centroid of the outermost tet: three quarters of a cell
}

TEST_F(MaterialFile, MaterialMovesWithBody) {
  const Scene scene =
      load_with(box + file + "scale = 3\nrotate = { axis = [1, 2, 3], angle_deg = 77 }\ntranslate = [5, -2, 9]\n");
  EXPECT_THAT(young(scene), EachIsNear(*graded(4).find("young")));
}

TEST_F(MaterialFile, FrameSelectsCoordinates) {
  const std::string millimeters = "shape = { box = { upper = [1000, 1000, 1000], cells = [4, 4, 4] } }\n";
  const std::string turned = "scale = 0.001\nrotate = { axis = [0, 0, 1], angle_deg = 90 }\n";
  const auto with_frame = [](const std::string& frame) {
    return "material = { file = \"material.vtu\", frame = \"" + frame + "\" }\n";
  };
  const Values expected = *graded(4).find("young");
  EXPECT_THAT(young(load_with(millimeters + turned + with_frame("scaled"))), EachIsNear(expected));
  EXPECT_THAT(refusal_with(millimeters + turned + with_frame("mesh")),
              AllOf(HasSubstr("(62.5, 62.5, 62.5) to (937.5"), HasSubstr("try another `frame`")));
  const std::string back = "shape = { box = { lower = [-1, 0, 0], upper = [0, 1, 1], cells = [4, 4, 4] } }\n";
  const Scene placed = load_with(back + "translate = [1, 0, 0]\n" + with_frame("placed"));
  EXPECT_THAT(young(placed), EachIsNear(expected));
}

TEST_F(MaterialFile, OnlyDensityMayBeReplaced) {
  const auto beside = [&](const std::string& more) {
    return box + "material = { file = \"material.vtu\", " + more + " }\n";
  };
  EXPECT_EQ(density(load_with(beside("density = 1234"))), Values(384, 1234));
  EXPECT_EQ(refusal_with(beside("model = \"neo_hookean\"")), "");
  EXPECT_THAT(refusal_with(beside("model = \"fung\"")),
              AllOf(HasSubstr("s.toml:4:"), HasSubstr("fitted for neo_hookean"), HasSubstr("remove `model`")));
  EXPECT_THAT(refusal_with(beside("young = 1e5")), AllOf(HasSubstr("excludes"), HasSubstr("file, frame, hash")));
  EXPECT_THAT(refusal_with(beside("b = 2")), AllOf(HasSubstr("b = 2"), HasSubstr("remove b")));
}

TEST_F(MaterialFile, FileOfCommandLineReplacesNumbers) {
  const std::string absolute = path("material.vtu").string();
  const Scene scene = load_scene(this->scene(box + "material = { young = 7, poisson = 0.1 }\n"),
                                 {.overrides = {"material.file=" + absolute}});
  EXPECT_THAT(young(scene), EachIsNear(*graded(4).find("young")));
  write_mesh(path("cube.msh"), make_box({{0, 0, 0}}, {{1, 1, 1}}, {4, 4, 4}));
  const Scene alone = load_scene(path("cube.msh"), {.overrides = {"material.file=" + absolute}});
  EXPECT_THAT(young(alone), EachIsNear(*graded(4).find("young")));
}

TEST_F(MaterialFile, ResolvedSceneGivesSameMaterial) {
  for (const char* density_key : {"", ", density = 1100"}) {
    const Scene scene = load_with(box + std::string("material = { file = \"material.vtu\"") + density_key + " }\n");
    EXPECT_THAT(scene.resolved, AllOf(HasSubstr("inputs/cube.material.vtu"), HasSubstr("fnv1a:")));
    write_inputs(scene, path("run"));
    const fs::path resolved = folder.write("run/scene.toml", scene.resolved);
    const Scene again = load_scene(resolved);
    EXPECT_EQ(again.resolved, scene.resolved);
    EXPECT_EQ(exported(again, 0), exported(scene, 0));
    EXPECT_EQ(density(again), density(scene));
  }
  FittedMaterial other = graded(4);
  set(other, "young", 0, 1);
  write_material(path("run/inputs/cube.material.vtu"), other);
  EXPECT_THAT(refusal_of(path("run/scene.toml")), AllOf(HasSubstr("hash"), HasSubstr("it has changed")));
}

TEST_F(MaterialFile, SceneNamesMissingModel) {
  FittedMaterial material = graded(4, "");
  write_material(path("material.vtu"), material);
  EXPECT_THAT(refusal_with(box + file), AllOf(HasSubstr("names no model"), HasSubstr("try model =")));
  const auto with = [&](const std::string& model) {
    return box + "material = { file = \"material.vtu\", model = \"" + model + "\" }\n";
  };
  EXPECT_EQ(refusal_with(with("corotated")), "");
  EXPECT_THAT(refusal_with(with("fung")), HasSubstr("no cell field 'b', which the model fung needs"));
  set(material, "young", 3, -1);
  write_material(path("material.vtu"), material);
  EXPECT_THAT(refusal_with(with("corotated")), HasSubstr("young = -1 in tet 3"));
}

TEST_F(MaterialFile, BadFilesNameValueAndRemedy) {
  FittedMaterial material = graded(2);
  set(material, "young", 5, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(reading(material), AllOf(HasSubstr("bad.vtu: young = nan in tet 5 at ("), HasSubstr("must be > 0")));
  material = graded(2);
  set(material, "poisson", 7, 0.5);
  EXPECT_THAT(reading(material), AllOf(HasSubstr("poisson = 0.5 in tet 7"), HasSubstr("< 0.5")));
  material = graded(2);
  set(material, "density", 0, 0);
  EXPECT_THAT(reading(material), HasSubstr("density = 0 in tet 0"));
  material = graded(2);
  material.values[0].first = "yuong";
  EXPECT_THAT(reading(material), HasSubstr("no cell field 'young', which the model neo_hookean needs (did you mean "
                                           "'yuong'?)"));
  EXPECT_THAT(reading(graded(2, "neo_hokean")), HasSubstr("material 'neo_hokean' is unknown (did you mean "));
  EXPECT_THAT(reading(graded(2, "fung")), HasSubstr("no cell field 'b'"));

  const TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  std::vector<double> points;
  for (const Vec3d& X : mesh.rest) points.insert(points.end(), {X[0], X[1], X[2]});
  write_vtu(path("bad.vtu"), points, mesh.tets, {{}, {{"young", 3, Values(18, 1)}}, {{"model linear", 1, {1}}}});
  EXPECT_THAT(message_of([&] { read_material(path("bad.vtu")); }), HasSubstr("'young' has 3 components"));
  write_vtu(path("bad.vtu"), points, TetMesh{});
  EXPECT_THAT(message_of([&] { read_material(path("bad.vtu")); }), HasSubstr("has no tets"));
  write_file(path("material.vtu"), "not XML");
  EXPECT_THAT(refusal_with(box + file), AllOf(HasSubstr("s.toml:4:"), HasSubstr("material.vtu")));
  EXPECT_THAT(refusal_with(box + "material = { file = \"materal.vtu\" }\n"), HasSubstr("did you mean 'material.vtu'?"));
}

TEST_F(MaterialFile, DistantBodyIsRejected) {
  const std::string elsewhere = "shape = { box = { lower = [10, 0, 0], upper = [11, 1, 1], cells = [1, 1, 1] } }\n";
  EXPECT_THAT(refusal_with(elsewhere + file), AllOf(HasSubstr("(0, 0, 0) to (1, 1, 1)"), HasSubstr("away from it")));
}

TEST_F(MaterialFile, SamplingReturnsValueOfContainingTet) {
  const FittedMaterial material = graded(4);
  const TetMesh fine = make_box({{0, 0, 0}}, {{1, 1, 1}}, {8, 8, 8});
  const Values E = sample(material, *material.find("young"), fine);
  ASSERT_EQ(E.size(), fine.tets.size());
  for (int t = 0; t < fine.tet_count(); ++t) EXPECT_NEAR(E[t], young_at(centroid(fine, t)), 0.25e4);
  EXPECT_THAT(sample(material, *material.find("young"), material.mesh), EachIsNear(*material.find("young")));
}

}  // namespace
}  // namespace aspic
