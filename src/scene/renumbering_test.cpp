// Results do not depend on the storage order of a model: the same scene from files with shuffled vertices and tets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/mesh_file.h"
#include "io/pc2.h"
#include "io/vtu.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "results/explanation.h"
#include "results/run_directory.h"
#include "scene/scene_cases_test.h"
#include "scene/value.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kRenumberedSteps = 3;
constexpr double kTolerance = 1e-10;  // [m], [m/s]: effect of the order of sums on solves to round-off

// A shape without symmetries.
TetMesh bar() {
  TetMesh mesh = make_box({{0, 0, 0}}, {{3, 1, 1.2}}, {5, 2, 2});
  for (Vec3d& X : mesh.rest)
    for (int r = 0; r < 3; ++r) X[r] += 0.03 * std::sin(7 * X[0] + 11 * X[1] + 5 * X[2] + r);
  for (int t = 0; t < mesh.tet_count(); ++t) mesh.region.push_back(1 + t % 3);
  return mesh;
}

// No element keeps its number: counts are even, so that (stride - 1) i + 11, which is odd, is no multiple of them.
Renumbering shuffled(size_t count, size_t stride) {
  std::vector<int> order(count);
  for (size_t i = 0; i < count; ++i) order[i] = static_cast<int>((i * stride + 11) % count);
  return Renumbering(order);
}

Numbering as_it_is() { return {}; }
Numbering shuffled(const TetMesh& mesh) { return {shuffled(mesh.rest.size(), 5), shuffled(mesh.tets.size(), 7)}; }

std::string csv_of(const std::vector<double>& values, int columns) {
  std::string text;
  for (size_t i = 0; i < values.size(); ++i)
    text += number_text(values[i]) + ((i + 1) % static_cast<size_t>(columns) == 0 ? "\n" : ",");
  return text;
}

std::vector<double> per_tet(const TetMesh& mesh, double base) {
  std::vector<double> values;
  for (int t = 0; t < mesh.tet_count(); ++t) values.push_back(base * (1 + 0.5 * std::sin(t)));
  return values;
}

// A scene with every kind of vertex and tet numbers, translated by `numbering`.
class Files {
 public:
  Files(fs::path where, const Numbering& numbering) : folder(std::move(where)), numbering_(numbering) {
    fs::create_directories(folder);
    const TetMesh mesh = from_user(numbering, bar());
    write_mesh(folder / "bar.msh", mesh);
    write_mesh(folder / "skin.obj", boundary_surface(make_box({{0.5, 0.3, 0.3}}, {{2, 0.7, 0.7}}, {4, 2, 2})).surface);
    write("young.csv", csv_of(numbering.tet.from_user(per_tet(bar(), 1e5)), 1));
    write("viscosity.csv", csv_of(numbering.tet.from_user(per_tet(bar(), 20)), 1));
    std::vector<double> u;
    for (size_t i = 0; i < 3 * mesh.rest.size(); ++i) u.push_back(0.01 * std::sin(static_cast<double>(i * i)));
    write("u.csv", csv_of(numbering.vertex.from_user(u, 3), 3));
    write_vtu(folder / "rho.vtu", {mesh.rest[0].a, 3 * mesh.rest.size()}, mesh.tets,
              {.cell_fields = {{"rho", 1, numbering.tet.from_user(per_tet(bar(), 1000))}}});
  }

