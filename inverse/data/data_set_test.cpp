// Format of measurements: round trip, foreign files, and error messages.
#include "data/data_set.h"

#include <gmock/gmock.h>

#include "data/capture_cases_test.h"
#include "data/case_table.h"
#include "mesh/surface.h"
#include "model/gauge.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

void expect_equal(const Vec3d& a, const Vec3d& b) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(a[i], b[i]);
}
void expect_equal(const std::optional<Vec3d>& a, const std::optional<Vec3d>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (a) expect_equal(*a, *b);
}

void expect_equal(const LoadCase& a, const LoadCase& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.group, b.group);
  ASSERT_EQ(a.indenter.has_value(), b.indenter.has_value());
  if (a.indenter) {
    EXPECT_EQ(a.indenter->shape, b.indenter->shape);
    EXPECT_EQ(a.indenter->contact, b.indenter->contact);
    EXPECT_EQ(a.indenter->radius, b.indenter->radius);
    EXPECT_EQ(a.indenter->stiffness, b.indenter->stiffness);
    expect_equal(a.touch.center, b.touch.center);
    expect_equal(a.touch.axis, b.touch.axis);
    expect_equal(a.pose.center, b.pose.center);
    expect_equal(a.pose.axis, b.pose.axis);
    expect_equal(a.pose.rotation, b.pose.rotation);
  }
  ASSERT_EQ(a.grip.has_value(), b.grip.has_value());
  if (a.grip) {
    EXPECT_EQ(a.grip->vertices, b.grip->vertices);
    EXPECT_EQ(a.grip->radius, b.grip->radius);
    expect_equal(a.grip->center, b.grip->center);
    expect_equal(a.grip->displacement, b.grip->displacement);
    expect_equal(a.grip->rotation, b.grip->rotation);
  }
  expect_equal(a.gravity, b.gravity);
  EXPECT_EQ(a.pressure, b.pressure);
  EXPECT_EQ(a.is_dead_pressure, b.is_dead_pressure);
  EXPECT_EQ(a.pressed, b.pressed);
  expect_equal(a.force, b.force);
  expect_equal(a.torque, b.torque);
  if (a.force) expect_equal(a.force_sigma, b.force_sigma);
  if (a.torque) expect_equal(a.torque_sigma, b.torque_sigma);
  ASSERT_EQ(a.positions.size(), b.positions.size());
  for (size_t i = 0; i < a.positions.size(); ++i) {
    EXPECT_EQ(a.positions[i].marker, b.positions[i].marker);
    expect_equal(a.positions[i].position, b.positions[i].position);
    expect_equal(a.positions[i].sigma, b.positions[i].sigma);
  }
}

class DataSetFile : public FolderTest {
 protected:
  // A data set as written by a measuring program; `settings` are inserted before [[tip]].
  std::filesystem::path measured(const std::string& settings = "") {
    write_mesh(path("rest.msh"), test_box());
    folder.write("markers.csv", "marker,x,y,z\nA,0.05,0.04,0.0601\nB,0.02,0.03,0.06\n");
    folder.write("cases.csv",
                 "case,group,touch_x,touch_y,touch_z,depth,force_x,force_y,force_z,force_sd\n"
                 "deep,p,0.05,0.04,0.07,0.004,0,0,-1,0.01\nshallow,p,0.05,0.04,0.07,0.002,,,,\n");
    folder.write("positions.csv", "case,marker,x,y,z,sd\ndeep,A,0.05,0.04,0.056,1e-4\nshallow,B,0.02,0.03,0.0599,\n");
    folder.write("capture.toml", "version = 1\nmesh = \"rest.msh\"\norder = 1\nfixed = \"z < 1e-9\"\n" + settings +
                                     "\n[[tip]]\nradius = 0.01\n");
    return folder;
  }
  std::string refusal() {
    return message_of([&] { read_data_set(folder); });
  }
};

