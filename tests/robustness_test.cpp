// Degenerate meshes, initial states and numbers, each with its expected outcome.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "io/mesh_file.h"
#include "material/registry.h"
#include "mesh/doctor.h"
#include "mesh/generators.h"
#include "results/explanation.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

std::string text_of(double x) {
  std::ostringstream text;
  text.precision(17);
  text << x;
  return text.str();
}

const std::string kStiffStep = "[time]\nstep = 0.05\nduration = 10\n[solver]\nmax_iterations = 500\n";
const std::string kFloating = "gravity = [0, 0, 0]\n" + kStiffStep;

// Builds a scene. `material` lists only unusual values: "model = \"stvk\", young = 1".
std::string body(const std::string& shape, const std::string& material, const std::string& more) {
  return "[[body]]\nname = \"b\"\n" + shape + "\nmaterial = { " + material + " }\n" + more + "\n";
}
const std::string kBox = "shape = { box = { upper = [1, 0.5, 0.5], cells = [4, 2, 2] } }";

// Number of steps until the elastic energy of about 1e4 J has almost vanished. A free body may continue to rotate.
struct Ending {
  bool is_relaxed = false, fails = false;
  double min_det_F = 0;
};

Ending settle(Scene& scene, int most = 60) {
  Simulation& simulation = scene.simulation;
  Ending ending;
  for (int i = 0; i < most && !ending.is_relaxed && !ending.fails; ++i) {
    double last = INFINITY;
    bool falls = true;
    const StepReport report = simulation.step([&](const LiveIteration& iteration) {
      falls = falls && iteration.value <= last + 1e-12 * std::abs(last);
      last = iteration.value;
    });
    EXPECT_TRUE(falls) << "step " << report.step << ": the energy rises between iterations";
    ending.fails = !is_success(report.status);
    if (ending.fails) {
      EXPECT_NE(explain(simulation, report).cause, "");
    }
    ending.min_det_F = report.min_det_F;
    ending.is_relaxed = std::abs(report.potential_total) < 1e-2;
  }
  return ending;
}

// ---- degenerate initial states

struct Start {
  std::string name, deform;
};
const Start kStarts[] = {
    {"point",
     "deform = { displacement = [\"0.5 - X + 1e-6*sin(1e4*X+2e4*Y+3e4*Z)\", "
     "\"0.2 - Y + 1e-6*sin(3e4*X+1e4*Y+2e4*Z)\", \"0.1 - Z + 1e-6*sin(2e4*X+3e4*Y+1e4*Z)\"] }"},
    {"plane", "deform = { displacement = [0, \"-Y + 1e-6*sin(1e4*X+2e4*Y+3e4*Z)\", 0] }"},
    {"random",
     "deform = { displacement = [\"-X + 0.5 + 0.5*sin(1e4*X+2e4*Y+3e4*Z)\", "
     "\"-Y + 0.25 + 0.25*sin(3e4*X+1e4*Y+2e4*Z)\", \"-Z + 0.25 + 0.25*sin(2e4*X+3e4*Y+1e4*Z)\"] }"},
    {"mirrored", "deform = { matrix = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]] }"},
};

TEST(Robustness, BarrierMaterialsRejectInvertedStates) {
  for (const MaterialInfo& info : materials())
    for (const Start& start : kStarts) {
      if (!info.barrier) continue;
      EXPECT_THAT(refusal(kFloating + body(kBox, "model = \"" + info.name + "\"", start.deform)),
                  AllOf(HasSubstr("tets are inverted or flat"), HasSubstr("stable_neo_hookean")))
          << info.name << ", " << start.name;
    }
}

// Initial states that a material does not recover from are documented in its remarks (`aspic materials`), except that
// stvk and corotated settle in folds from random positions.
TEST(Robustness, OtherMaterialsRecoverExceptWhereDocumented) {
  const std::vector<std::string> kept = {"neo_hookean point", "stable_neo_hookean point",
                                         "corotated point",   "corotated random",
                                         "stvk point",        "stvk plane",
                                         "stvk random",       "stvk mirrored"};
  for (const MaterialInfo& info : materials())
    for (const Start& start : kStarts) {
      if (info.barrier) continue;
      const std::string name = info.name + " " + start.name;
      SCOPED_TRACE(name);
      Scene scene = load(kFloating + body(kBox, "model = \"" + info.name + "\"", start.deform));
      const Ending ending = settle(scene, info.name == "arap" ? 200 : 60);
      const bool recovers = ending.is_relaxed && ending.min_det_F > 0.9;
      EXPECT_EQ(recovers, std::find(kept.begin(), kept.end(), name) == kept.end()) << ending.min_det_F;
      EXPECT_TRUE(!ending.fails || name == "stvk point");
    }
}

