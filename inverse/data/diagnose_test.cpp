// Diagnostics of measurements name the row and a remedy; good data have none.
#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "data/capture_cases_test.h"
#include "data/data_set.h"

namespace aspic {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

auto finding(Severity severity, const std::string& where, const std::string& what, const std::string& remedy = "") {
  return AllOf(Field(&DataFinding::severity, severity), Field(&DataFinding::where, HasSubstr(where)),
               Field(&DataFinding::what, HasSubstr(what)), Field(&DataFinding::remedy, HasSubstr(remedy)));
}

// Adds line numbers as if the data had been read.
DataSet data_in_lines(int indentations = 3, int depths = 2) {
  DataSet data = test_data(indentations, depths);
  for (size_t m = 0; m < data.experiment.markers.size(); ++m)
    data.source.marker_line.push_back(2 + static_cast<int>(m));
  int line = 2;
  for (size_t c = 0; c < data.experiment.cases.size(); ++c) {
    data.source.case_line.push_back(2 + static_cast<int>(c));
    data.source.position_line.emplace_back();
    for (size_t i = 0; i < data.experiment.cases[c].positions.size(); ++i)
      data.source.position_line[c].push_back(line++);
  }
  return data;
}

TEST(Diagnosis, OfGoodDataReportsOnlyStiffness) {
  const auto findings = diagnose(data_in_lines());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0], finding(Severity::note, "cases.csv", "Young's modulus of about 7.4"));
}

TEST(Diagnosis, ForcesInGramsOrMillinewtonsAreNoticed) {
  DataSet data = data_in_lines(3, 3);
  for (LoadCase& load : data.experiment.cases) {
    const double grams = std::round((*load.force)[2] / 9.80665e-3);
    load.force = Vec3d{{0, 0, grams}};
  }
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv", "whole numbers", "force = \"g\"")));
  for (LoadCase& load : data.experiment.cases) load.force = Vec3d{{0, 0, -9000.5}};
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv", "too large for soft bodies", "mN")));
}

TEST(Diagnosis, FindsOneIndentationInAnotherUnit) {
  DataSet data = data_in_lines(4);
  data.experiment.cases[2].force = 1000.0 * *data.experiment.cases[2].force;
  data.experiment.cases[3].force = 1000.0 * *data.experiment.cases[3].force;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:4", "times as stiff here", "as mN are")));
}

// Repeats the cases of the first indentation as another group with other forces.
void repeat_first_indentation(DataSet& data, double factor) {
  for (const size_t c : {0, 1}) {
    LoadCase again = data.experiment.cases[c];
    again.group = "again", again.name = "again, depth " + std::to_string(c + 1);
    again.force = factor * *again.force;
    for (MarkerReading& reading : again.positions) reading.position[0] += 1e-6;
    data.experiment.cases.push_back(std::move(again));
  }
}

TEST(Diagnosis, FindsDifferentForcesOfEqualIndentations) {
  for (const double factor : {0.25, 0.5, 2.0, 4.0}) {
    DataSet data = data_in_lines();
    repeat_first_indentation(data, factor);
    EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "again, depth 2",
                                                 "1 N under the same load in 'poke 1, depth 2'", "correct the wrong")))
        << factor;
  }
}

TEST(Diagnosis, RepetitionsThatAgreeAreNoWarnings) {
  DataSet data = data_in_lines();
  repeat_first_indentation(data, 1.05);
  EXPECT_THAT(diagnose(data), Not(Contains(finding(Severity::warning, "", "under the same load"))));
  EXPECT_THAT(diagnose(data), Not(Contains(finding(Severity::warning, "", "stiffer here"))));
}

TEST(Diagnosis, FindsOneIndentationFourTimesAsStiff) {
  DataSet data = data_in_lines();
  for (const size_t c : {2, 3}) data.experiment.cases[c].force = 4.0 * *data.experiment.cases[c].force;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "poke 2", "much stiffer here", "check this force")));
}

TEST(Diagnosis, ForceBelowNoiseGivesNoStiffness) {
  DataSet data = data_in_lines(4);
  for (const size_t c : {2, 3}) data.experiment.cases[c].force = 0.01 * *data.experiment.cases[c].force;
  EXPECT_THAT(diagnose(data), Not(Contains(finding(Severity::warning, "cases.csv:4", "as stiff here"))));
  for (const size_t c : {2, 3}) data.experiment.cases[c].force_sigma = {{1e-4, 1e-4, 1e-4}};
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:4", "1/100 times as stiff here")));
}

