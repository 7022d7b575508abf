// Fibres of a scene: equilibria, directions, mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "io/vtu.h"
#include "scene/scene_cases_test.h"
#include "scene/value.h"

namespace aspic {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kTraction = 4e4;  // [Pa]

// A cube of a material that does not contract, held on rollers and pulled along x.
std::string pulled(const std::string& fibres) {
  return "gravity = [0, 0, 0]\n[time]\nintegrator = \"quasi_static\"\n[solver]\ntolerance = 1e-12\n" + kCube +
         "material = { model = \"stvk\", young = 1e5, poisson = 0 }\n[[body.pin]]\nwhere = \"x < 0.1\"\naxes = \"x\"\n"
         "[[body.pin]]\nwhere = \"y < 0.1\"\naxes = \"y\"\n[[body.pin]]\nwhere = \"z < 0.1\"\naxes = \"z\"\n"
         "[[body.traction]]\nwhere = \"x > 0.9\"\nvalue = [4e4, 0, 0]\n" +
         fibres;
}

std::string fibre(const std::string& keys) { return "[[body.fibre]]\nstiffness = 3e4\nexponent = 0.8\n" + keys + "\n"; }

std::string muscle(const std::string& keys) {
  return "[[body.muscle]]\nstrength = 2e4\ndirection = [1, 0, 0]\n" + keys + "\n";
}

std::vector<double> equilibrium(const std::string& fibres) {
  Scene scene = load(pulled(fibres));
  EXPECT_TRUE(is_success(scene.simulation.step().status));
  return positions(scene);
}

double stretch(const std::vector<double>& q) {
  double most = 0;
  for (size_t i = 0; i < q.size(); i += 3) most = std::max(most, q[i]);
  return most;
}

// Solves E l (l^2 - 1) / 2 + 2 l k1 s exp(k2 s^2) = traction, s = l^2 - 1, by bisection.
double exact_stretch(double k1) {
  double low = 1, high = 2;
  for (int i = 0; i < 100; ++i) {
    const double l = 0.5 * (low + high), s = l * l - 1;
    (1e5 * l * (l * l - 1) / 2 + 2 * l * k1 * s * std::exp(0.8 * s * s) > kTraction ? high : low) = l;
  }
  return low;
}

TEST(Fibres, PulledCubeHasTheStretchOfTheFormula) {
  EXPECT_NEAR(stretch(equilibrium("")), exact_stretch(0), 1e-9);
  EXPECT_NEAR(stretch(equilibrium(fibre("direction = [2, 0, 0]"))), exact_stretch(3e4), 1e-9);
  const std::string across = fibre("direction = [0, 1, 0]");
  EXPECT_NEAR(stretch(equilibrium(across)), exact_stretch(0), 1e-9);
  EXPECT_NEAR(stretch(equilibrium(across + fibre("direction = [1, 0, 0]"))), exact_stretch(3e4), 1e-9);
}

TEST(Fibres, QuadraticTetsHaveTheSameStretch) {
  for (const std::string& part : {fibre("direction = [1, 0, 0]"), muscle("activation = 0.5")}) {
    const auto stretched = [&](const std::string& order) {
      std::string text = pulled(part);
      text.insert(text.find("material = "), order);
      Scene scene = load(text);
      EXPECT_TRUE(is_success(scene.simulation.step().status));
      return stretch(positions(scene));
    };
    EXPECT_NEAR(stretched("order = 2\n"), stretched(""), 1e-9);
  }
}

TEST(Fibres, RunFromOnePlaceToAnother) {
  const std::vector<double> straight = equilibrium(fibre("direction = [1, 0, 0]"));
  const std::vector<double> flowing =
      equilibrium(fibre("from = \"x < 0.1\"\nto = { box = { lower = [0.9, 0, 0], upper = [1, 1, 1] } }"));
  ASSERT_EQ(straight.size(), flowing.size());
  for (size_t i = 0; i < straight.size(); ++i) EXPECT_NEAR(straight[i], flowing[i], 1e-9);
}

TEST(Fibres, AreATermOfTheEnergyBalance) {
  Scene scene = load(pulled(fibre("direction = [\"1 + Y\", \"X\", 0]\ndispersion = \"0.1 + 0.1 * X\"")));
  const StepReport report = scene.simulation.step();
  EXPECT_TRUE(is_success(report.status));
  const std::vector<std::string> names = scene.simulation.potential_names();
  const auto at = std::find(names.begin(), names.end(), "fibre");
  ASSERT_NE(at, names.end());
  EXPECT_GT(report.potential[at - names.begin()], 0);
}

// Without load, E l (l^2 - 1) / 2 + strength activation (1 - 4 (1 - l)^2) = 0.
TEST(Muscle, ContractsUntilTheMaterialBalancesIt) {
  for (const double activation : {0.0, 0.5, 1.0}) {
    double low = 0.7, high = 1;
    for (int i = 0; i < 100; ++i) {
      const double l = 0.5 * (low + high);
      (1e5 * l * (l * l - 1) / 2 + 2e4 * activation * (1 - 4 * (1 - l) * (1 - l)) > 0 ? high : low) = l;
    }
    std::string text = pulled(muscle("activation = " + number_text(activation)));
    text.replace(text.find("value = [4e4"), 12, "value = [0");
    Scene scene = load(text);
    EXPECT_TRUE(is_success(scene.simulation.step().status));
    EXPECT_NEAR(stretch(positions(scene)), high, 1e-9) << activation;
  }
}

TEST(Muscle, ActivationIsAFunctionOrValuesAtTimes) {
  const auto contracted = [](const std::string& activation) {
    return equilibrium(muscle("activation = " + activation));
  };
  const std::vector<double> by_function = contracted("\"min(1, t)\"");
  EXPECT_EQ(contracted("[{ time = 0, level = 0 }, { time = 1, level = 1 }]"), by_function);
  EXPECT_NE(contracted("[{ time = 0, level = 0.25 }]"), by_function);
}

TEST(Muscle, WorkOfTheActivationBalancesTheEnergy) {
  Scene scene = load(kCube + "[[body.pin]]\nwhere = \"x < 0.1\"\n" + muscle("activation = \"min(1, 20 * t)\""));
  double largest = 0, work = 0;
  for (int i = 0; i < 10; ++i) {
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status));
    for (const double energy : report.potential) largest = std::max(largest, std::abs(energy));
    EXPECT_LE(std::abs(report.ledger_error), 1e-9 * largest);
    work += report.target_work.back();
  }
  EXPECT_GT(work, 0);
}