TEST(Robustness, ShapesRecoverFromFlatMirroredAndRandomStates) {
  for (const char* shape :
       {"sphere = { radius = 0.5, size = 0.25 }", "torus = { major_radius = 0.5, minor_radius = 0.2, size = 0.2 }",
        "cylinder = { radius = 0.25, height = 1, size = 0.2 }"})
    for (const Start& start : kStarts) {
      if (start.name == "point") continue;
      SCOPED_TRACE(std::string(shape) + ", " + start.name);
      Scene scene = load(
          kFloating + body("shape = { " + std::string(shape) + " }", "model = \"stable_neo_hookean\"", start.deform));
      const Ending ending = settle(scene);
      EXPECT_TRUE(ending.is_relaxed && ending.min_det_F > 0.9) << ending.min_det_F;
    }
}

TEST(Robustness, FlatBunnyRecovers) {
  const std::string mesh = std::string(ASPIC_SOURCE_DIR) + "/scenes/bunny.mesh";
  const TestFolder folder;
  Scene scene = load_scene(
      folder.write("s.toml", "gravity = [0, 0, 0]\n[time]\nstep = 0.5\nduration = 10\n[[body]]\nmesh = \"" + mesh +
                                 "\"\nmaterial = { model = \"stable_neo_hookean\" }\ndeform = { displacement = [0, "
                                 "\"-Y + 1e-7*sin(1e5*X+2e5*Y+3e5*Z)\", 0] }\n"),
      {.allow_outside = true});
  double energy = INFINITY, min_det_F = 0;
  for (int i = 0; i < 20; ++i) {
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status)) << report.step;
    const double now = report.potential_total + report.kinetic;
    EXPECT_LT(now, energy);
    energy = now;
    min_det_F = report.min_det_F;
  }
  EXPECT_GT(min_det_F, 0.9);
}

// ---- meshes

class BadMesh : public FolderTest {
 protected:
  std::filesystem::path scene(const TetMesh& mesh, const std::string& more = "") {
    write_mesh(folder / "m.mesh", mesh);
    return folder.write("s.toml", "[time]\nduration = 0.05\n[[body]]\nmesh = \"m.mesh\"\n" + more);
  }
  void expect_runs(const TetMesh& mesh, const std::string& more = "") {
    Scene loaded = load_scene(scene(mesh, more));
    for (int i = 0; i < loaded.steps; ++i) {
      const StepReport report = loaded.simulation.step();
      EXPECT_TRUE(is_success(report.status)) << explain(loaded.simulation, report).cause;
    }
  }
  TestFolder folder;
  TetMesh box = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 2, 2});
};

TEST_F(BadMesh, InvertedAndFlatTetsAreNamedAndRepaired) {
  TetMesh inverted = box;
  std::swap(inverted.tets[7][0], inverted.tets[7][1]);
  EXPECT_THAT(refusal_of(scene(inverted)), AllOf(HasSubstr("inverted"), HasSubstr("(7)")));
  repair(inverted);
  expect_runs(inverted);
  TetMesh flat = box;
  flat.tets.push_back({0, 1, 3, 4});  // inside one face
  EXPECT_THAT(refusal_of(scene(flat)), HasSubstr("have no volume: their corners lie in a plane (48)"));
  repair(flat);
  expect_runs(flat);
}