TEST(Diagnosis, ForcesOnTheIndenterAreReported) {
  DataSet data = data_in_lines();
  data.experiment.cases[1].force = -1.0 * *data.experiment.cases[1].force;
  EXPECT_THAT(diagnose(data),
              Contains(finding(Severity::warning, "cases.csv:3", "opposes the motion of the indenter", "sign")));
  data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) load.force = -1.0 * *load.force;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:2", "opposes", "force_of = \"body\"")));
}

// Like the column `force`, which leaves the lateral force undetermined.
void measure_along_axis(LoadCase& load, double force) {
  const Vec3d& a = load.pose.axis;
  load.force = force * a;
  load.gauge = a;
  load.force_sigma = {{0.01, 0.01, 0.01}};
}

DataSet data_of_one_axis(const Vec3d& axis) {
  DataSet data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) {
    const double depth = load.touch.center[2] - load.pose.center[2];
    load.touch.axis = load.pose.axis = axis;
    load.pose.center = load.touch.center + depth * axis;
    measure_along_axis(load, 170 * depth);
  }
  return data;
}

TEST(Diagnosis, SingleAxisForcesAreExaminedLikeOthers) {
  for (const Vec3d& axis : {Vec3d{{0, 0, -1}}, Vec3d{{0.48, 0.36, -0.8}}}) {
    DataSet data = data_of_one_axis(axis);
    EXPECT_THAT(diagnose(data), Each(Field(&DataFinding::severity, Severity::note)));
    measure_along_axis(data.experiment.cases[1], -1);
    EXPECT_THAT(diagnose(data),
                Contains(finding(Severity::warning, "cases.csv:3", "opposes the motion of the indenter")));
    measure_along_axis(data.experiment.cases[1], 0.2);
    EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:3", "the force falls")));
    measure_along_axis(data.experiment.cases[0], 500);
    measure_along_axis(data.experiment.cases[1], 1000);
    EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:2", "times as stiff here")));
    for (LoadCase& load : data.experiment.cases) measure_along_axis(load, -1);
    EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:2", "opposes", "force_of = \"body\"")));
  }
}

TEST(Diagnosis, PositionsThatNoIndenterExplainsAreErrors) {
  const DataSet good = data_in_lines();
  const auto with = [&](auto change) {
    DataSet data = good;
    for (LoadCase& load : data.experiment.cases)
      for (MarkerReading& r : load.positions)
        change(load, r, position(data.experiment.markers[r.marker], data.experiment.mesh.rest));
    return diagnose(data);
  };
  EXPECT_THAT(with([](LoadCase&, MarkerReading& r, const Vec3d& X) { r.position = r.position - X; }),
              Contains(finding(Severity::error, "positions.csv", "markers move by", "these are displacements")));
  EXPECT_THAT(with([](LoadCase&, MarkerReading& r, const Vec3d&) { std::swap(r.position[0], r.position[2]); }),
              Contains(finding(Severity::error, "positions.csv", "markers move by", "x and z seem to be swapped")));
  EXPECT_THAT(with([](LoadCase&, MarkerReading& r, const Vec3d&) { r.position[1] += 0.05; }),
              Contains(finding(Severity::warning, "positions.csv", "markers move by", "coordinate system")));
  EXPECT_THAT(with([](LoadCase& load, MarkerReading& r, const Vec3d&) {
                load.pose = load.touch;
                r.position[1] += 0.01;
              }),
              Contains(finding(Severity::error, "positions.csv", "the indenter by 0 m", "the pose of the indenter")));
}

TEST(Diagnosis, WithoutAnyForceOnlyRatiosCanBeKnown) {
  DataSet data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) load.force.reset();
  EXPECT_THAT(diagnose(data),
              Contains(finding(Severity::warning, "cases.csv", "only ratios of stiffness", "at least one force")));
  data.experiment.cases[0].force = Vec3d{{0, 0, -0.5}};
  EXPECT_THAT(diagnose(data), Not(Contains(finding(Severity::warning, "cases.csv", "only ratios"))));
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::note, "cases.csv:3", "one of 5 pokes without a force")));
}

TEST(Diagnosis, ForceThatFallsWithDepthIsReported) {
  DataSet data = data_in_lines();
  std::swap(data.experiment.cases[2].force, data.experiment.cases[3].force);
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:5", "the force falls from 1 N to 0.5 N")));
}

TEST(Diagnosis, LengthsInMillimetersAreNoticed) {
  DataSet data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) {
    load.touch.center = 1000.0 * load.touch.center;
    load.pose.center = 1000.0 * load.pose.center;
    for (MarkerReading& r : load.positions) r.position = 1000.0 * r.position;
  }
  const auto findings = diagnose(data);
  EXPECT_THAT(findings, Contains(finding(Severity::error, "cases.csv:2", "away from a body", "length = \"mm\"")));
  EXPECT_THAT(findings, Contains(finding(Severity::error, "positions.csv", "markers move by", "in mm they would fit")));
}