  fs::path scene(const std::string& options = "") const {
    return write(
        "bar.toml",
        options + "[solver]\ntolerance = 1e-13\n[[body]]\nname = \"bar\"\nmesh = \"bar.msh\"\n" +
            "deform = { file = \"u.csv\" }\nvelocity = [\"Y\", 0, \"X\"]\nangular_velocity = [0, 1, 0]\n" +
            "material = { young = { file = \"young.csv\" }, poisson = { regions = { 1 = 0.2, 2 = 0.3, 3 = 0.4 } }, " +
            "density = { file = \"rho.vtu\", name = \"rho\" } }\n" +
            "damping = { viscosity = { file = \"viscosity.csv\" }, mass = 0.1, stiffness = 0.01 }\n" +
            "[[body.pin]]\nname = \"some\"\nwhere = " + vertices({0, 3, 7, 12}) + "\n" + "[[body.spring]]\nwhere = " +
            vertices({20, 31}) + "\nstiffness = 200\ntarget = [3, 2, 1]\n" + "[[body.spring]]\nbetween = [[" +
            vertex(25) + ", " + vertex(40) + "]]\nstiffness = 300\n" + "[[body.spring]]\nbetween = [[" + vertex(50) +
            ", 2]]\nto_body = \"box\"\nstiffness = 400\n" + "[[body.traction]]\nwhere = " + vertices(lowest()) +
            "\ndead_pressure = 50\n" + "[[body.force]]\nwhere = " + vertices(lowest()) + "\nvalue = [0, 100, \"X\"]\n" +
            "[[body]]\nname = \"box\"\nshape = { box = { lower = [4, 0, 0], upper = [5, 1, 1], cells = [2, 1, 1] } "
            "}\n" +
            "skin = \"skin.obj\"\ntranslate = [0, 0.5, 0]\n");
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  std::string vertex(int v) const { return std::to_string(numbering_.vertex.from_user(v)); }
  std::string vertices(const std::vector<int>& list) const {
    std::string text;
    for (const int v : list) text += (text.empty() ? "{ vertices = [" : ", ") + vertex(v);
    return text + "] }";
  }
  static std::vector<int> lowest() {
    std::vector<int> low;
    const TetMesh mesh = bar();
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.rest[v][1] < 0.6) low.push_back(v);
    return low;
  }

  const fs::path folder;

 private:
  Numbering numbering_;
};

// The numbering of both bodies; the second is generated.
Numbering of_scene(const Numbering& bar_numbering) {
  const TetMesh mesh = bar();
  Numbering all = bar_numbering;
  all.vertex.append(mesh.vertex_count(), {}, 12);
  all.tet.append(mesh.tet_count(), {}, 12);
  return all;
}

fs::path run(const Files& files, const char* folder, const std::string& options = "") {
  Scene scene = load_scene(files.scene(options));
  RunDirectory directory = RunDirectory::create(files.folder / folder, scene, ExistingRun::refuse);
  for (int i = 0; i < kRenumberedSteps; ++i) {
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status));
    directory.on_step(report, scene.simulation);
  }
  directory.finish(scene.simulation);
  return directory.path();
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance,
                 const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << what << ", entry " << i;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

std::vector<double> flat(const std::vector<Vec3d>& points) {
  std::vector<double> x;
  for (const Vec3d& p : points) x.insert(x.end(), p.a, p.a + 3);
  return x;
}

class Renumbered : public FolderTest {
 protected:
  const Numbering shuffle = of_scene(shuffled(bar()));
  const Files plain{path("plain"), as_it_is()}, other{path("shuffled"), shuffled(bar())};
};

TEST_F(Renumbered, ModelOrderDiffersFromFile) {
  const Scene scene = load_scene(plain.scene());
  EXPECT_FALSE(scene.simulation.model().numbering.vertex.is_identity());
  EXPECT_NE(positions(scene), scene.simulation.state().q);
}

TEST_F(Renumbered, FrameHasMeshOfFile) {
  for (const Files* files : {&plain, &other}) {
    const Vtu frame = read_vtu(run(*files, "run") / "frames" / "body_000000.vtu");
    const TetMesh mesh = read_tet_mesh(files->folder / "bar.msh");
    for (int t = 0; t < mesh.tet_count(); ++t) EXPECT_EQ(frame.mesh.tets[t], mesh.tets[t]);
    const auto label = std::find_if(frame.cell_fields.begin(), frame.cell_fields.end(),
                                    [](const Field& field) { return field.name == "region"; });
    for (int t = 0; t < mesh.tet_count(); ++t) EXPECT_EQ(label->values[t], mesh.region[t]);
  }
}

TEST_F(Renumbered, FramesAgreeFieldByField) {
  const fs::path a = run(plain, "run"), b = run(other, "run");
  for (const char* file : {"frames/body_000000.vtu", "frames/body_000003.vtu"}) {
    const Vtu one = read_vtu(a / file), two = read_vtu(b / file);
    EXPECT_EQ(to_user(shuffle, two.mesh).tets, one.mesh.tets);
    expect_near(shuffle.vertex.to_user(flat(two.mesh.rest), 3), flat(one.mesh.rest), kTolerance, "positions");
    ASSERT_GE(one.cell_fields.size(), 9u);
    for (size_t f = 0; f < one.point_fields.size(); ++f) {
      const Field &x = one.point_fields[f], &y = two.point_fields[f];
      expect_near(shuffle.vertex.to_user(y.values, y.components), x.values, 1e-6 * largest(x.values), x.name);
    }
    for (size_t f = 0; f < one.cell_fields.size(); ++f) {
      const Field &x = one.cell_fields[f], &y = two.cell_fields[f];
      expect_near(shuffle.tet.to_user(y.values, y.components), x.values, 1e-6 * largest(x.values), x.name);
    }
  }
}