// The stress of Guccione's law along its fibres is l C exp(bf E^2) bf E, E = (l^2 - 1)/2.
TEST(Fibres, GuccionesLawHasTheStretchOfTheFormula) {
  double low = 1, high = 2;
  for (int i = 0; i < 100; ++i) {
    const double l = 0.5 * (low + high), E = (l * l - 1) / 2;
    (l * (1e5 * E + 1e4 * std::exp(6 * E * E) * 6 * E) > kTraction ? high : low) = l;
  }
  const std::string law =
      "[[body.fibre]]\nlaw = \"guccione\"\nstiffness = 1e4\nalong = 6\nacross = 2\nshear = 3\ndirection = [1, 0, 0]\n";
  EXPECT_NEAR(stretch(equilibrium(law)), high, 1e-9);
}

// l P = C3 (exp(C4 (l - 1)) - 1) while fibres straighten, and C5 l + C6 beyond.
TEST(Fibres, WeisssLawHasTheStretchOfTheFormula) {
  for (const double straight : {1.05, 1.9}) {
    double low = 1, high = 2;
    for (int i = 0; i < 100; ++i) {
      const double l = 0.5 * (low + high), pull = 1e3 * (std::exp(4 * (std::min(l, straight) - 1)) - 1);
      const double fibres = (pull + 2e5 * std::max(l - straight, 0.0)) / l;
      (1e5 * l * (l * l - 1) / 2 + fibres > kTraction ? high : low) = l;
    }
    const std::string law =
        "[[body.fibre]]\nlaw = \"weiss\"\nstiffness = 1e3\nexponent = 4\nstraight_stiffness = 2e5\n";
    EXPECT_NEAR(stretch(equilibrium(law + "direction = [1, 0, 0]\nstraight_stretch = " + number_text(straight) + "\n")),
                high, 1e-9);
  }
}

