// Viscoelastic branches of a scene: creep, units, restarts, mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "results/run_directory.h"
#include "scene/scene_cases_test.h"
#include "scene/value.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A cube of a material that does not contract, held on rollers and pulled along x.
std::string creeping_cube(const std::string& branches, const std::string& keys = "", const std::string& time = "") {
  return "gravity = [0, 0, 0]\n[time]\nintegrator = \"quasi_static\"\nstep = 0.5\n" + time +
         "[solver]\ntolerance = 1e-12\n" + kCube + keys +
         "material = { model = \"stvk\", young = 1e5, poisson = 0 }\n[[body.pin]]\nwhere = \"x < 0.1\"\naxes = \"x\"\n"
         "[[body.pin]]\nwhere = \"y < 0.1\"\naxes = \"y\"\n[[body.pin]]\nwhere = \"z < 0.1\"\naxes = \"z\"\n"
         "[[body.traction]]\nwhere = \"x > 0.9\"\nvalue = [2e4, 0, 0]\n" +
         branches;
}
std::string branch(const std::string& keys) { return "[[body.viscoelastic]]\n" + keys + "\n"; }

double longest_side_of(const Scene& scene) {
  double most = 0;
  const std::vector<double> q = positions(scene);
  for (size_t i = 0; i < q.size(); i += 3) most = std::max(most, q[i]);
  return most;
}

// Solves l (E e + s) = traction, e = (l^2 - 1) / 2, s the stress of the branch for a strain that is linear in time.
double crept_length(int steps, double G, double tau, double h) {
  double e_n = 0, s_n = 0, l = 1;
  for (int k = 0; k < steps; ++k) {
    const double x = h / tau, phi = -std::expm1(-x) / x;
    double low = 1, high = 2;
    for (int i = 0; i < 100; ++i) {
      l = 0.5 * (low + high);
      const double e = (l * l - 1) / 2, s = std::exp(-x) * s_n + 2 * G * phi * (e - e_n);
      (l * (1e5 * e + s) > 2e4 ? high : low) = l;
    }
    const double e = (l * l - 1) / 2;
    s_n = std::exp(-x) * s_n + 2 * G * phi * (e - e_n);
    e_n = e;
  }
  return l;
}

TEST(ViscoelasticScene, PulledCubeCreeps) {
  for (const char* order : {"", "order = 2\n"}) {
    Scene scene = load(creeping_cube(branch("shear = 6e4\nrelaxation_time = 1.5"), order));
    EXPECT_THAT(scene.simulation.potential_names(), ElementsAre("elasticity", "traction", "viscoelastic"));
    double before = 1;
    for (int k = 1; k <= 8; ++k) {
      EXPECT_TRUE(is_success(scene.simulation.step().status));
      EXPECT_NEAR(longest_side_of(scene), crept_length(k, 6e4, 1.5, 0.5), 1e-9) << k;
      EXPECT_GT(longest_side_of(scene), before);
      before = longest_side_of(scene);
    }
  }
}

TEST(ViscoelasticScene, RatioMultipliesShearModulus) {
  const auto crept = [](const std::string& keys) {
    Scene scene = load(creeping_cube(branch(keys + "\nrelaxation_time = 1.5")));
    for (int k = 0; k < 3; ++k) scene.simulation.step();
    return positions(scene);
  };
  EXPECT_EQ(crept("ratio = 1.5"), crept("shear = 75000"));  // mu = 5e4
  EXPECT_EQ(crept("ratio = \"1 + 0.5*(X < 0.5)\""), crept("shear = \"50000 + 25000*(X < 0.5)\""));
  EXPECT_NE(crept("ratio = \"1 + 0.5*(X < 0.5)\""), crept("ratio = 1.5"));
}

TEST(ViscoelasticScene, TwoBranchesAreOneTermPerBody) {
  std::string text =
      creeping_cube(branch("ratio = 1\nrelaxation_time = 0.1") + branch("ratio = 2\nrelaxation_time = 10"));
  text +=
      "[[body]]\nname = \"other\"\nshape = { box = { lower = [3, 0, 0], upper = [4, 1, 1], cells = [1, 1, 1] } }\n"
      "[[body.pin]]\nwhere = \"x < 3.1\"\n" +
      branch("ratio = 1\nrelaxation_time = 1");
  const Scene scene = load(text);
  EXPECT_EQ(scene.simulation.model().damping.size(), 2u);
  EXPECT_EQ(scene.simulation.potential_names().back(), "viscoelastic_2");
  EXPECT_EQ(scene.simulation.state().internal.size(), 48u * 12 + 6u * 6);
}