TEST_F(BadMesh, DuplicateAndUnreferencedVerticesAreRepaired) {
  TetMesh mesh = box;
  mesh.rest.push_back({{3, 3, 3}});
  EXPECT_THAT(refusal_of(scene(mesh)), AllOf(HasSubstr("belong to none of the tets (27)"), HasSubstr("--repair")));
  repair(mesh);
  expect_runs(mesh);
  TetMesh torn = box;  // one tet has its own copy of a shared corner
  torn.rest.push_back(torn.rest[torn.tets[0][0]]);
  torn.tets[0][0] = 27;
  std::string notes;
  for (const std::string& note : load_scene(scene(torn)).notes) notes += note;
  EXPECT_THAT(notes, HasSubstr("coincide with an earlier vertex"));
  expect_runs(torn);
  repair(torn);
  EXPECT_EQ(torn.vertex_count(), 27);
}

TEST_F(BadMesh, PartsRunHoweverTheyMeet) {
  const std::vector<Vec3d> corners = {{{0, 0, 0}},    {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{-1, 0, 0}}, {{0, -1, 0}},
                                      {{-1, -1, -1}}, {{5, 5, 5}}, {{6, 5, 5}}, {{5, 6, 5}}, {{5, 5, 6}}};
  const auto positive = [&](std::vector<Tet> tets) {
    TetMesh mesh{corners, std::move(tets), {}};
    for (int t = 0; t < mesh.tet_count(); ++t)
      if (volume(mesh, t) < 0) std::swap(mesh.tets[t][0], mesh.tets[t][1]);
    repair(mesh);  // removes unused vertices
    return mesh;
  };
  expect_runs(positive({{0, 1, 2, 3}, {0, 3, 4, 5}}));
  expect_runs(positive({{0, 1, 2, 3}, {0, 4, 5, 6}}));
  expect_runs(positive({{0, 1, 2, 3}, {7, 8, 9, 10}}));
}

TEST_F(BadMesh, SingleTetRunsAndEmptyMeshIsRejected) {
  const TetMesh one{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, {{0, 1, 2, 3}}, {}};
  expect_runs(one);
  expect_runs(one, "[[body.pin]]\nwhere = \"all\"\n");
  folder.write("m.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\nTetrahedra\n0\nEnd\n");
  EXPECT_THAT(refusal_of(folder.write("s.toml", "[[body]]\nmesh = \"m.mesh\"\n")), HasSubstr("m.mesh"));
}

TEST_F(BadMesh, InvalidNumbersAreRejectedInEveryFormat) {
  for (const char* name : {"m.mesh", "m.msh", "m.vtu", "m.obj", "m.off", "m.ply", "m.stl"}) {
    for (const char* bad : {"nan", "inf", "-inf", "1e999"}) {
      SCOPED_TRACE(std::string(name) + ", " + bad);
      std::string text;
      if (name == std::string("m.mesh"))
        text =
            "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\nBAD 0 0 0\n0 1 0 0\n0 0 1 0\nTetrahedra\n1\n1 "
            "2 3 4 0\nEnd\n";
      if (name == std::string("m.msh"))
        text =
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 BAD 0 0\n3 0 1 0\n4 0 0 "
            "1\n$EndNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n";
      if (name == std::string("m.vtu"))
        text =
            "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid><Piece "
            "NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
            "format=\"ascii\">0 0 0 BAD 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int64\" "
            "Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray><DataArray type=\"Int64\" Name=\"offsets\" "
            "format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
            "format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n";
      if (name == std::string("m.obj"))
        text = "v 0 0 0\nv BAD 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
      if (name == std::string("m.off"))
        text = "OFF\n4 4 0\n0 0 0\nBAD 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
      if (name == std::string("m.ply"))
        text =
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nelement "
            "face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\nBAD 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 "
            "3\n3 0 3 2\n3 1 2 3\n";
      if (name == std::string("m.stl"))
        text =
            "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex BAD 0 0\nvertex 0 1 "
            "0\nendloop\nendfacet\nendsolid s\n";
      text.replace(text.find("BAD"), 3, bad);
      folder.write(name, text);
      EXPECT_THAT(refusal_of(folder.write("s.toml", "[[body]]\nmesh = \"" + std::string(name) + "\"\n")),
                  AllOf(HasSubstr(name), AnyOf(HasSubstr(bad), HasSubstr("not finite"), HasSubstr("cannot be read"))));
    }
  }
}