TEST(Diagnosis, OnlyMarkersThatLeaveNeighborsAreNamed) {
  DataSet data = data_in_lines();
  data.experiment.cases[3].positions[17].position[0] += 0.006;
  const auto findings = diagnose(data);
  EXPECT_THAT(findings, Contains(finding(Severity::warning, data.source.position(3, 17),
                                         "away from the motion of its neighbors")));
  EXPECT_EQ(std::count_if(findings.begin(), findings.end(),
                          [](const DataFinding& f) { return f.what.find("neighbors") != std::string::npos; }),
            1);
}

TEST(Diagnosis, RigidMotionOfWhatIsFixedIsNoticed) {
  DataSet data = data_in_lines();
  Experiment& e = data.experiment;
  const SurfaceProjection surface(e.mesh);
  const int first = static_cast<int>(e.markers.size());
  for (int i = 0; i < 6; ++i) {
    e.markers.push_back(surface.nearest({{0.01 + 0.015 * i, 0.02 + 0.03 * (i % 2), -0.01}}).point);
    data.marker_names.push_back("held " + std::to_string(i));
    data.marker_gap.push_back(0);
  }
  const auto measure = [&](const Vec3d& t, double turn) {
    for (LoadCase& load : e.cases) {
      std::erase_if(load.positions, [&](const MarkerReading& r) { return r.marker >= first; });
      for (int m = first; m < first + 6; ++m) {
        const Vec3d X = position(e.markers[m], e.mesh.rest);
        load.positions.push_back({m, X + t + cross(Vec3d{{0, 0, turn}}, X), {{1e-5, 1e-5, 1e-5}}});
      }
    }
  };
  measure({}, 0);
  EXPECT_THAT(diagnose(data), Not(Contains(finding(Severity::warning, "", "fixed vertices moved"))));
  measure({{0.001, 0, 0}}, 0);
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:2", "fixed vertices moved: by 0.001 m")));
  measure({}, 0.02);
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:2", "0.02 rad")));
}

// Markers on a short line with noise: the rotation about it is large, but so is its standard deviation.
TEST(Diagnosis, NoiseOfCloseMarkersIsNoRigidMotion) {
  DataSet data = data_in_lines();
  Experiment& e = data.experiment;
  const SurfaceProjection surface(e.mesh);
  const int first = static_cast<int>(e.markers.size());
  for (int i = 0; i < 3; ++i) {
    e.markers.push_back(surface.nearest({{0.03 + 0.02 * i, 0.03 + 0.0002 * (i % 2), -0.01}}).point);
    data.marker_names.push_back("held " + std::to_string(i));
    data.marker_gap.push_back(0);
    const Vec3d X = position(e.markers[first + i], e.mesh.rest);
    const double sd = 1e-4, noise = (i % 2 == 0 ? 1 : -1) * sd;
    for (LoadCase& load : e.cases) load.positions.push_back({first + i, X + Vec3d{{0, 0, noise}}, {{sd, sd, sd}}});
  }
  EXPECT_THAT(diagnose(data), Not(Contains(finding(Severity::warning, "", "fixed vertices moved"))));
}

TEST(Diagnosis, CaseWithoutGravityIsALoadOfAMeshUnderGravity) {
  DataSet data = data_in_lines();
  data.experiment.cases[0].indenter.reset();
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:2", "has no load")));
  data.experiment.scan_gravity = {{0, 0, -9.81}};
  EXPECT_THAT(diagnose(data), Not(Contains(finding(Severity::warning, "", "has no load"))));
}

TEST(Diagnosis, MarkersOffTheSurfaceAreNamed) {
  DataSet data = data_in_lines();
  data.marker_gap[7] = 0.005;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "markers.csv:9", "lies 0.005 m off the surface")));
}

