// The virtual bench measures the behavior of its truth.
#include "data/synthesis.h"

#include <gmock/gmock.h>

#include <cmath>

#include "data/capture_cases_test.h"
#include "model/misfit.h"

namespace aspic {
namespace {

using testing::Contains;
using testing::HasSubstr;

class VirtualBench : public FolderTest {
 protected:
  Scene scene(const std::string& body = "[[body.pin]]\nwhere = \"Z < 1e-6\"\n") {
    return load_scene(folder.write(
        "block.toml",
        "gravity = [0, 0, 0]\n[time]\nduration = 0.1\n[[body]]\nname = \"block\"\nshape = { box = { lower = [0, 0, 0], "
        "upper = [0.1, 0.1, 0.06], cells = [6, 6, 3] } }\nmaterial = { model = \"neo_hookean\", young = \"1e4 + 1e5 * "
        "X\", poisson = 0.4, density = 1100.0 }\n" +
            body));
  }
  static SynthesisOptions exact() {
    SynthesisOptions options;
    options.indentations = 2, options.depths = 2, options.markers = 30;
    options.noise = options.force_noise = 0;
    return options;
  }
};

TEST_F(VirtualBench, RefusesPinsAlongSomeDirections) {
  const Scene rollers = scene("[[body.pin]]\nname = \"rollers\"\nwhere = \"Z < 1e-6\"\naxes = \"z\"\n");
  EXPECT_THAT(message_of([&] { synthesize(rollers, exact(), {}); }),
              testing::AllOf(HasSubstr("pin 'block.rollers' holds its vertices along some directions only"),
                             HasSubstr("remove its axes or direction")));
}

// The truth explains exact data in a misfit on the same mesh.
TEST_F(VirtualBench, TruthExplainsExactDataOnSameMesh) {
  const std::string pin = "[[body.pin]]\nwhere = \"Z < 1e-6\"\n";
  const std::pair<IndenterContact, std::string> benches[] = {
      {IndenterContact::bonded, pin}, {IndenterContact::sliding, pin}, {IndenterContact::bonded, "order = 2\n" + pin}};
  for (const auto& [contact, body] : benches) {
    SCOPED_TRACE(body);
    const Scene block = scene(body);
    SynthesisOptions options = exact();
    options.contact = contact;
    options.torques = true;
    options.gravity = {{{1, 0, 0}}};
    options.mesh = to_user(block.simulation.model().numbering, block.simulation.model().mesh);
    const Synthesis made = synthesize(block, options);
    EXPECT_EQ(made.failed, 0);
    write_data_set(folder / "data", made.data);
    const DataSet data = read_data_set(folder / "data");
    ASSERT_EQ(data.experiment.cases.size(), 5u);
    const std::vector<double> young = sample(made.truth, *made.truth.find("young"), data.experiment.mesh);
    std::vector<MaterialParameters> known;
    std::vector<double> p;
    for (const double E : young) known.push_back({lame_from_young_poisson(E, 0.4), {}}), p.push_back(std::log(E));
    const ParameterMap map(data.experiment.mesh, "neo_hookean", known, {{"young", Parameterization::tets, 0, 1e4}});
    Misfit misfit(data.experiment, map);
    std::vector<double> r(misfit.residual_count());
    ASSERT_TRUE(misfit.evaluate(p, r)) << misfit.failure();
    for (size_t k = 0; k < r.size(); ++k) EXPECT_NEAR(r[k], 0, 1e-3) << misfit.what(static_cast<int>(k));
  }
}

TEST_F(VirtualBench, DataHaveCoarserMeshWithSameSupports) {
  const Synthesis made = synthesize(scene(), exact());
  const Experiment& e = made.data.experiment;
  EXPECT_LT(e.mesh.tet_count(), made.truth.mesh.tet_count());
  EXPECT_EQ(made.truth.mesh.tet_count(), 6 * 6 * 6 * 3);
  EXPECT_EQ(e.fixed.size(), 25u);  // 4 x 4 cells
  for (const int v : e.fixed) EXPECT_NEAR(e.mesh.rest[v][2], 0, 1e-12);
  for (const double density : e.density) EXPECT_EQ(density, 1100);
  ASSERT_EQ(e.markers.size(), 30u);
  double least = INFINITY;  // farthest-point sampling: no two are close
  for (size_t a = 0; a < e.markers.size(); ++a)
    for (size_t b = 0; b < a; ++b) {
      const Vec3d d = position(e.markers[a], e.mesh.rest) - position(e.markers[b], e.mesh.rest);
      least = std::min(least, norm(d));
    }
  EXPECT_GT(least, 0.01);
  for (const LoadCase& load : e.cases) EXPECT_GT(dot(*load.force, load.pose.center - load.touch.center), 0);
}

TEST_F(VirtualBench, NoiseHasStatedSigmaAndDependsOnSeed) {
  const Scene block = scene();
  SynthesisOptions noisy = exact();
  noisy.noise = 0.01, noisy.force_noise = 0.02;
  const Synthesis a = synthesize(block, noisy), again = synthesize(block, noisy), truth = synthesize(block, exact());
  noisy.seed = 2;
  const Synthesis other = synthesize(block, noisy);
  double squares = 0;
  int count = 0;
  for (size_t c = 0; c < a.data.experiment.cases.size(); ++c) {
    const LoadCase &x = a.data.experiment.cases[c], &y = truth.data.experiment.cases[c];
    ASSERT_EQ(x.positions.size(), y.positions.size());
    for (size_t i = 0; i < x.positions.size(); ++i)
      for (int k = 0; k < 3; ++k, ++count) {
        const double error = (x.positions[i].position[k] - y.positions[i].position[k]) / x.positions[i].sigma[k];
        squares += error * error;
        EXPECT_EQ(x.positions[i].position[k], again.data.experiment.cases[c].positions[i].position[k]);
      }
    EXPECT_NE((*x.force)[0], (*other.data.experiment.cases[c].force)[0]);
  }
  EXPECT_NEAR(squares / count, 1, 5 * std::sqrt(2.0 / count));  // five standard deviations of the mean square
}

TEST_F(VirtualBench, ItsDiagnosisFindsNothingWrong) {
  SynthesisOptions options;
  options.indentations = 4, options.depths = 2, options.markers = 60;
  options.indenter_radius = 0.015;  // the triangles of the data are 4 cm long
  for (const DataFinding& f : diagnose(synthesize(scene(), options).data))
    EXPECT_EQ(f.severity, Severity::note) << f.where << ": " << f.what;
}

TEST_F(VirtualBench, OmitsForcesOnRequestAndCanBeStopped) {
  SynthesisOptions options = exact();
  options.forces = false;
  int seen = 0;
  options.stop = StopToken([&] { return seen == 2; });
  const Synthesis made = synthesize(scene(), options, [&](const SynthesisStep& step) { EXPECT_EQ(step.done, ++seen); });
  EXPECT_TRUE(made.interrupted);
  EXPECT_EQ(seen, 2);
  for (const LoadCase& load : made.data.experiment.cases) EXPECT_FALSE(load.force.has_value());
}

TEST_F(VirtualBench, WhatCannotBeMeasuredIsRefused) {
  EXPECT_THAT(message_of([&] { synthesize(scene(""), exact()); }), HasSubstr("nothing holds the body"));
  EXPECT_THAT(
      message_of([&] {
        synthesize(
            scene("[[body.pin]]\nwhere = \"Z < 1e-6\"\n[[body]]\nname = \"other\"\nshape = { sphere = { radius = "
                  "0.1, size = 0.1 } }\nmaterial = { young = 1e4, poisson = 0.3 }\n"),
            exact());
      }),
      HasSubstr("has 2 bodies"));
  SynthesisOptions options = exact();
  options.indentations = 0;
  EXPECT_THAT(message_of([&] { synthesize(scene(), options); }), HasSubstr("nothing is measured"));
  options = exact();
  options.mesh = make_box({{1, 1, 1}}, {{2, 2, 2}}, {2, 2, 2});
  EXPECT_THAT(message_of([&] { synthesize(scene(), options); }), HasSubstr("where the body is held"));
  options = exact();
  options.noise = NAN;
  EXPECT_THAT(message_of([&] { synthesize(scene(), options); }), HasSubstr("noise"));
}

}  // namespace
}  // namespace aspic