TEST(ViscoelasticScene, ResumedRunHasTheSameBits) {
  const TestFolder folder;
  const std::string text = creeping_cube(branch("ratio = 2\nrelaxation_time = 1.5"), "order = 2\n", "duration = 6\n") +
                           "[output]\ncheckpoint_every = 0\n";
  const auto path = folder.write("creep.toml", text);
  const auto advance = [](Scene& scene, RunDirectory& run, int last) {
    while (scene.simulation.steps_taken() < last) {
      const StepReport report = scene.simulation.step();
      run.on_step(report, scene.simulation);
    }
  };
  Scene whole = load_scene(path);
  RunDirectory one = RunDirectory::create((folder / "one").string(), whole, ExistingRun::refuse);
  advance(whole, one, 12);
  one.finish(whole.simulation);
  {
    Scene first = load_scene(path);
    RunDirectory two = RunDirectory::create((folder / "two").string(), first, ExistingRun::refuse);
    advance(first, two, 5);
  }
  Scene rest = load_scene(path);
  RunDirectory two = RunDirectory::resume((folder / "two").string(), rest);
  EXPECT_EQ(rest.simulation.steps_taken(), 5);
  EXPECT_NE(rest.simulation.state().internal, std::vector<double>(rest.simulation.state().internal.size(), 0.0));
  advance(rest, two, 12);
  EXPECT_EQ(rest.simulation.state_hash(), whole.simulation.state_hash());
}

TEST(ViscoelasticScene, RejectsMistakes) {
  EXPECT_THAT(refusal(creeping_cube(branch("relaxation_time = 1"))), HasSubstr("shear"));
  EXPECT_THAT(refusal(creeping_cube(branch("ratio = 1\nshear = 1\nrelaxation_time = 1"))), HasSubstr("ratio"));
  EXPECT_THAT(refusal(creeping_cube(branch("ratio = 1"))), HasSubstr("relaxation_time"));
  EXPECT_THAT(refusal(creeping_cube(branch("ratio = 1\nrelaxation_time = 0"))),
              AllOf(HasSubstr("beam.toml:"), HasSubstr("relaxation_time = 0"), HasSubstr("must be > 0")));
  EXPECT_THAT(refusal(creeping_cube(branch("shear = -1\nrelaxation_time = 1"))), HasSubstr("shear = -1"));
  EXPECT_THAT(refusal(creeping_cube(branch("ratio = 1\nrelaxation_time = 1"), "elastic = false\n")),
              AllOf(HasSubstr("beam.toml:"), HasSubstr("set `shear` instead")));
}

TEST(ViscoelasticScene, OtherIntegratorsAreRefusedWithTheLine) {
  const std::string message =
      refusal(creeping_cube(branch("ratio = 1\nrelaxation_time = 1")), {"time.integrator=\"bdf2\""});
  EXPECT_THAT(message, AllOf(HasSubstr("integrator = 'bdf2'"), HasSubstr("choose backward_euler")));
  std::string text = creeping_cube(branch("ratio = 1\nrelaxation_time = 1"));
  text.replace(text.find("quasi_static"), 12, "midpoint");
  EXPECT_THAT(refusal(text), HasSubstr("beam.toml:3"));
}

TEST(ViscoelasticScene, PredictsItsMemory) {
  std::string branches;
  for (int k = 0; k < 40; ++k) branches += branch("ratio = 1\nrelaxation_time = 1");
  const TestFolder folder;
  const auto path = folder.write("beam.toml", creeping_cube(branches, "order = 2\n"));
  SceneOptions options;
  options.limit.memory = 48 * 8000;  // enough for the mesh
  EXPECT_THAT(refusal_of(path, options),
              AllOf(HasSubstr("beam.toml:"), HasSubstr("40 viscoelastic branches of 48 tets"),
                    HasSubstr("choose fewer branches")));
  options.limit.memory = 48 * 80000;
  EXPECT_EQ(refusal_of(path, options), "");
}

}  // namespace
}  // namespace aspic
