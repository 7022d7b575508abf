// The same dimensionless problem in other units: a thousandth and a thousand times the length, 1e-3 and 1e6 times the
// modulus and the density, times that go with them. Every step takes the same iterations to the same result.
#include <gmock/gmock.h>

#include <filesystem>
#include <regex>

#include "energy/grab_spring.h"
#include "scene/scaling_cases_test.h"

namespace aspic {
namespace {

using namespace scaling;

class InOtherUnits : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const std::string& mesh = GetParam().mesh;
    if (!mesh.empty() && !std::filesystem::exists(mesh)) GTEST_SKIP() << "no " << mesh << ": ./run makes it";
  }
};
class SensitiveInOtherUnits : public InOtherUnits {};

// All combinations of small and large scales; for a large mesh half of them, with every pair.
std::vector<Scales> corners(const Case& scene, const Scales& small, const Scales& large) {
  std::vector<Scales> all;
  for (const int corner : {0b001, 0b010, 0b100, 0b111, 0b000, 0b011, 0b101, 0b110})
    all.push_back({corner & 1 ? large.length : small.length, corner & 2 ? large.modulus : small.modulus,
                   corner & 4 ? large.density : small.density});
  if (!scene.mesh.empty()) all.resize(4);
  return all;
}

// Scales by powers of two change no rounding.
void expect_same_bits(const Case& scene) {
  const Outcome meters = run(scene, {});
  for (const Scales& scales : corners(scene, {0x1p-10, 0x1p-10, 0x1p-10}, {0x1p10, 0x1p20, 0x1p20})) {
    SCOPED_TRACE(testing::Message() << scales);
    const Outcome scaled = run(scene, scales);
    ASSERT_EQ(scaled.status, meters.status);
    ASSERT_EQ(scaled.counts, meters.counts);
    ASSERT_EQ(scaled.numbers, meters.numbers);
  }
}
TEST_P(InOtherUnits, PowersOfTwoChangeNoBit) { expect_same_bits(GetParam()); }

TEST_P(InOtherUnits, IterationsAndDimensionlessResultsAgree) {
  const Outcome meters = run(GetParam(), {});
  ASSERT_FALSE(meters.status.empty());
  for (const Scales& scales : corners(GetParam(), {1e-3, 1e-3, 1e-3}, {1e3, 1e6, 1e6})) {
    SCOPED_TRACE(testing::Message() << scales);
    const Outcome scaled = run(GetParam(), scales);
    ASSERT_EQ(scaled.status, meters.status);
    ASSERT_EQ(scaled.counts, meters.counts);
    EXPECT_LT(difference(scaled, meters), GetParam().is_sensitive ? 1e-5 : 1e-9);
  }
}

// Contact amplifies the rounding of decimal scales, so that steps may take one iteration more.
class TouchingInOtherUnits : public testing::TestWithParam<Case> {};
TEST_P(TouchingInOtherUnits, PowersOfTwoChangeNoBit) { expect_same_bits(GetParam()); }

// If decimal scales change results by more than 1e-9, so does a change of the units by one bit, which is the error of
// the scaled input.
TEST_P(SensitiveInOtherUnits, DecimalScalesDifferLikeLastBitOfUnits) {
  const Outcome meters = run(GetParam(), {});
  double by_bits = 0, by_scales = 0;
  for (const int bits : {-3, -1, 1, 2, 5}) {
    const double longer = 1 + bits * 0x1p-52;
    by_bits = std::max(by_bits, difference(run(GetParam(), {longer, 1, 1}), meters));
  }
  for (const double scale : {1e-3, 1e3})
    by_scales = std::max(by_scales, difference(run(GetParam(), {scale, scale, 1e3}), meters));
  EXPECT_LT(by_scales, 1e-9 + 100 * by_bits);
  RecordProperty("by_bits", digits(by_bits));
  RecordProperty("by_scales", digits(by_scales));
}

