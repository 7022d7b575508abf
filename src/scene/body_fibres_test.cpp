// Fibres of a scene: equilibria, directions, mistakes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "material/fibre_law.h"
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

// Solves E l (l^2 - 1) / 2 + 2 l k1 s exp(k2 s^2) = traction, s = l^2 - 1 - eps/2, by bisection.
double exact_stretch(double k1) {
  double low = 1, high = 2;
  for (int i = 0; i < 100; ++i) {
    const double l = 0.5 * (low + high), s = l * l - 1 - FibreLaw::kEps / 2;
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
  EXPECT_THAT(refusal(kCube + muscle("activation = \"X\"")), HasSubstr("may use only t"));
  EXPECT_THAT(refusal(kCube + muscle("activation = 1.5")), HasSubstr("activation = 1.5 at t = 0"));
}

}  // namespace
}  // namespace aspic