TEST(Diagnosis, TooFewAndRankDeficientDataAreNoticed) {
  DataSet few = data_in_lines(1, 1);
  few.experiment.cases[0].positions.resize(2);
  EXPECT_THAT(diagnose(few), Contains(finding(Severity::warning, "positions.csv", "only 9 numbers")));
  few.experiment.cases[0].positions.clear();
  few.experiment.cases[0].force.reset();
  EXPECT_THAT(diagnose(few), Contains(finding(Severity::error, "cases.csv:2", "no measurements")));

  DataSet same = data_in_lines();
  for (size_t c = 2; c < same.experiment.cases.size(); ++c)
    same.experiment.cases[c].positions = same.experiment.cases[c % 2].positions;
  EXPECT_THAT(diagnose(same), Contains(finding(Severity::warning, "positions.csv", "rank-deficient")));

  DataSet planar = data_in_lines();
  for (LoadCase& load : planar.experiment.cases)
    for (MarkerReading& r : load.positions) r.sigma[0] = 1e3;  // not measured
  EXPECT_THAT(diagnose(planar), Not(Contains(finding(Severity::warning, "positions.csv", "more than their noise"))));

  DataSet still = data_in_lines();
  for (LoadCase& load : still.experiment.cases)
    for (MarkerReading& r : load.positions)
      r.position = position(still.experiment.markers[r.marker], still.experiment.mesh.rest);
  EXPECT_THAT(diagnose(still), Contains(finding(Severity::warning, "positions.csv", "more than their noise")));
}

TEST(Diagnosis, CopiesRepetitionsAndCasesWithoutLoadAreNoticed) {
  DataSet data = data_in_lines();
  LoadCase copy = data.experiment.cases[5];
  copy.name = "again";
  data.experiment.cases.push_back(copy);
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "again", "same readings to the last digit")));
  data.experiment.cases.back().force = Vec3d{{0, 0, -1.01}};
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::note, "again", "has the same load as 'poke 3, depth 2'")));
  data.experiment.cases.back().indenter.reset();
  data.experiment.cases.back().force.reset();
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "again", "has no load")));
}

TEST(Diagnosis, MissingContactAndMissingSupportAreErrors) {
  DataSet data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) load.touch.center[2] += 0.02;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:2", "touches nothing")));
  data = data_in_lines();
  for (LoadCase& load : data.experiment.cases)
    load.indenter->contact = IndenterContact::sliding, load.touch.center[2] += 0.02, load.pose.center[2] += 0.02;
  EXPECT_THAT(diagnose(data),
              Contains(finding(Severity::error, "cases.csv:2", "does not touch the body", "first contact")));
  data = data_in_lines();
  data.experiment.fixed.clear();
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "capture.toml", "follow the indenter or the grip")));
  data.experiment.cases[1].gravity = {{0, 0, -9.81}};
  EXPECT_THAT(diagnose(data),
              Contains(finding(Severity::warning, "capture.toml", "only the indenter or the grip holds")));
  for (LoadCase& load : data.experiment.cases) load.indenter->contact = IndenterContact::sliding;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "capture.toml", "pushed away", "fixed")));
  data = data_in_lines();
  data.experiment.fixed.resize(data.experiment.mesh.rest.size());
  std::iota(data.experiment.fixed.begin(), data.experiment.fixed.end(), 0);
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "capture.toml", "all vertices are fixed", "lowest")));
}

TEST(Diagnosis, ReadingsThatNoInstrumentGivesAreErrors) {
  DataSet data = data_in_lines();
  data.experiment.cases[1].positions[3].position[0] = 1e300;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, data.source.position(1, 3), "far outside", "correct")));
  data = data_in_lines();
  data.experiment.cases[1].positions[3].sigma[1] = 1e-300;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, data.source.position(1, 3), "attains", "blank")));
  data = data_in_lines();
  data.experiment.cases[2].force = Vec3d{{0, 0, -1e300}};
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:4", "the force is larger", "blank")));
  data = data_in_lines();
  data.experiment.cases[2].force_sigma[0] = 1e-200;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:4", "no gauge", "force_sd")));
  data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) load.force = Vec3d{};
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv", "all forces are 0", "blank")));
}

TEST(Diagnosis, InvertedOrOverRotatedPosesAreReported) {
  DataSet data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) load.touch.axis = load.pose.axis = {{0, 0, 1}};
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:2", "points out of the body", "signs")));
  data = data_in_lines();
  data.experiment.cases[0].pose.rotation = {{0, 0, 3}};
  data.experiment.cases[1].pose.rotation = {{0, 0, 30}};
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::warning, "cases.csv:2", "rotates by 3 rad", "angle")));
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:3", "rotates by 30 rad", "deg")));
}

TEST(Diagnosis, IndenterSizeUnlikeBodyOrTrianglesIsReported) {
  DataSet data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) load.indenter->radius = 100;
  EXPECT_THAT(diagnose(data), Contains(finding(Severity::error, "cases.csv:2", "far larger than the body", "units")));
  data = data_in_lines();
  for (LoadCase& load : data.experiment.cases) load.indenter->radius = 0.003, load.touch.center[2] = 0.063;
  EXPECT_THAT(diagnose(data),
              Contains(finding(Severity::warning, "cases.csv:2", "small relative to the edges", "edges")));
}

}  // namespace
}  // namespace aspic