TEST_F(Renumbered, VerticesPinnedByNumberStay) {
  const fs::path a = run(plain, "run");
  const Vtu first = read_vtu(a / "frames/body_000000.vtu"), last = read_vtu(a / "frames/body_000003.vtu");
  std::vector<int> still;
  for (int v = 0; v < bar().vertex_count(); ++v)
    if (distance(first.mesh.rest[v], last.mesh.rest[v]) == 0) still.push_back(v);
  EXPECT_EQ(still, (std::vector<int>{0, 3, 7, 12}));
}

TEST_F(Renumbered, ParametersKeepUsersOrder) {
  const Vtu frame = read_vtu(run(plain, "run") / "frames/body_000000.vtu");
  std::map<std::string, std::vector<double>> fields;
  for (const Field& field : frame.cell_fields) fields[field.name] = field.values;
  for (int t = 0; t < bar().tet_count(); ++t) {
    EXPECT_NEAR(fields["young"][t], per_tet(bar(), 1e5)[t], 0.1);
    EXPECT_NEAR(fields["poisson"][t], 0.1 * (1 + bar().region[t]), 1e-7);
    EXPECT_NEAR(fields["density"][t], per_tet(bar(), 1000)[t], 1e-3);
    EXPECT_EQ(fields["body"][t], 0);
  }
}

TEST_F(Renumbered, SkinsMoveAlike) {
  const fs::path a = run(plain, "run"), b = run(other, "run");
  Pc2File one = Pc2File::resume(a / "skins/skin_box.pc2", read_tri_mesh(plain.folder / "skin.obj").vertex_count(), 4);
  Pc2File two = Pc2File::resume(b / "skins/skin_box.pc2", read_tri_mesh(plain.folder / "skin.obj").vertex_count(), 4);
  for (int frame = 0; frame <= kRenumberedSteps; ++frame) {
    const auto x = one.sample(frame), y = two.sample(frame);
    ASSERT_EQ(x.size(), y.size());
    for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 1e-6);
  }
}

TEST_F(Renumbered, BoundaryBelongsToBody) {
  const BoundarySurface boundary = boundary_surface(bar());
  const fs::path results = run(plain, "run");
  EXPECT_EQ(read_tri_mesh(results / "skins/skin_bar.obj").triangles, boundary.surface.triangles);
  const auto skin =
      Pc2File::resume(results / "skins/skin_bar.pc2", boundary.surface.vertex_count(), 4).sample(kRenumberedSteps);
  const Vtu frame = read_vtu(results / "frames/body_000003.vtu");
  for (size_t i = 0; i < boundary.tet_vertex.size(); ++i)
    for (int r = 0; r < 3; ++r)
      EXPECT_EQ(skin[3 * i + r], static_cast<float>(frame.mesh.rest[boundary.tet_vertex[i]][r]));
}

TEST_F(Renumbered, TablesAgree) {
  Scene one = load_scene(plain.scene()), two = load_scene(other.scene());
  for (int i = 0; i < kRenumberedSteps; ++i) {
    const StepReport x = one.simulation.step(), y = two.simulation.step();
    EXPECT_EQ(x.iterations, y.iterations);
    EXPECT_NEAR(x.kinetic, y.kinetic, 1e-8 * x.kinetic);
    EXPECT_NEAR(x.min_det_F, y.min_det_F, kTolerance);
    ASSERT_EQ(x.potential.size(), y.potential.size());
    for (size_t k = 0; k < x.potential.size(); ++k) EXPECT_NEAR(x.potential[k], y.potential[k], 1e-6);
  }
}