TEST_F(DataSetFile, ReadsBackToTheSameBits) {
  DataSet data = test_data();
  LoadCase& turned = data.experiment.cases[1];
  turned.pose.rotation = {{0.1, -0.2, 0.3}};
  turned.pose.axis = turned_axis(turned.touch, turned.pose.rotation);
  turned.torque = Vec3d{{1e-3, 2e-3, -1e-3}};
  turned.torque_sigma = {{1e-4, 2e-4, 3e-4}};
  data.experiment.cases[2].force.reset();
  data.experiment.cases[2].positions.pop_back();
  LoadCase hung;
  hung.name = hung.group = "hung, upside down";
  hung.gravity = {{0, 0.1, 9.81}};
  hung.positions = data.experiment.cases[0].positions;
  LoadCase pressed = hung;
  pressed.name = pressed.group = "say \"press\"";
  pressed.gravity = {};
  pressed.pressure = 123.456;
  const std::vector<Triangle> surface = boundary_triangles(data.experiment.mesh, 0, data.experiment.mesh.tet_count());
  pressed.pressed.assign(surface.begin(), surface.begin() + 7);
  data.experiment.cases.push_back(hung);
  data.experiment.cases.push_back(pressed);
  pressed.name = pressed.group = "press at rest";
  pressed.is_dead_pressure = true;
  data.experiment.cases.push_back(pressed);
  const TetMesh& mesh = data.experiment.mesh;
  Grip top{.center = {{0.051, 0.04, 0.06}}, .displacement = {{0, 1e-3, 2e-3}}, .rotation = {{0.1, 0, -0.2}}};
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.rest[v][2] > 0.06 - 1e-9) top.vertices.push_back(v);
  for (const int v : top.vertices) top.radius = std::max(top.radius, norm(mesh.rest[v] - top.center));
  LoadCase gripped = hung;
  gripped.name = gripped.group = "gripped";
  gripped.grip = top;
  gripped.force = gripped.torque = Vec3d{{0.1, 0.2, 0.3}};
  gripped.force_sigma = gripped.torque_sigma = {{0.01, 0.01, 0.02}};
  data.experiment.cases.push_back(gripped);
  for (size_t t = 0; t < data.experiment.density.size(); ++t) data.experiment.density[t] = 1000 + 1.0 / (1 + t);

  write_data_set(folder / "data", data);
  const DataSet again = read_data_set(folder / "data");
  EXPECT_EQ(again.name, data.name);
  EXPECT_EQ(again.marker_names, data.marker_names);
  EXPECT_THAT(again.notes, ElementsAre());
  const Experiment &a = data.experiment, &b = again.experiment;
  EXPECT_EQ(a.mesh.tets, b.mesh.tets);
  for (int v = 0; v < a.mesh.vertex_count(); ++v) expect_equal(a.mesh.rest[v], b.mesh.rest[v]);
  EXPECT_EQ(a.fixed, b.fixed);
  EXPECT_EQ(a.density, b.density);
  ASSERT_EQ(a.markers.size(), b.markers.size());
  for (size_t m = 0; m < a.markers.size(); ++m) {
    EXPECT_EQ(a.markers[m].vertices, b.markers[m].vertices);
    EXPECT_EQ(a.markers[m].weights, b.markers[m].weights);
  }
  ASSERT_EQ(a.cases.size(), b.cases.size());
  for (size_t c = 0; c < a.cases.size(); ++c) expect_equal(a.cases[c], b.cases[c]);
}