// Without load, l (E (l^2 - 1) / 2 + T) = 0.
TEST(Muscle, TensionContractsUntilTheMaterialBalancesIt) {
  std::string text = pulled(muscle("activation = 0.5\nlaw = \"tension\""));
  text.replace(text.find("value = [4e4"), 12, "value = [0");
  Scene scene = load(text);
  EXPECT_TRUE(is_success(scene.simulation.step().status));
  EXPECT_NEAR(stretch(positions(scene)), std::sqrt(1 - 2 * 1e4 / 1e5), 1e-9);
}

// In a plate between y = 0 and 1 the angle to the circumference x falls from 60 to -60 degrees.
TEST(Fibres, HelixTurnsThroughTheWall) {
  const std::string helix =
      "helix = { inner = \"y < 0.1\", outer = \"y > 0.9\", axis = [0, 0, 1], inner_angle_deg = 60, "
      "outer_angle_deg = -60 }";
  const std::string formula = "direction = [\"-cos(pi / 3 * (1 - 2 * Y))\", 0, \"sin(pi / 3 * (1 - 2 * Y))\"]";
  const std::vector<double> expected = equilibrium(fibre(formula)), wound = equilibrium(fibre(helix));
  ASSERT_EQ(wound.size(), expected.size());
  for (size_t i = 0; i < wound.size(); ++i) EXPECT_NEAR(wound[i], expected[i], 1e-9);
}

TEST(Fibres, DirectionsFromFilesGiveTheSameShape) {
  const TestFolder folder;
  const std::string laws = pulled(fibre("direction = [1, 1, 0]")), key = "direction = [1, 1, 0]";
  const auto with = [&](const std::string& directions) {
    std::string text = laws;
    text.replace(text.find(key), key.size(), "directions = { " + directions + " }");
    Scene scene = load_scene(folder.write("scene.toml", text));
    EXPECT_TRUE(is_success(scene.simulation.step().status));
    return positions(scene);
  };
  Scene straight = load(laws);
  const TetMesh& mesh = straight.simulation.model().mesh;
  std::string lines = "ax ay az\n";
  for (int t = 0; t < mesh.tet_count(); ++t) lines += t % 2 ? "1 1 0\n" : "-2, -2, 0\n";
  folder.write("fibres.txt", lines);
  Field per_tet{"a", 3, {}}, per_vertex{"b", 3, {}};
  for (int t = 0; t < mesh.tet_count(); ++t) per_tet.values.insert(per_tet.values.end(), {3, 3, 0});
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double sign = v % 2 ? 1 : -1;  // of axes without a sense
    per_vertex.values.insert(per_vertex.values.end(), {sign, sign, 0});
  }
  std::vector<double> points;
  for (const Vec3d& X : mesh.rest) points.insert(points.end(), {X[0], X[1], X[2]});
  write_vtu((folder / "fibres.vtu").string(), points, mesh.tets, {{per_vertex}, {per_tet}});
  EXPECT_TRUE(is_success(straight.simulation.step().status));
  for (const char* file :
       {"file = \"fibres.txt\"", "file = \"fibres.vtu\", name = \"a\"", "file = \"fibres.vtu\", name = \"b\""})
    for (size_t i = 0; const double q : with(file)) EXPECT_NEAR(q, positions(straight)[i++], 1e-9) << file;
  EXPECT_THAT(refusal(pulled(fibre("directions = { file = \"none.txt\" }"))), HasSubstr("none.txt"));
  folder.write("few.txt", "1 0 0\n");
  EXPECT_THROW(with("file = \"few.txt\""), InvalidInput);
  EXPECT_THROW(with("file = \"fibres.vtu\", name = \"c\""), InvalidInput);
}