std::string solver(const std::string& lines) { return "[solver]\n" + lines + "\n"; }

std::vector<Case> integrators() {
  std::vector<Case> cases;
  for (const char* name : {"backward_euler", "linearly_implicit_euler", "bdf2", "tr_bdf2", "midpoint", "trapezoid"})
    cases.push_back({name, "integrator = \"" + std::string(name) + "\""});
  cases.push_back(
      {"quasi_static", "integrator = \"quasi_static\"", std::regex_replace(kSagging, std::regex("1e5"), "4e5")});
  for (const char* name : {"symplectic_euler", "forward_euler", "rk4"})
    cases.push_back(
        {name, "integrator = \"" + std::string(name) + "\"", std::regex_replace(kSagging, std::regex("1e5"), "1e3")});
  for (const char* name : {"backward_euler", "rk4"})
    cases.push_back({"adaptive_" + std::string(name),
                     "integrator = \"" + std::string(name) + "\"\nadaptive = { tolerance = 1e-3 }"});
  return cases;
}

std::vector<Case> minimizers() {
  std::vector<Case> cases;
  for (const char* method : {"newton", "newton_cg"})
    for (const char* definiteness : {"on_demand", "progressive", "clamped", "absolute"})
      cases.push_back({std::string(method) + "_" + definiteness,
                       solver("method = \"" + std::string(method) + "\"\ndefiniteness = \"" + definiteness + "\"")});
  for (const char* linear : {"cholesky", "multigrid", "block_jacobi"})
    cases.push_back({linear, solver("linear = \"" + std::string(linear) + "\"")});
  for (const char* method : {"lbfgs", "nonlinear_cg", "gradient_descent"})
    for (const char* preconditioner : {"mass", "diagonal", "hessian"})
      cases.push_back({std::string(method) + "_" + preconditioner,
                       solver("max_iterations = 20\nmethod = \"" + std::string(method) + "\"\npreconditioner = \"" +
                              preconditioner + "\""),
                       kSagging,
                       {},
                       method != std::string("gradient_descent") && preconditioner != std::string("hessian")});
  for (const char* method : {"lbfgs", "nonlinear_cg"})
    cases.push_back({std::string(method) + "_none",
                     solver("max_iterations = 20\npreconditioner = \"none\"\nmethod = \"" + std::string(method) + "\""),
                     kSagging,
                     {},
                     true});
  for (const char* criterion : {"first_gradient", "decrement"})
    cases.push_back({criterion, solver("criterion = \"" + std::string(criterion) + "\"")});
  cases.push_back({"velocity", solver("criterion = \"velocity\"\ntolerance = <1e-5 m/s>")});
  cases.push_back({"acceleration", solver("criterion = \"acceleration\"\ntolerance = <1e-3 m/s^2>")});
  cases.push_back({"newtons", solver("criterion = \"absolute\"\ntolerance = <1e-4 N>")});
  for (const char* guess : {"zero", "current", "extrapolated", "last_increment", "accelerated"})
    cases.push_back({"from_" + std::string(guess), solver("initial_guess = \"" + std::string(guess) + "\"")});
  cases.push_back({"lumped", solver("mass = \"lumped\"")});
  return cases;
}

std::string with(const std::string& text, const std::string& old, const std::string& now) {
  std::string changed = text;
  changed.replace(changed.find(old), old.size(), now);
  return changed;
}