TEST_F(DataSetFile, ChoosesAndReportsUnstatedValues) {
  const DataSet data = read_data_set(measured());
  const Experiment& e = data.experiment;
  ASSERT_EQ(e.cases.size(), 2u);
  EXPECT_EQ(e.cases[0].name, "shallow");  // from the smallest load on
  EXPECT_EQ(data.source.load_case(0), "cases.csv:3");
  EXPECT_EQ(data.source.position(1, 0), "positions.csv:2");
  EXPECT_FALSE(e.cases[0].force.has_value());
  const LoadCase& deep = e.cases[1];
  EXPECT_NEAR(deep.pose.center[2], 0.066, 1e-15);
  expect_equal(deep.touch.axis, {{0, 0, -1}});  // into the surface
  EXPECT_EQ(deep.indenter->contact, IndenterContact::sliding);
  EXPECT_GT(deep.indenter->stiffness, 0);
  EXPECT_EQ(deep.positions[0].sigma[1], 1e-4);
  EXPECT_GT(e.cases[0].positions[0].sigma[1], 0);
  EXPECT_NEAR(data.marker_gap[0], 1e-4, 1e-15);
  EXPECT_NEAR(deep.positions[0].position[2], 0.0559, 1e-15);  // displacement from the surface point
  EXPECT_EQ(e.fixed.size(), 30u);
  EXPECT_THAT(data.notes, testing::Contains(HasSubstr("standard deviation of positions")));
  EXPECT_THAT(data.notes, testing::Contains(HasSubstr("layer of the tip")));
}

TEST_F(DataSetFile, AcceptsUnitsAndColumnNamesOfOtherPrograms) {
  measured(
      "units = { length = \"mm\", mesh = \"m\", force = \"g\", angle = \"deg\" }\n"
      "columns = { x = \"X [mm]\", y = \"Y [mm]\", z = \"Z [mm]\", cases = { force_z = \"Scale\" } }\n"
      "force_of = \"body\"");
  folder.write("markers.csv", "marker;X [mm];Y [mm];Z [mm]\nA;50,0;40,0;60,0\n");
  folder.write("cases.csv",
               "case\ttouch_x\ttouch_y\ttouch_z\tdepth\trotation_x\trotation_y\trotation_z\tforce_x\tforce_y\tScale\n"
               "1\t50\t40\t70\t4\t0\t0\t90\t0\t0\t250");
  folder.write("positions.csv", "case,marker,X [mm],Y [mm],Z [mm]\n1,A,50,40,56\n");
  folder.write("capture.toml",
               "version = 1\nmesh = \"rest.msh\"\norder = 1\nforce_of = \"body\"\nfixed = [0, 4]\n"
               "units = { length = \"mm\", mesh = \"m\", force = \"g\", angle = \"deg\" }\n"
               "columns = { x = \"X [mm]\", y = \"Y [mm]\", z = \"Z [mm]\", cases = { force_z = \"Scale\" } }\n"
               "[[tip]]\nradius = 10\n");
  const DataSet data = read_data_set(folder);
  const LoadCase& load = data.experiment.cases[0];
  EXPECT_NEAR((*load.force)[2], -0.25 * 9.80665, 1e-14);
  EXPECT_NEAR(load.pose.rotation[2], 1.5707963267948966, 1e-15);
  EXPECT_NEAR(load.pose.center[2], 0.066, 1e-15);
  EXPECT_NEAR(load.positions[0].position[2], 0.056, 1e-15);
  EXPECT_EQ(data.experiment.fixed.size(), 2u);
}

TEST_F(DataSetFile, AxialForceLeavesLateralForceUndetermined) {
  measured();
  folder.write("cases.csv", "case,touch_x,touch_y,touch_z,depth,force,force_sd\n1,0.05,0.04,0.07,0.004,2,0.01\n");
  folder.write("positions.csv", "case,marker,x,y,z\n1,A,0.05,0.04,0.056\n");
  const LoadCase load = read_data_set(folder).experiment.cases[0];
  expect_equal(*load.force, {{0, 0, -2}});
  ASSERT_TRUE(load.gauge);
  expect_equal(*load.gauge, {{0, 0, -1}});
  EXPECT_NEAR(gauge_sigma(load.gauge, load.force_sigma)[0], 0.01, 1e-12);
  EXPECT_EQ(measured_count(load), 3 + 1);
}

