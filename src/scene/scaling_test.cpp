// The same dimensionless problem in other units: a thousandth and a thousand times the length, 1e-3 and 1e6 times the
// modulus and the density, times that go with them. Every step takes the same iterations to the same result.
#include <gmock/gmock.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <regex>

#include "energy/grab_spring.h"
#include "energy/held_tip.h"
#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

struct Scales {
  double length = 1, modulus = 1, density = 1;

  double time() const { return length * std::sqrt(density / modulus); }
  double of(const std::string& unit) const {
    const double t = time(), energy = modulus * length * length * length;
    const std::map<std::string, double> known = {{"m", length},
                                                 {"s", t},
                                                 {"1/s", 1 / t},
                                                 {"m/s", length / t},
                                                 {"m/s^2", length / (t * t)},
                                                 {"Pa", modulus},
                                                 {"Pa s", modulus * t},
                                                 {"kg/m^3", density},
                                                 {"N/m", modulus * length},
                                                 {"N/m^3", modulus / length},
                                                 {"N", modulus * length * length},
                                                 {"J", energy},
                                                 {"deg/s", 1 / t}};
    return known.at(unit);
  }
};

std::string digits(double x) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::scientific).ptr;
  return {buffer.data(), end};
}

// "<0.4 m>" becomes 0.4 in the units of `scales`.
std::string in_units(const std::string& text, const Scales& scales) {
  static const std::regex quantity("<([-+0-9.e]+) ([A-Za-z0-9/^ ]+)>");
  std::string result;
  std::sregex_iterator it(text.begin(), text.end(), quantity), end;
  size_t done = 0;
  for (; it != end; ++it) {
    result.append(text, done, it->position() - done);
    result += digits(std::stod((*it)[1]) * scales.of((*it)[2]));
    done = it->position() + it->length();
  }
  return result + text.substr(done);
}

const std::string kTime = "gravity = [0, <-9.81 m/s^2>, 0]\n[time]\nstep = <0.02 s>\nduration = <0.1 s>\n";
const std::string kBeam =
    "[[body]]\nname = \"beam\"\nshape = { box = { upper = [<0.4 m>, <0.1 m>, <0.1 m>], cells = [6, 2, 2] } }\n";
const std::string kRubber = "material = { young = <1e5 Pa>, poisson = 0.4, density = <1000 kg/m^3> }\n";
const std::string kWall = "[[body.pin]]\nwhere = \"X < <1e-9 m>\"\n";
const std::string kSagging = kBeam + kRubber + kWall;

// What happens to the body, for the solvers and schemes that are given.
struct Case {
  std::string name;
  std::string options;  // after kTime
  std::string bodies = kSagging;
  std::function<void(Model&, const Scales&)> amend = {};
  double tolerance = 1e-9;  // of the result
};

// Of methods that measure a curvature as a difference of two gradients, which knows half of the digits.
constexpr double kOfDifferences = 1e-5;
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

struct Outcome {
  std::vector<std::string> status;
  std::vector<int> counts;
  std::vector<double> numbers;  // dimensionless
};

Outcome run(const Case& c, const Scales& scales) {
  const TestFolder folder;
  SceneOptions options;
  if (c.amend) options.amend = [&](Model& model) { c.amend(model, scales); };
  Scene scene = load_scene(folder.write("scene.toml", in_units(kTime + c.options + "\n" + c.bodies, scales)), options);
  Outcome outcome;
  for (int i = 0; i < scene.steps; ++i) {
    const StepReport report = scene.simulation.step();
    outcome.status.emplace_back(to_string(report.status));
    for (const int count : {report.iterations, report.trials, report.substeps, report.rejected})
      outcome.counts.push_back(count);
    for (const double energy : {report.kinetic, report.potential_total})
      outcome.numbers.push_back(energy / scales.of("J") / 100);  // of the order of 100 J
    for (const double q : positions(scene)) outcome.numbers.push_back(q / scales.of("m"));
    for (const double v : velocities(scene)) outcome.numbers.push_back(v / scales.of("m/s"));
  }
  return outcome;
}

class InOtherUnits : public testing::TestWithParam<Case> {};