TEST_F(Renumbered, CheckpointsHoldTheUsersNumbers) {
  const std::string multistep = "[time]\nintegrator = \"bdf2\"\n";  // stores the previous step
  const fs::path a = run(plain, "run", multistep), b = run(other, "run", multistep);
  const Checkpoint one = read_checkpoint(a / "checkpoint.bin"), two = read_checkpoint(b / "checkpoint.bin");
  for (const char* name : {"q", "qdot", "start_q", "start_qdot"})
    expect_near(shuffle.vertex.to_user(two.array(name), 3), one.array(name), 1e-8, name);
  const std::vector<double>&x = one.array("history"), &y = two.array("history");
  const std::ptrdiff_t n = 3 * static_cast<std::ptrdiff_t>(bar().vertex_count() + 12);
  ASSERT_EQ(static_cast<std::ptrdiff_t>(x.size()), 2 + 2 * n);
  ASSERT_EQ(x.size(), y.size());
  for (const std::ptrdiff_t first : {std::ptrdiff_t{2}, 2 + n})
    expect_near(shuffle.vertex.to_user({y.begin() + first, y.begin() + first + n}, 3),
                {x.begin() + first, x.begin() + first + n}, 1e-8, "history");
}

TEST_F(Renumbered, ResumedRunIsBitReproducible) {
  const fs::path whole = run(plain, "whole"), part = plain.folder / "part";
  {
    Scene scene = load_scene(plain.scene("output = { checkpoint_every = 0.0 }\n"));
    scene.resolved = load_scene(plain.scene()).resolved;
    RunDirectory directory = RunDirectory::create(part, scene, ExistingRun::refuse);
    directory.on_step(scene.simulation.step(), scene.simulation);
  }
  Scene scene = load_scene(plain.scene());
  RunDirectory directory = RunDirectory::resume(part, scene);
  ASSERT_EQ(scene.simulation.steps_taken(), 1);
  while (scene.simulation.steps_taken() < kRenumberedSteps) {
    const StepReport report = scene.simulation.step();
    directory.on_step(report, scene.simulation);
  }
  directory.finish(scene.simulation);
  for (const char* file : {"frames/body_000003.vtu", "checkpoint.bin", "steps.csv", "skins/skin_box.pc2"})
    EXPECT_EQ(read_file(part / file), read_file(whole / file)) << file;
}

TEST_F(Renumbered, ExplanationsNameTheUsersVertex) {
  const std::string explicit_scheme = "[time]\nstep = 0.5\nintegrator = \"symplectic_euler\"\n";
  const auto place = [&](const Files& files) {
    Scene scene = load_scene(files.scene(explicit_scheme));
    StepReport report = scene.simulation.step();
    for (int i = 0; i < 100 && report.status != Status::undefined; ++i) report = scene.simulation.step();
    return explain(scene.simulation, report).place;
  };
  const std::string first = place(plain);
  int vertex = -1;
  ASSERT_EQ(std::sscanf(first.c_str(), "vertex %d of body 'bar'", &vertex), 1) << first;
  EXPECT_THAT(place(other), HasSubstr("vertex " + other.vertex(vertex) + " of body 'bar' has the strongest damping"));
}

TEST_F(Renumbered, ErrorsNameTheUsersVerticesAndTets) {
  for (const Files* files : {&plain, &other}) {
    const std::string twice = "[[body]]\nmesh = \"bar.msh\"\n[[body.pin]]\nwhere = " + files->vertices({4, 9}) +
                              "\n[[body.pin]]\nwhere = " + files->vertices({9, 11}) +
                              "\nmotion = { linear = { velocity = [0, 1, 0] } }\n";
    EXPECT_THAT(refusal_of(files->write("s.toml", twice)), HasSubstr("vertex " + files->vertex(9) + " of body"));

    TetMesh mesh = read_tet_mesh(files->folder / "bar.msh");
    std::vector<double> u(3 * mesh.rest.size(), 0.0);
    const int moved = std::stoi(files->vertex(30));
    u[3 * moved] = 20;
    files->write("far.csv", csv_of(u, 3));
    mesh.rest[moved][0] += 20;
    std::string inverted;
    for (int t = 0, count = 0; t < mesh.tet_count() && count < 5; ++t)
      if (!(volume(mesh, t) > 0)) inverted += (count++ > 0 ? ", " : "(") + std::to_string(t);
    const std::string flipped =
        "[[body]]\nmesh = \"bar.msh\"\nmaterial = { model = \"neo_hookean_log\" }\ndeform = { file = \"far.csv\" }\n";
    EXPECT_THAT(refusal_of(files->write("s.toml", flipped)),
                testing::AllOf(HasSubstr("are inverted or flat"), HasSubstr(inverted)));
  }
}

}  // namespace
}  // namespace aspic