TEST_F(DataSetFile, PatchesAndMarkersAtVerticesAreFound) {
  measured("[[patch]]\nname = \"top\"\nwhere = { highest = 0.001 }");
  folder.write("capture.toml",
               "version = 1\nmesh = \"rest.msh\"\norder = 1\nup = [0, 0, 2]\nfixed = { lowest = 0.0 }\n[[patch]]\nname "
               "= \"top\"\n"
               "where = { highest = 0.001 }\n");
  const int top_corner = 3;  // of x = y = 0, z = 0.06
  folder.write("markers.csv", "vertex\n" + std::to_string(top_corner) + "\n");
  folder.write("cases.csv", "case,pressure\nblown,-500\n");
  folder.write("positions.csv", "marker,x,y,z\n0,0,0,0.061\n");
  const DataSet data = read_data_set(folder);
  EXPECT_EQ(data.experiment.cases[0].pressure, -500);
  EXPECT_FALSE(data.experiment.cases[0].is_dead_pressure);
  EXPECT_EQ(data.experiment.cases[0].pressed.size(), 2u * 5 * 4);
  expect_equal(position(data.experiment.markers[0], data.experiment.mesh.rest), {{0, 0, 0.06}});
  EXPECT_EQ(data.experiment.fixed.size(), 30u);
}

TEST_F(DataSetFile, DeadPressureHasItsOwnColumn) {
  measured("[[patch]]\nname = \"top\"\nwhere = { highest = 0.001 }");
  folder.write("cases.csv", "case,dead_pressure\nblown,-500\n");
  folder.write("positions.csv", "marker,x,y,z\nA,0,0,0.061\n");
  const DataSet data = read_data_set(folder);
  EXPECT_EQ(data.experiment.cases[0].pressure, -500);
  EXPECT_TRUE(data.experiment.cases[0].is_dead_pressure);
  folder.write("cases.csv", "case,pressure,dead_pressure\nblown,100,-500\n");
  EXPECT_THAT(refusal(), HasSubstr("cases.csv:2: the columns pressure and dead_pressure exclude each other"));
}

TEST_F(DataSetFile, BadCellsAreReportedTogetherWithRemedies) {
  measured();
  folder.write("positions.csv",
               "case,marker,x,y,z,sd\ndeep,A,nan,0.04,0.056,1e-4\ndeep,B,0.02,0.03,0.06,-1\nshallow,A,0.05,,0.06,1e-4\n"
               "shalow,A,0.05,0.04,0.06,1e-4\nshallow,B,0.02,0.03,six,1\nshallow,B,,,,\n");
  const std::string text = refusal();
  EXPECT_THAT(text, HasSubstr("positions.csv:2: x = 'nan' is not a finite number"));
  EXPECT_THAT(text, HasSubstr("positions.csv:3: sd = -1; a standard deviation must be > 0"));
  EXPECT_THAT(text, HasSubstr("positions.csv:4: x, y, z: some are blank"));
  EXPECT_THAT(text,
              HasSubstr("positions.csv:5: case = 'shalow' is not in the table of cases (did you mean 'shallow'?)"));
  EXPECT_THAT(text, HasSubstr("positions.csv:6: z = 'six'"));
}

TEST_F(DataSetFile, NamesAreGivenOnce) {
  measured();
  folder.write("markers.csv", "marker,x,y,z\nA,0.05,0.04,0.06\nA,0.02,0.03,0.06\n");
  folder.write("cases.csv", "case,touch_x,touch_y,touch_z,depth\n1,0.05,0.04,0.07,0.004\n1,0.05,0.04,0.07,0.004\n");
  folder.write("positions.csv", "case,marker,x,y,z\n1,A,0.05,0.04,0.056\n1,A,0.05,0.04,0.056\n");
  const std::string text = refusal();
  EXPECT_THAT(text, HasSubstr("markers.csv:3: the marker 'A' already occurs in line 2"));
  EXPECT_THAT(text, HasSubstr("cases.csv:3: the case '1' already occurs in line 2"));
  EXPECT_THAT(text, HasSubstr("positions.csv:3: this marker was given for this case in line 2 already"));
}