// Nothing is rounded differently where all scales are powers of two.
TEST_P(InOtherUnits, PowersOfTwoChangeNoBit) {
  const Outcome metres = run(GetParam(), {});
  for (const double length : {0x1p-10, 0x1p10})
    for (const double modulus : {0x1p-10, 0x1p20})
      for (const double density : {0x1p-10, 0x1p20}) {
        SCOPED_TRACE(testing::Message() << "length " << length << ", modulus " << modulus << ", density " << density);
        const Outcome scaled = run(GetParam(), {length, modulus, density});
        ASSERT_EQ(scaled.status, metres.status);
        ASSERT_EQ(scaled.counts, metres.counts);
        ASSERT_EQ(scaled.numbers, metres.numbers);
      }
}

TEST_P(InOtherUnits, TheIterationsAndTheDimensionlessResultAreTheSame) {
  const Outcome metres = run(GetParam(), {});
  ASSERT_FALSE(metres.status.empty());
  for (const double length : {1e-3, 1e3})
    for (const double modulus : {1e-3, 1e6})
      for (const double density : {1e-3, 1e6}) {
        SCOPED_TRACE(testing::Message() << "length " << length << ", modulus " << modulus << ", density " << density);
        const Outcome scaled = run(GetParam(), {length, modulus, density});
        ASSERT_EQ(scaled.status, metres.status);
        ASSERT_EQ(scaled.counts, metres.counts);
        double worst = 0;
        for (size_t i = 0; i < metres.numbers.size(); ++i)
          worst = std::max(worst, std::abs(scaled.numbers[i] - metres.numbers[i]));
        EXPECT_LT(worst, GetParam().tolerance);
      }
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

std::vector<Case> minimisers() {
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
                       preconditioner == std::string("hessian") ? 1e-9 : kOfDifferences});
  for (const char* method : {"lbfgs", "nonlinear_cg"})
    cases.push_back({std::string(method) + "_none",
                     solver("max_iterations = 20\npreconditioner = \"none\"\nmethod = \"" + std::string(method) + "\""),
                     kSagging,
                     {},
                     kOfDifferences});
  cases.push_back({"vertex_descent", solver("max_iterations = 20\nmethod = \"vertex_descent\"")});
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
                   kSagging + "[[body.traction]]\nwhere = \"Y > <0.0999 m>\"\npressure = <500 Pa>\n" +
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

std::vector<Case> hands() {
  const auto grab = [](Model& model, const Scales& s) {
    auto spring = std::make_unique<GrabSpring>();
    const Vec3d from = s.length * Vec3d{{0.4, 0.1, 0.1}}, to = s.length * Vec3d{{0.5, 0.2, 0.1}};
    spring->set({.vertices = model.mesh.tets.back(),
                 .weights = {0.25, 0.25, 0.25, 0.25},
                 .stiffness = 400 * s.of("N/m"),
                 .from = from,
                 .to = to,
                 .to_time = 0.05 * s.of("s")},
                0);
    model.loads.push_back(std::move(spring));
  };
  const auto poke = [](Model& model, const Scales& s) {
    auto tip = std::make_unique<HeldTip>(model.mesh);
    const double m = s.length;
    const TipPose touch{.center = m * Vec3d{{0.3, 0.1, 0.05}}, .axis = {{0, -1, 0}}};
    const Tip disc{.shape = TipShape::disc, .radius = 0.03 * m, .stiffness = 1e7 * s.of("Pa") / m};
    Poke into{.touch = std::make_shared<Touch>(Touch{disc, touch, touch}), .from = touch, .to = touch};
    into.to.center = touch.center - m * Vec3d{{0, 0.03, 0}};
    into.to_time = 0.05 * s.of("s");
    tip->set(into, 0);
    model.loads.push_back(std::move(tip));
  };
  return {{"mouse", "", kSagging, grab}, {"probe", "", kSagging, poke}};
}

std::string case_name(const testing::TestParamInfo<Case>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Integrators, InOtherUnits, testing::ValuesIn(integrators()), case_name);
INSTANTIATE_TEST_SUITE_P(Minimisers, InOtherUnits, testing::ValuesIn(minimisers()), case_name);
INSTANTIATE_TEST_SUITE_P(Bodies, InOtherUnits, testing::ValuesIn(materials_and_loads()), case_name);
INSTANTIATE_TEST_SUITE_P(Hands, InOtherUnits, testing::ValuesIn(hands()), case_name);

}  // namespace
}  // namespace aspic