std::vector<Case> materials_and_loads() {
  std::vector<Case> cases;
  for (const MaterialInfo& info : materials())
    cases.push_back({info.name, "", with(kSagging, "{ young", "{ model = \"" + info.name + "\", young")});
  const std::string log = with(kSagging, "{ young", "{ model = \"neo_hookean_log\", young");
  cases.push_back(
      {"checkered", "",
       with(with(kSagging, "young = <1e5 Pa>", "young = \"<1e3 Pa> * (1 + 999 * (sin(X / <0.02 m>) > 0))\""),
            "density = <1000 kg/m^3>", "density = \"<500 kg/m^3> * (1 + X / <0.4 m>)\"")});
  cases.push_back({"moved_pins", "",
                   log + "[[body.pin]]\nwhere = \"X > <0.3999 m>\"\n" +
                       "motion = { linear = { velocity = [<0.5 m/s>, <1 m/s>, 0], until = <0.06 s> } }\n"});
  cases.push_back({"turned_pins", solver("definiteness = \"progressive\""),
                   kSagging + "[[body.pin]]\nwhere = \"X > <0.3999 m>\"\n" +
                       "motion = { rotate = { axis = [1, 0, 0], rate_deg = <2000 deg/s> } }\n"});
  cases.push_back({"keyframes", "",
                   kSagging + "[[body.pin]]\nwhere = \"X > <0.3999 m>\"\nmotion = { keyframes = [{ time = <0.05 s>, " +
                       "displacement = [0, <0.1 m>, 0] }] }\n"});
  cases.push_back(
      {"damped", "",
       kBeam + kRubber + "damping = { mass = <2 1/s>, stiffness = <0.001 s>, viscosity = <5 Pa s> }\n" + kWall});
  cases.push_back({"springs_alone", "",
                   kBeam + "elastic = false\nmaterial = { density = <1000 kg/m^3> }\n" + kWall +
                       "[[body.spring]]\nedges = true\nstiffness = <2000 N/m>\n"});
  cases.push_back({"dragged", "",
                   kSagging + "[[body.spring]]\nwhere = \"X > <0.3999 m>\"\nstiffness = <300 N/m>\n" +
                       "motion = { linear = { velocity = [0, 0, <2 m/s>] } }\n"});
  cases.push_back({"loaded", "",
                   kSagging + "[[body.traction]]\nwhere = \"Y > <0.0999 m>\"\ndead_pressure = <500 Pa>\n" +
                       "[[body.force]]\nvalue = [0, 0, <2e4 N/m^3>]\n"});
  cases.push_back(
      {"thrown", "", kBeam + kRubber + "velocity = [<1 m/s>, <2 m/s>, 0]\n" + "angular_velocity = [0, 0, <5 1/s>]\n"});
  for (const char* definiteness : {"on_demand", "progressive", "absolute"})
    for (const char* matrix : {"[[-1, 0, 0], [0, 1, 0], [0, 0, 1]]", "[[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]"})
      cases.push_back({std::string(definiteness) + (matrix[2] == '-' ? "_mirrored" : "_shrunk"),
                       solver("max_iterations = 40\ndefiniteness = \"" + std::string(definiteness) + "\""),
                       kBeam + kRubber + "deform = { matrix = " + matrix + " }\n" + kWall});
  cases.push_back({"two_bodies", "",
                   kSagging + "[[body.spring]]\nto_body = \"ball\"\nbetween = [[10, 3]]\nstiffness = <100 N/m>\n" +
                       "[[body]]\nname = \"ball\"\nshape = { sphere = { radius = <0.1 m>, size = <0.08 m> } }\n" +
                       "translate = [0, <-0.3 m>, 0]\nmaterial = { young = <1e4 Pa>, density = <500 kg/m^3> }\n"});
  return cases;
}

// Two boxes that fall onto a floor and each other; a ball pushes them.
std::vector<Case> touching() {
  const auto box = [](const std::string& name, const std::string& place, const std::string& speed) {
    return "[[body]]\nname = \"" + name + "\"\nshape = { box = { " + place + " } }\nvelocity = [0, <" + speed +
           " m/s>, 0]\n" + kRubber;
  };
  const std::string floor = "[[obstacle]]\nname = \"floor\"\nplane = {}\n",
                    ball =
                        "[[obstacle]]\nname = \"ball\"\nsphere = { center = [<0.18 m>, <0.1 m>, <0.05 m>], "
                        "radius = <0.05 m> }\nmotion = { displacement = [\"<-1 m/s> * t\", 0, 0] }\n",
                    boxes = box("lower",
                                "lower = [0, <0.001 m>, 0], upper = [<0.1 m>, <0.1 m>, <0.1 m>], "
                                "cells = [2, 2, 2]",
                                "-0.3") +
                            box("upper",
                                "lower = [<0.03 m>, <0.102 m>, <0.04 m>], upper = [<0.12 m>, <0.2 m>, "
                                "<0.12 m>], cells = [2, 1, 3]",
                                "-1"),
                    friction = "[contact]\nfriction = 0.4\n";
  return {{.name = "smooth", .bodies = floor + boxes},
          {.name = "rough", .bodies = friction + floor + boxes},
          {.name = "pushed", .bodies = friction + floor + ball + boxes}};
}