TEST_F(DataSetFile, MarkerFarOffSurfaceGetsUnitHint) {
  measured();
  folder.write("markers.csv", "marker,x,y,z\nA,50,40,60\nB,0.02,0.03,0.06\n");
  EXPECT_THAT(refusal(), HasSubstr("markers.csv:2: the marker lies 87.6 m off"));
  EXPECT_THAT(refusal(), HasSubstr("units = { length = \"mm\" }"));
}

TEST_F(DataSetFile, MissingFilesColumnsAndUnknownKeysAreNamed) {
  EXPECT_THAT(message_of([&] { read_data_set(folder / "nowhere"); }), HasSubstr("does not exist"));
  EXPECT_THAT(refusal(), HasSubstr("has no capture.toml"));
  measured();
  folder.write("capture.toml", "version = 1\nmesh = \"rost.msh\"\n");
  EXPECT_THAT(refusal(), HasSubstr("did you mean 'rest.msh'"));
  folder.write("capture.toml", "version = 1\nmash = \"rest.msh\"\n");
  EXPECT_THAT(refusal(), HasSubstr("did you mean 'mesh'"));
  folder.write("capture.toml", "version = 2\nmesh = \"rest.msh\"\n");
  EXPECT_THAT(refusal(), HasSubstr("version = 2; must be"));
  folder.write("capture.toml", "version = 1\nmesh = \"rest.msh\"\nunits = { force = \"gram\" }\n");
  EXPECT_THAT(refusal(), HasSubstr("force = \"gram\"; unknown name"));
  measured("columns = { x = \"X\" }");
  EXPECT_THAT(refusal(), HasSubstr("has no column 'X'"));
  measured();
  folder.write("positions.csv", "case,marker,x,y\ndeep,A,1,2\n");
  EXPECT_THAT(refusal(), HasSubstr("positions.csv:1: has no column z"));
  folder.write("positions.csv", "");
  EXPECT_THAT(refusal(), HasSubstr("is empty"));
  folder.write("positions.csv", "case,marker,x,y,z\ndeep,A,1,2\n");
  EXPECT_THAT(refusal(), HasSubstr("has 4 cells"));
  measured();
  folder.write("cases.csv", "case,group\n");
  EXPECT_THAT(refusal(), HasSubstr("has no cases"));
  folder.write("cases.csv", "case,tip,touch_x,touch_y,touch_z\n1,tipp,0.05,0.04,0.07\n");
  EXPECT_THAT(refusal(), HasSubstr("tip = 'tipp' is unknown"));
  folder.write("cases.csv", "case,touch_x,touch_y,touch_z\n1,0.05,0.04,0.07\n");
  EXPECT_THAT(refusal(), HasSubstr("the pose of the indenter is incomplete"));
  folder.write("cases.csv", "case,force_x,force_y,force_z\n1,0,0,1\n");
  EXPECT_THAT(refusal(), HasSubstr("no indenter"));
}

TEST_F(DataSetFile, TriangleMeshesAndInvertedTetsAreRefused) {
  measured();
  TetMesh inverted = test_box();
  std::swap(inverted.tets[3][0], inverted.tets[3][1]);
  write_mesh(path("rest.msh"), inverted);
  EXPECT_THAT(refusal(), HasSubstr("inverted"));
  write_mesh(path("rest.msh"), boundary_surface(test_box()).surface);
  EXPECT_THAT(refusal(), HasSubstr("tet"));
}