TEST(Robustness, EveryNumberOfASceneMustBeFinite) {
  for (const char* bad : {"nan", "inf", "-inf"})
    for (const std::string& line :
         {std::string("gravity = [0, BAD, 0]\n") + kCube, "[time]\nstep = BAD\n" + kCube,
          "[time]\nduration = BAD\n" + kCube, "[solver]\ntolerance = BAD\n" + kCube, kCube + "scale = BAD\n",
          kCube + "translate = [BAD, 0, 0]\n", kCube + "velocity = [0, 0, BAD]\n",
          kCube + "velocity = [\"1 / (X - X)\", 0, 0]\n", kCube + "deform = { displacement = [\"log(-1)\", 0, 0] }\n",
          kCube + "deform = { scale = BAD }\n", kCube + "material = { young = BAD }\n",
          kCube + "material = { young = \"0 / (X - X)\" }\n", kCube + "damping = { mass = BAD }\n",
          kCube + "[[body.spring]]\nedges = true\nstiffness = BAD\n",
          kCube + "[[body.traction]]\nwhere = \"all\"\ndead_pressure = BAD\n",
          kCube + "[[body.force]]\nvalue = [BAD, 0, 0]\n",
          kCube + "[[body.pin]]\nwhere = \"all\"\nmotion = { linear = { velocity = [BAD, 0, 0] } }\n"}) {
      std::string text = line;
      if (const size_t at = text.find("BAD"); at != std::string::npos) text.replace(at, 3, bad);
      EXPECT_THAT(refusal(text), HasSubstr("beam.toml:")) << text;
    }
}

// ---- numbers

struct Extreme {
  std::string name, material, body = "";
  std::string time = "[time]\nduration = 0.03\n";
};
void PrintTo(const Extreme& e, std::ostream* out) { *out << e.name; }

class Extremes : public testing::TestWithParam<Extreme> {};

TEST_P(Extremes, Converge) {
  const Extreme& e = GetParam();
  Scene scene = load(e.time + body(kBox, e.material, e.body + "[[body.pin]]\nwhere = { lowest = 0 }\n"));
  for (int i = 0; i < scene.steps; ++i) {
    const StepReport report = scene.simulation.step();
    const Explanation why = explain(scene.simulation, report);
    EXPECT_TRUE(is_success(report.status)) << "step " << i << " " << to_string(report.status) << ": " << why.cause
                                           << "; " << why.place << "; " << why.remedy;
  }
}

std::vector<Extreme> extremes() {
  std::vector<Extreme> all;
  for (int exponent = -6; exponent <= 3; ++exponent) {
    const double h = std::pow(10, exponent);
    all.push_back({"step_" + std::to_string(exponent + 6), "", "",
                   "[time]\nstep = " + text_of(h) + "\nduration = " + text_of(3 * h) + "\n"});
  }
  for (int exponent = 0; exponent <= 12; ++exponent)
    all.push_back({"young_1e" + std::to_string(exponent), "young = " + text_of(std::pow(10, exponent))});
  all.push_back({"contrast_of_stiffness", "young = \"X < 0.5 ? 1 : 1e12\""});
  all.push_back({"contrast_of_mass", "density = \"X < 0.5 ? 1 : 1e6\""});
  all.push_back({"nearly_incompressible", "poisson = 0.4999"});
  all.push_back({"far_away", "", "translate = [1e6, 1e6, 1e6]\n"});
  all.push_back({"flat_cells", "", "scale = [1, 1e-6, 1]\n"});
  return all;
}
// Needles whose strains are below the resolution of their positions.
TEST(Robustness, StepBeyondDoublePrecisionIsReported) {
  Scene scene = load("[time]\nduration = 0.01\n" +
                     body(kBox, "", "scale = [1e-6, 1, 1e-6]\n[[body.pin]]\nwhere = { lowest = 0 }\n"));
  const StepReport report = scene.simulation.step();
  EXPECT_EQ(report.status, Status::iteration_limit);
  EXPECT_THAT(explain(scene.simulation, report).cause, HasSubstr("round-off alone is"));
}

INSTANTIATE_TEST_SUITE_P(Numbers, Extremes, testing::ValuesIn(extremes()),
                         [](const auto& extreme) { return extreme.param.name; });

}  // namespace
}  // namespace aspic