TEST(Muscle, LosesEnergyByItsVelocity) {
  const std::string text = kCube + "[[body.pin]]\nwhere = \"x < 0.1\"\n";
  Scene scene = load(text + muscle("activation = \"min(1, 20 * t)\"\nmax_velocity = 5"));
  double largest = 0, loss = 0;
  for (int i = 0; i < 10; ++i) {
    const StepReport report = scene.simulation.step();
    EXPECT_TRUE(is_success(report.status));
    EXPECT_GE(report.damping_loss, 0);
    for (const double energy : report.potential) largest = std::max(largest, std::abs(energy));
    EXPECT_LE(std::abs(report.ledger_error), 1e-9 * largest);
    loss += report.damping_loss;
  }
  EXPECT_GT(loss, 0);
}

TEST(Fibres, MistakesAreExplained) {
  const auto of = [](const std::string& keys) { return refusal(pulled(fibre(keys))); };
  EXPECT_THAT(of("direction = [\"X - 0.125\", 0, 0]"),
              AllOf(HasSubstr("no direction in tet"), HasSubstr("length is 0")));
  EXPECT_THAT(of("from = \"x < 0.6\"\nto = \"x > 0.4\""), HasSubstr("is in `from` and in `to`"));
  EXPECT_THAT(of("from = \"x < 0.1\""), HasSubstr("to"));
  EXPECT_THAT(of("direction = [1, 0, 0]\nfrom = \"x < 0.1\"\nto = \"x > 0.9\""), HasSubstr("excludes"));
  EXPECT_THAT(of("direction = [1, 0, 0]\ndispersion = 0.4"), HasSubstr("dispersion = 0.4; must be"));
  EXPECT_THAT(of("direction = [1, 0]"), HasSubstr("direction"));
  EXPECT_THAT(refusal(kCube + muscle("")), HasSubstr("activation"));
  EXPECT_THAT(refusal(kCube + muscle("activation = []")), HasSubstr("activation = []; at least one is needed"));
  EXPECT_THAT(refusal(kCube + muscle("activation = [{ time = 0, level = 2 }]")), HasSubstr("level = 2"));
  EXPECT_THAT(refusal(kCube + muscle("activation = [{ time = 1, level = 1 }, { time = 1, level = 0 }]")),
              HasSubstr("must be later than the previous one"));
  EXPECT_THAT(refusal(kCube + "[[body.muscle]]\nstrength = 1\nactivation = 1\n"),
              HasSubstr("muscle needs one of: direction | from, to | helix | directions"));
  EXPECT_THAT(of("direction = [1, 0, 0]\nlaw = \"guccione\""), HasSubstr("exponent = 0.8"));
  EXPECT_THAT(refusal(kCube + "[[body.fibre]]\nlaw = \"guccione\"\nstiffness = 1\ndirection = [1, 0, 0]\nalong = 1\n"),
              HasSubstr("law = \"guccione\" needs `across`"));
  EXPECT_THAT(of("direction = [1, 0, 0]\nlaw = \"weiss\"\nstraight_stretch = 99\nstraight_stiffness = 1"),
              HasSubstr("must be at most 10"));
  EXPECT_THAT(refusal(kCube + muscle("activation = 1\ncurvature = 0.3")), HasSubstr("without max_velocity"));
  EXPECT_THAT(refusal(kCube + muscle("activation = 1\nlaw = \"tension\"\noptimal_stretch = 1.1")),
              HasSubstr("does not use it"));
  EXPECT_THAT(refusal(kCube + muscle("activation = \"X\"")), HasSubstr("may use only t"));
  EXPECT_THAT(refusal(kCube + muscle("activation = 1.5")),
              AllOf(HasSubstr(": activation = 1.5 at t = 0"), ::testing::Not(HasSubstr(".toml: "))));
}

}  // namespace
}  // namespace aspic