TEST_F(DataSetFile, InteriorAndMissingVerticesAreNoMarkers) {
  measured();
  const TetMesh box = test_box();
  int inside = 0;
  while (!(box.rest[inside][0] > 0.01 && box.rest[inside][1] > 0.01 && box.rest[inside][2] > 0.01 &&
           box.rest[inside][0] < 0.09 && box.rest[inside][1] < 0.07 && box.rest[inside][2] < 0.05))
    ++inside;
  folder.write("markers.csv", "marker,vertex\nA," + std::to_string(inside) + "\nB,100000\n");
  EXPECT_THAT(refusal(), HasSubstr("markers.csv:2: vertex = " + std::to_string(inside) + " is inside the body"));
  EXPECT_THAT(refusal(), HasSubstr("markers.csv:3: vertex = 100000; the mesh has the vertices 0 to"));
}

TEST_F(DataSetFile, VerticesOutsideTrianglesOfAScanDoNotCount) {
  measured("scan = \"scan.obj\"\n");
  std::string scan = "v 0 0 0\nv 0.1 0 0\nv 0 0.08 0\nv 0.05 0.04 0.03\nv 0 0 0.06\nv 9 9 9\n";
  folder.write("scan.obj", scan + "f 1 2 3\nf 1 2 5\nf 1 3 5\n");
  const DataSet data = read_data_set(folder, RegistrationKind::rigid);
  EXPECT_EQ(data.registration->points, 4);
  EXPECT_LT(data.registration->largest, 1e-6);
}

TEST_F(DataSetFile, ReadsMotionsOfGrips) {
  measured(
      "units = { length = \"mm\", mesh = \"m\", angle = \"deg\" }\n[[grip]]\nname = \"top\"\nwhere = \"z > 0.0599\"\n");
  folder.write("markers.csv", "marker,x,y,z\nA,50,40,60\n");
  std::filesystem::remove(path("positions.csv"));
  folder.write("cases.csv", "case,grip,move_x,move_y,move_z,force,torque_x,torque_y,torque_z\npull,,0,3,4,3,,,\n");
  const LoadCase load = read_data_set(folder).experiment.cases[0];
  ASSERT_TRUE(load.grip);
  EXPECT_EQ(load.grip->vertices.size(), 30u);  // 6 x 5
  EXPECT_NEAR(norm(load.grip->center - Vec3d{{0.05, 0.04, 0.06}}), 0, 1e-15);
  EXPECT_NEAR(norm(load.grip->displacement - Vec3d{{0, 0.003, 0.004}}), 0, 1e-15);
  EXPECT_NEAR(norm(*load.force - Vec3d{{0, 1.8, 2.4}}), 0, 1e-12);  // along the motion
  EXPECT_NEAR(load_size(load), 0.005, 1e-15);
}

TEST_F(DataSetFile, MissingColumnsOfGripsAreZeroOrUnmeasured) {
  measured("units = { length = \"mm\", mesh = \"m\" }\n[[grip]]\nname = \"clamp\"\nwhere = \"z > 0.0599\"\n");
  folder.write("markers.csv", "marker,x,y,z\nA,50,40,60\n");
  std::filesystem::remove(path("positions.csv"));
  // The example in inverse/docs/capture_format.md.
  folder.write("cases.csv",
               "case,grip,move_x,move_y,move_z,rotation_z,force_z,torque_z\n"
               "pull 2 mm,clamp,0,0,2,,0.61,\n"
               "twist,clamp,,,,0.3,,0.004\n");
  const DataSet data = read_data_set(folder);
  const LoadCase &pull = data.experiment.cases[0], &twist = data.experiment.cases[1];
  EXPECT_EQ(pull.name, "pull 2 mm");
  expect_equal(*pull.force, {{0, 0, 0.61}});
  expect_equal(*pull.gauge, {{0, 0, 1}});
  EXPECT_NEAR(pull.force_sigma[2], 0.01 * 0.61, 1e-12);
  EXPECT_FALSE(pull.torque);
  expect_equal(twist.grip->rotation, {{0, 0, 0.3}});
  expect_equal(twist.grip->displacement, {{0, 0, 0}});
  EXPECT_NEAR((*twist.torque)[2], 4e-6, 1e-18);
  expect_equal(*twist.torque_gauge, {{0, 0, 1}});
  EXPECT_EQ(measured_count(twist), 1);

  folder.write("cases.csv", "case,grip,move_z,force_z,force_sd_z\npull,clamp,2,0.61,0.02\n");
  const LoadCase own = read_data_set(folder).experiment.cases[0];
  EXPECT_NEAR(own.force_sigma[2], 0.02, 1e-15);
  EXPECT_NEAR(own.grip->displacement[2], 2e-3, 1e-15);
  folder.write("cases.csv", "case,grip,move_z,force_x,force_z\npull,clamp,2,0,0.61\n");
  EXPECT_THAT(refusal(),
              HasSubstr("cases.csv:2: force_x, force_y, force_z: there is no column force_y; add it, with 0"));
  folder.write("cases.csv", "case,grip,move_x,move_z\npull,clamp,,2\n");
  EXPECT_THAT(refusal(), HasSubstr("cases.csv:2: move_x, move_y, move_z: some are blank"));
}