std::vector<Case> hands() {
  const auto grab = [](Model& model, const Scales& s) {
    auto spring = std::make_unique<GrabSpring>();
    const Vec3d from = s.length * Vec3d{{0.4, 0.1, 0.1}}, to = s.length * Vec3d{{0.5, 0.2, 0.1}};
    spring->set({.vertices = model.mesh.tets.back(),
                 .weights = {0.25, 0.25, 0.25, 0.25},
                 .stiffness = 400 * s.of("N/m"),
                 .from = from,
                 .to = to,
                 .to_time = 0.05 * s.of("s")});
    model.loads.push_back(std::move(spring));
  };
  return {{"mouse", "", kSagging, grab}};
}

// Tets of a real shape, of many sizes, in the storage order of the program.
std::vector<Case> real_meshes() {
  const std::filesystem::path file = std::filesystem::path(ASPIC_SOURCE_DIR) / "scenes" / "bunny.mesh";
  const std::string bunny =
      "[[body]]\nname = \"bunny\"\nmesh = \"bunny.mesh\"\nscale = <0.1 m>\nvelocity = [<1 m/s>, 0, 0]\n" + kRubber +
      "[[body.pin]]\nwhere = { lowest = 0.05 }\n";
  std::vector<Case> cases;
  for (const char* integrator : {"backward_euler", "midpoint"})
    for (const char* linear : {"cholesky", "multigrid", "block_jacobi"})
      cases.push_back({.name = std::string("bunny_") + integrator + "_" + linear,
                       .options = "integrator = \"" + std::string(integrator) + "\"\n" +
                                  solver("linear = \"" + std::string(linear) + "\""),
                       .bodies = bunny,
                       .is_sensitive = linear != std::string("cholesky"),
                       .mesh = file.string(),
                       .steps = 2});
  return cases;
}

std::vector<Case> sensitive(std::vector<Case> cases) {
  std::erase_if(cases, [](const Case& c) { return !c.is_sensitive; });
  return cases;
}

std::string case_name(const testing::TestParamInfo<Case>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Integrators, InOtherUnits, testing::ValuesIn(integrators()), case_name);
INSTANTIATE_TEST_SUITE_P(Minimizers, InOtherUnits, testing::ValuesIn(minimizers()), case_name);
INSTANTIATE_TEST_SUITE_P(Bodies, InOtherUnits, testing::ValuesIn(materials_and_loads()), case_name);
INSTANTIATE_TEST_SUITE_P(RealMeshes, InOtherUnits, testing::ValuesIn(real_meshes()), case_name);
INSTANTIATE_TEST_SUITE_P(Minimizers, SensitiveInOtherUnits, testing::ValuesIn(sensitive(minimizers())), case_name);
INSTANTIATE_TEST_SUITE_P(RealMeshes, SensitiveInOtherUnits, testing::ValuesIn(sensitive(real_meshes())), case_name);
INSTANTIATE_TEST_SUITE_P(Contact, TouchingInOtherUnits, testing::ValuesIn(touching()), case_name);
INSTANTIATE_TEST_SUITE_P(Hands, InOtherUnits, testing::ValuesIn(hands()), case_name);

}  // namespace
}  // namespace aspic
