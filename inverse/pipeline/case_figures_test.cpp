#include "pipeline/case_figures.h"

#include <gtest/gtest.h>

#include "mesh/generators.h"

namespace aspic {
namespace {

// A cube with one marker at its corner, and cases with predictions that are 10 % too large on the mesh.
struct Rig {
  DataSet data;
  FitOutcome outcome;

  Rig() {
    data.experiment.mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
    data.experiment.markers = {{{0, 1, 2}, {1, 0, 0}}};
  }

  void add(LoadCase load) {
    CaseOutcome predicted{.ok = true};
    for (const MarkerReading& reading : load.positions) {
      predicted.markers.push_back(reading.position);
      predicted.marker_sigma.push_back(reading.sigma);
    }
    predicted.markers_on_mesh = predicted.markers;
    if (load.force) predicted.wrench.force = *load.force, predicted.wrench_on_mesh.force = 1.1 * *load.force;
    if (load.torque) predicted.wrench.torque = *load.torque, predicted.wrench_on_mesh.torque = 1.1 * *load.torque;
    predicted.force_sigma = load.force_sigma, predicted.torque_sigma = load.torque_sigma;
    data.experiment.cases.push_back(std::move(load));
    outcome.cases.push_back(std::move(predicted));
  }
};

LoadCase gripped(const std::string& name, const Vec3d& displacement, const Vec3d& rotation) {
  LoadCase load{.name = name, .group = name};
  load.grip = Grip{
      .vertices = {6}, .center = {{0.5, 0.5, 1}}, .radius = 0.7, .displacement = displacement, .rotation = rotation};
  load.force = Vec3d{{0, 0, 6}};
  load.force_sigma = {{0.1, 0.2, 0.3}};
  load.torque = Vec3d{{0, 0, 0.5}};
  load.torque_sigma = {{0.01, 0.02, 0.03}};
  return load;
}

TEST(CaseFigures, PulledGripsHaveForceOverDisplacement) {
  Rig rig;
  rig.add(gripped("pull", {{0, 0, 0.02}}, {}));
  const CaseFigures f = case_figures(rig.data, rig.outcome).front();
  EXPECT_EQ(f.load.name + " " + f.load.unit, "displacement m");
  EXPECT_EQ(f.response.name + " " + f.response.unit, "force N");
  EXPECT_EQ(stiffness_unit(f), "N/m");
  EXPECT_DOUBLE_EQ(f.load_value, 0.02);
  EXPECT_DOUBLE_EQ(f.values.measured.value(), 6);
  EXPECT_DOUBLE_EQ(f.values.sigma, 0.3);
  EXPECT_DOUBLE_EQ(f.values.fitted.value(), 6);
  EXPECT_DOUBLE_EQ(f.values.on_mesh.value(), 6.6);
  EXPECT_FALSE(f.values.held_out.has_value());
}

TEST(CaseFigures, TwistedGripsHaveTorqueOverAngle) {
  Rig rig;
  rig.add(gripped("twist", {{0, 0, 0.001}}, {{0, 0, -0.1}}));
  const CaseFigures f = case_figures(rig.data, rig.outcome).front();
  EXPECT_EQ(f.load.name + " " + f.load.unit, "angle rad");
  EXPECT_EQ(f.response.name + " " + f.response.unit, "torque N m");
  EXPECT_EQ(stiffness_unit(f), "N m/rad");
  EXPECT_DOUBLE_EQ(f.load_value, 0.1);
  EXPECT_DOUBLE_EQ(f.values.measured.value(), -0.5) << "about the axis of rotation";
  EXPECT_DOUBLE_EQ(f.values.sigma, 0.03);
}

TEST(CaseFigures, GroupsShareOneLoad) {
  Rig rig;
  LoadCase rest = gripped("rest", {}, {});
  rest.group = "twist";
  rig.add(rest);
  rig.add(gripped("twist", {}, {{0, 0, 0.1}}));
  const std::vector<CaseFigures> all = case_figures(rig.data, rig.outcome);
  EXPECT_EQ(all[0].load.name, "angle");
  EXPECT_EQ(all[0].load_value, 0);
  EXPECT_FALSE(all[0].values.measured.has_value()) << "no axis of rotation";
}

TEST(CaseFigures, WeightsMoveMarkers) {
  Rig rig;
  LoadCase load{.name = "hung", .group = "hung"};
  load.gravity = {{0, 0, -9.81}};
  load.positions = {{0, {{0, 0, -0.3}}, {{0.01, 0.01, 0.01}}}};
  rig.add(load);
  rig.outcome.cases[0].markers[0] = {{0, 0, -0.32}};
  const CaseFigures f = case_figures(rig.data, rig.outcome).front();
  EXPECT_EQ(f.load.name + " " + f.load.unit, "gravity m/s^2");
  EXPECT_EQ(f.response.name + " " + f.response.unit, "mean motion m");
  EXPECT_EQ(stiffness_unit(f), "");
  EXPECT_DOUBLE_EQ(f.values.measured.value(), 0.3);
  EXPECT_DOUBLE_EQ(f.values.fitted.value(), 0.32);
  EXPECT_NEAR(f.rms.value(), 2 / std::sqrt(3), 1e-9);
  EXPECT_EQ(f.readings, 3);
}

TEST(CaseFigures, LeftOutCasesHaveNoResiduals) {
  Rig rig;
  rig.add(gripped("pull", {{0, 0, 0.02}}, {}));
  rig.outcome.cases[0].left_out = true;
  const CaseFigures f = case_figures(rig.data, rig.outcome).front();
  EXPECT_FALSE(f.rms.has_value());
  EXPECT_FALSE(f.values.fitted.has_value());
}

}  // namespace
}  // namespace aspic