TEST_F(DataSetFile, RefusesGripsWithPlaceAndRemedy) {
  const auto refusal_of = [&](const std::string& grip, const std::string& cases) {
    measured(grip);
    folder.write("cases.csv", cases);
    return refusal();
  };
  const std::string top = "[[grip]]\nwhere = \"z > 0.0599\"\n";
  EXPECT_THAT(refusal_of("[[grip]]\nwhere = \"z < 0.03\"\n", "case,move_x,move_y,move_z\ndeep,0,0,1e-3\n"),
              HasSubstr("is fixed; leave it out here or in fixed"));
  EXPECT_THAT(refusal_of("", "case,grip,move_x,move_y,move_z\ndeep,top,0,0,1e-3\n"),
              HasSubstr("cases.csv:2: there is no grip; describe it as [[grip]] in capture.toml"));
  EXPECT_THAT(refusal_of(top, "case,grip,force\ndeep,grip,1\n"),
              HasSubstr("cases.csv:2: the motion of the grip is missing; give move_x, move_y, move_z"));
  EXPECT_THAT(refusal_of(top,
                         "case,grip,move_x,move_y,move_z,touch_x,touch_y,touch_z,depth\n"
                         "deep,grip,0,0,1e-3,0.05,0.04,0.07,0.001\n"),
              HasSubstr("cases.csv:2: has an indenter and a grip"));
  EXPECT_THAT(refusal_of(top, "case,grip,rotation_x,rotation_y,rotation_z,force\ndeep,grip,0,0,0.1,1\n"),
              HasSubstr("the grip, which only rotates; give force_x, force_y, force_z"));
}

TEST_F(DataSetFile, SmallMeshesAreQuadraticByDefault) {
  measured();
  const auto experiment = [&](const std::string& order) {
    folder.write("capture.toml",
                 "version = 1\nmesh = \"rest.msh\"\nfixed = \"z < 1e-9\"\n" + order + "\n[[tip]]\nradius = 0.01\n");
    return read_data_set(folder).experiment;
  };
  EXPECT_TRUE(experiment("order = 1").mesh.mids.empty());
  const Experiment quadratic = experiment("");
  EXPECT_EQ(quadratic.mesh.mids.size(), test_box().tets.size());
  EXPECT_EQ(quadratic.fixed.size(), 99u);  // 11 x 9
  write_mesh(path("rest.msh"), make_box({{0, 0, 0}}, {{0.1, 0.08, 0.06}}, {10, 8, 6}));
  EXPECT_TRUE(experiment("").mesh.mids.empty());  // 2880 tets
}

