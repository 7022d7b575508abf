// Systematic errors, layers and the scan of the mesh in capture.toml.
#include "data/stated_errors.h"

#include <gmock/gmock.h>

#include "data/capture_cases_test.h"
#include "indenter/indenter_depth.h"

namespace aspic {
namespace {

using testing::HasSubstr;

class StatedErrors : public FolderTest {
 protected:
  DataSet read(const std::string& settings, const std::string& tip = "", const std::string& forces = "-1") {
    write_mesh(path("rest.msh"), test_box());
    folder.write("markers.csv", "marker,x,y,z\nA,0.05,0.04,0.06\n");
    folder.write("cases.csv",
                 "case,group,session,touch_x,touch_y,touch_z,depth,force_z,force_x,force_y\nfirst,p,monday,0.05,0.04,"
                 "0.07,0.004," +
                     forces + "," + (forces.empty() ? "," : "0,0") + "\nsecond,q,tuesday,0.03,0.04,0.07,0.004,,,\n");
    folder.write("positions.csv",
                 "case,marker,x,y,z,sd\nfirst,A,0.05,0.04,0.056,1e-4\nsecond,A,0.05,0.04,0.059,1e-4\n");
    folder.write("capture.toml", "version = 1\nmesh = \"rest.msh\"\norder = 1\nfixed = \"z < 1e-9\"\n" + settings +
                                     "\n[[tip]]\nradius = 0.01\n" + tip);
    return read_data_set(folder);
  }
  std::string refusal(const std::string& settings, const std::string& tip = "", const std::string& forces = "-1") {
    return message_of([&] { read(settings, tip, forces); });
  }
};

TEST_F(StatedErrors, HaveUnitsGroupsAndSessions) {
  const DataSet data =
      read("units = { angle = \"deg\" }\nerrors = { position = 2e-4, rotation = 1, tare = 0.05, length_scale = 0.01 }");
  const std::vector<SystematicError>& errors = data.experiment.errors;
  ASSERT_EQ(errors.size(), 3 * 2 + 3 * 2 + 3 + 2u) << "only the first case has a force";
  EXPECT_EQ(name_of(errors[0]), "position x of 'p'");
  EXPECT_EQ(errors[0].sigma, 2e-4);
  EXPECT_NEAR(errors[6].sigma, 0.01745, 1e-5);
  EXPECT_EQ(name_of(errors[12]), "tare x of 'monday'");
  EXPECT_EQ(name_of(errors[16]), "length scale of 'tuesday'");
}

TEST_F(StatedErrors, AreRefusedWithLineAndRemedy) {
  EXPECT_THAT(refusal("errors = { tare = 0.05 }", "", ""), HasSubstr("capture.toml:5:"));
  EXPECT_THAT(refusal("errors = { tare = 0.05 }", "", ""),
              HasSubstr("because none has a force (torques have no tare); remove the key"));
  EXPECT_THAT(refusal("errors = { tara = 0.05 }"), HasSubstr("tare"));
  EXPECT_THAT(refusal("errors = { tare = -1 }"), HasSubstr("capture.toml:5:"));
}

TEST_F(StatedErrors, LayersCountAsStated) {
  EXPECT_FALSE(read("").experiment.cases[0].layer_sigma);
  EXPECT_EQ(read("", "stiffness = 1e6\n").experiment.cases[0].layer_sigma, 0.0);
  EXPECT_FALSE(read("", "stiffness = 1e6\nstiffness_deviation = \"unknown\"\n").experiment.cases[0].layer_sigma);
  const DataSet data = read("", "stiffness = 1e6\nstiffness_deviation = 0.2\n");
  EXPECT_EQ(data.experiment.cases[1].layer_sigma, 0.2);
  ASSERT_EQ(data.experiment.errors.size(), 1u);
  EXPECT_EQ(data.experiment.errors[0].kind, ErrorKind::layer);
  EXPECT_THAT(refusal("", "stiffness_deviation = 0.2\n"), HasSubstr("capture.toml:8:23: stiffness_deviation needs"));
}

TEST_F(StatedErrors, FrictionHasAPriorPerTip) {
  EXPECT_EQ(read("").experiment.cases[0].indenter->friction, 0.0);
  EXPECT_TRUE(read("", "friction = 0.3\n").experiment.errors.empty()) << "known";
  const DataSet data = read("", "friction = 0.3\nfriction_deviation = 0.5\n");
  EXPECT_EQ(data.experiment.cases[1].indenter->friction, 0.3);
  ASSERT_EQ(data.experiment.errors.size(), 1u);
  EXPECT_EQ(name_of(data.experiment.errors[0]), "friction of 'tip'");
  EXPECT_EQ(data.experiment.errors[0].sigma, 0.5);
  write_data_set(path("copy"), data);
  const DataSet copy = read_data_set(path("copy"));
  EXPECT_EQ(copy.experiment.cases[0].indenter->friction, 0.3);
  EXPECT_EQ(copy.experiment.cases[0].friction_sigma, 0.5);
}

TEST_F(StatedErrors, RimsOfDiscsAreUncertainUnlessStated) {
  EXPECT_EQ(read("").experiment.cases[0].indenter->rim, 0.0) << "of a sphere";
  const DataSet unstated = read("", "shape = \"disc\"\n");
  EXPECT_DOUBLE_EQ(unstated.experiment.cases[0].indenter->rim, kUsualRim * 0.01);
  ASSERT_EQ(unstated.experiment.errors.size(), 1u);
  EXPECT_EQ(name_of(unstated.experiment.errors[0]), "rim of 'tip'");
  EXPECT_EQ(unstated.experiment.errors[0].sigma, kRimSigma);
  for (const DataSet& data : {unstated, read("units = { length = \"m\" }", "shape = \"disc\"\nrim = 0.001\n")}) {
    write_data_set(path("copy"), data);
    const DataSet copy = read_data_set(path("copy"));
    EXPECT_EQ(copy.experiment.cases[0].indenter->rim, data.experiment.cases[0].indenter->rim);
    EXPECT_EQ(copy.experiment.errors.size(), data.experiment.errors.size());
  }
  EXPECT_TRUE(read("", "shape = \"disc\"\nrim = 0.001\n").experiment.errors.empty()) << "known";
  EXPECT_THAT(refusal("", "rim = 0.001\n"), HasSubstr("capture.toml:8:7: rim: only sliding discs have a rim"));
  EXPECT_THAT(refusal("", "shape = \"disc\"\nrim = 0.007\n"),
              HasSubstr("capture.toml:9:7: rim = 0.007 is more than 0.64 of the radius"));
}

TEST_F(StatedErrors, FrictionIsRefusedWithLineAndRemedy) {
  EXPECT_THAT(refusal("", "friction = -0.3\n"), HasSubstr("capture.toml:8:12: friction = -0.3"));
  EXPECT_EQ(read("", "friction = 5\n").experiment.cases[0].indenter->friction, 5.0);
  EXPECT_THAT(refusal("", "friction = 30\n"), HasSubstr("capture.toml:8:12: friction = 30: no dry contact exceeds 5"));
  EXPECT_THAT(refusal("", "friction_deviation = 0.5\n"), HasSubstr("capture.toml:8:22: friction_deviation = 0.5: the"));
  EXPECT_THAT(refusal("", "friction = 0.3\ncontact = \"bonded\"\n"), HasSubstr("use contact = \"sliding\", or remove"));
  EXPECT_THAT(refusal("steady = \"history\"", "friction = 0.3\n"),
              HasSubstr("capture.toml:8:12: friction = 0.3: loads"));
}

TEST_F(StatedErrors, GravityOfTheScanIsThatOfCases) {
  const DataSet data = read("mesh_gravity = [0, 0, -9.81]");
  ASSERT_TRUE(data.experiment.scan_gravity);
  EXPECT_EQ(data.experiment.cases[0].gravity[2], -9.81);
  EXPECT_THAT(refusal("mesh_gravity = [0, 0, 0]"), HasSubstr("capture.toml:5:16: mesh_gravity = [0, 0, 0]"));
  EXPECT_THAT(refusal("mesh_gravity = [0, 0, 1]", "contact = \"bonded\"\n"), HasSubstr("use contact = \"sliding\""));
  EXPECT_THAT(refusal("mesh_gravity = [0, 0, 1]", "[[grip]]\nwhere = \"z > 0.05\"\n"), HasSubstr("give the unloaded"));
}

TEST_F(StatedErrors, SurviveWriting) {
  const DataSet data = read("errors = { position = 2e-4, backlash = 1e-4 }\nmesh_gravity = [0, 0, -9.81]",
                            "stiffness = 1e6\nstiffness_deviation = 0.2\n");
  write_data_set(path("copy"), data);
  const DataSet copy = read_data_set(path("copy"));
  ASSERT_EQ(copy.experiment.errors.size(), data.experiment.errors.size());
  for (size_t k = 0; k < data.experiment.errors.size(); ++k)
    EXPECT_EQ(copy.experiment.errors[k].sigma, data.experiment.errors[k].sigma);
  EXPECT_EQ(copy.experiment.cases[0].layer_sigma, 0.2);
  EXPECT_EQ(copy.experiment.cases[1].session, "tuesday");
  EXPECT_TRUE(copy.experiment.scan_gravity);
}

}  // namespace
}  // namespace aspic