TEST_F(DataSetFile, TorquesAloneAreData) {
  const auto twist = [&](const std::string& settings, const std::string& columns) {
    measured(settings + "\n[[grip]]\nname = \"top\"\nwhere = \"z > 0.0599\"\n");
    std::filesystem::remove(path("positions.csv"));
    folder.write("cases.csv", "case,group,grip,rotation_x,rotation_y,rotation_z,torque_z,torque_x,torque_y" + columns);
  };
  twist("", "\ntwist,g,top,0,0,0.1,0.02,0,0\n");
  EXPECT_THAT(read_data_set(folder).notes, testing::Contains(HasSubstr("only forces and torques are fitted")));
  twist("errors = { backlash = 1e-4 }", "\ntwist,g,top,0,0,0.1,0.02,0,0\n");
  EXPECT_THAT(refusal(), HasSubstr("that is displaced (rotations have no backlash); remove the key"));
  twist("steady = \"history\"", ",time\nstart,g,top,0,0,0,0,0,0,0\ntwist,g,top,0,0,0.1,0.02,0,0,1\n");
  EXPECT_THAT(refusal(), HasSubstr("torques of loads that vary in time (steady = \"history\") are not fitted"));
}

TEST_F(DataSetFile, ForcesAloneAreData) {
  measured();
  std::filesystem::remove(path("positions.csv"));
  const DataSet data = read_data_set(folder);
  EXPECT_TRUE(data.experiment.cases[0].positions.empty());
  EXPECT_THAT(data.notes, testing::Contains(HasSubstr("only forces are fitted")));
}

TEST_F(DataSetFile, ForcesAloneNeedNoMarkers) {
  measured();
  folder.write("positions.csv", "case,marker,x,y,z\n");
  EXPECT_THAT(read_data_set(folder).notes,
              testing::Contains(HasSubstr("positions.csv has no row below its header: only forces are fitted")));
  std::filesystem::remove(path("markers.csv"));
  EXPECT_THAT(refusal(), HasSubstr("there is no markers.csv, but positions.csv has positions of markers; add it with"));
  std::filesystem::remove(path("positions.csv"));
  const DataSet data = read_data_set(folder);
  EXPECT_TRUE(data.marker_names.empty());
  EXPECT_TRUE(data.experiment.cases[1].force);
}

// A coordinate that was not measured has a huge standard deviation, which turns with the registration.
TEST_F(DataSetFile, DeviationsTurnWithTheRegistration) {
  measured("registration = \"registration.toml\"");
  folder.write("registration.toml", "rotate = { axis = [1, 0, 0], angle_deg = 90 }\n");
  folder.write("markers.csv", "marker,x,y,z\na,0.05,0.06,-0.04\n");
  folder.write("positions.csv", "case,marker,x,y,z,sd_x,sd_y,sd_z\ndeep,a,0.05,0.055,-0.04,1e-4,2e-4,50\n");
  const Experiment e = read_data_set(folder).experiment;
  const Vec3d sigma = e.cases[e.cases[0].name == "deep" ? 0 : 1].positions.at(0).sigma;
  EXPECT_NEAR(sigma[0], 1e-4, 1e-16);
  EXPECT_NEAR(sigma[1], 50, 1e-12);
  EXPECT_NEAR(sigma[2], 2e-4, 1e-16);
}

TEST_F(DataSetFile, RecordingsNameTheirConverter) {
  for (const char* name : {"walk.trc", "walk.C3D", "scan_*.ply"}) {
    measured(std::string("positions = \"") + name + "\"");
    EXPECT_THAT(refusal(), HasSubstr(std::string(name) +
                                     ": is a recording of another program; it is converted by: python3 -m "
                                     "aspic.recordings '" +
                                     name + "'"));
  }
  folder.write("dic.csv", "X,Y,Z,U,V,W\n1,2,3,4,5,6\n");
  measured("positions = \"dic.csv\"");
  EXPECT_THAT(refusal(),
              HasSubstr("tables of image correlation are converted by: python3 -m aspic.recordings 'dic.csv'"));
}

}  // namespace
}  // namespace aspic
