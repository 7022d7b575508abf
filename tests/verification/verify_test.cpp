// All checks pass, and fail with defective subjects.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/membrane_reference.h"
#include "reference/radial_reference.h"
#include "verification/check.h"

namespace aspic::verify {

void PrintTo(const Check& check, std::ostream* out) { *out << check.key(); }

namespace {

class QuickCheck : public testing::TestWithParam<Check> {};

TEST_P(QuickCheck, Passes) {
  const Findings found = run_check(GetParam(), {.quick = true, .instead = {}});
  EXPECT_FALSE(found.rows.empty());
  for (const Row& row : found.rows) {
    EXPECT_TRUE(row.passes()) << row.quantity << ": " << row.measured << ", not " << row.reference << " +- "
                              << row.tolerance;
    EXPECT_FALSE(row.reason.empty()) << row.quantity;
  }
}

std::string test_name(const testing::TestParamInfo<Check>& info) {
  std::string name = info.param.key();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Every, QuickCheck, testing::ValuesIn(checks()), test_name);

TEST(Checks, HaveDistinctNames) {
  for (const Check& check : checks())
    EXPECT_EQ(std::count_if(checks().begin(), checks().end(), [&](const Check& c) { return c.key() == check.key(); }),
              1)
        << check.key();
}

struct Wrong {
  std::string check, name, instead;
  std::vector<std::string> rows = {""};  // each must be part of a failing quantity
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.check << " with " << wrong.instead; }
class WrongSubject : public testing::TestWithParam<Wrong> {};

TEST_P(WrongSubject, FailsTheCheck) {
  const Wrong& wrong = GetParam();
  const auto check =
      std::find_if(checks().begin(), checks().end(), [&](const Check& c) { return c.key() == wrong.check; });
  ASSERT_NE(check, checks().end()) << wrong.check;
  Subject subject{.quick = true, .instead = {{wrong.name, wrong.instead}}};
  if (wrong.name == "stiffness") subject = {.quick = true, .instead = {}, .stiffness = std::stod(wrong.instead)};
  const Findings found = run_check(*check, subject);
  for (const std::string& part : wrong.rows)
    EXPECT_TRUE(std::any_of(found.rows.begin(), found.rows.end(),
                            [&](const Row& r) { return !r.passes() && r.quantity.find(part) != std::string::npos; }))
        << wrong.check << " " << part;
}

std::string wrong_name(const testing::TestParamInfo<Wrong>& info) {
  std::string name = std::to_string(info.index) + "_" + info.param.check + "_with_" + info.param.instead;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || c == '.'; }, '_');
  return name;
}
// One case per kind of reference.
INSTANTIATE_TEST_SUITE_P(
    Every, WrongSubject,
    testing::Values(
        Wrong{"materials/uniaxial_table", "neo_hookean", "neo_hookean_log"},
        Wrong{"materials/uniaxial", "fung", "mooney_rivlin"},
        Wrong{"patch/symmetry_planes", "neo_hookean", "neo_hookean_log", {"lateral", "reaction"}},
        Wrong{"derivatives/automatic", "neo_hookean_log", "neo_hookean_log_j2"},
        Wrong{"derivatives/taylor", "neo_hookean_log", "neo_hookean_log_j2", {"random"}},
        Wrong{"derivatives/edges", "neo_hookean_log", "stvk"}, Wrong{"invariants/forces", "corotated", "linear"},
        Wrong{"invariants/rigid_motions", "stvk", "linear"},
        Wrong{"invariants/angular_momentum", "midpoint", "backward_euler"},
        Wrong{"invariants/angular_momentum_of_backward_euler", "backward_euler", "midpoint"},
        Wrong{"integrators/oscillator", "bdf2", "midpoint"},
        Wrong{"integrators/euler_energies", "symplectic_euler", "rk4"},
        Wrong{"integrators/free_fall", "backward_euler", "midpoint"}, Wrong{"orders/time", "bdf2", "backward_euler"},
        Wrong{"orders/time_damped", "rk4", "trapezoid"}, Wrong{"orders/time_floor", "rk4", "midpoint"},
        Wrong{"orders/time_floor", "bdf2", "backward_euler", {"without"}}, Wrong{"orders/space", "stvk", "arap"},
        Wrong{"statics/cook", "neo_hookean_log", "linear"},
        Wrong{"statics/cook_published", "neo_hookean_isochoric", "linear", {"limit"}},
        Wrong{"statics/cook_published", "neo_hookean_isochoric", "stvk", {"order"}},
        Wrong{"statics/cook_incompressible", "neo_hookean_isochoric", "arap"},
        Wrong{"statics/beam_incompressible", "neo_hookean", "arap"},
        Wrong{"statics/twisted_cylinder", "neo_hookean_log", "mooney_rivlin", {"torque", "force", "radius"}},
        Wrong{"viscoelasticity/relaxation", "stiffness", "1.1", {"stress", "stored", "dissipated"}},
        Wrong{"viscoelasticity/oscillation", "stiffness", "1.001", {"discrete"}},
        Wrong{"viscoelasticity/pull", "stiffness", "1.001"}, Wrong{"statics/torsion", "stiffness", "1.1"},
        Wrong{"vibration/torsion", "stiffness", "1.1"}, Wrong{"vibration/bar", "stiffness", "1.1"},
        Wrong{"vibration/beam", "stiffness", "1.1", {"first: limit", "slender"}},
        Wrong{"vibration/twisting_column", "midpoint", "backward_euler", {"dL", "E / E0", "ratio"}},
        Wrong{"vibration/twisting_column", "neo_hookean_isochoric", "arap", {"det F"}},
        Wrong{"vibration/twisting_column", "stiffness", "100", {"largest turn"}},
        Wrong{"vibration/twisting_column", "five", "kuhn", {"quarter turn", "mirror"}},
        Wrong{"statics/elastica", "neo_hookean_log", "linear"},
        Wrong{"statics/heavy_strip", "stiffness", "1.1", {"x / L", "z / L"}},
        Wrong{"statics/hollow_sphere", "neo_hookean_log", "corotated"}, Wrong{"statics/half_space", "linear", "arap"},
        Wrong{"contact/hertz", "stiffness", "1.1", {"force"}}, Wrong{"contact/bar", "stiffness", "1.1", {"time"}},
        Wrong{"contact/patch", "stiffness", "1.1", {"mean"}}, Wrong{"contact/press", "stiffness", "1.1", {"stress"}},
        Wrong{"contact/slide_to_rest", "backward_euler", "quasi_static"},
        Wrong{"contact/sliding_order", "bdf2", "backward_euler"}, Wrong{"contact/spin", "bdf2", "backward_euler"},
        Wrong{"contact/angular_momentum", "bdf2", "backward_euler"},
        Wrong{"vibration/tapered_membrane", "neo_hookean_log", "arap"}, Wrong{"tissue/artery", "stiffness", "1.1"},
        Wrong{"tissue/heart_inflation", "stiffness", "1.1", {"inner", "outer"}},
        Wrong{"vibration/pendulum", "midpoint", "backward_euler"}),
    wrong_name);

// [Pelteret2016]; Abaqus gives 14.727 with 36864 of its elements.
TEST(MembraneReference, GivesThePublishedDisplacement) {
  const double mu = 422.5, bulk = 2 * mu * 1.3 / (3 * 0.4);
  const InvariantLaw law = split_law(mu, [bulk](double J) {
    return std::array{bulk / 2 * (J - 1 / J), bulk / 2 * (1 + 1 / (J * J))};
  });
  EXPECT_NEAR(membrane_reference(law, 1000.0 / 16, 16), 14.74, 0.005);
}

TEST(MembraneReference, GivesTheDisplacementOfTheLogarithmicLaw) {
  const double mu = 250 / 2.6, lambda = 250 * 0.3 / (1.3 * 0.4);
  EXPECT_NEAR(membrane_reference(logarithmic_law(mu, lambda), 100.0 / 16, 16), 7.638, 0.001);
}

// Nearly incompressible cylinder: Rivlin's torque pi/2 mu t b^4 and force -pi/4 mu t^2 b^4, mu = E / 2.998.
TEST(TwistedCylinder, TendsToRivlinsSolution) {
  const double mu = 1 / 2.998, pi = std::numbers::pi;
  const Torsion torsion = twisted_cylinder("neo_hookean_log", 0.499, 1);
  EXPECT_NEAR(torsion.torque, pi / 2 * mu, 5e-3);
  EXPECT_NEAR(torsion.force, -pi / 4 * mu, 5e-3);
  EXPECT_NEAR(torsion.radius(1), 1, 5e-3);
}

// A deformation far beyond the solvable range.
TEST(RadialReference, ThrowsWhereItDoesNotConverge) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(inflated_sphere("neo_hookean_log", 0.3, 1, 2, nan), std::runtime_error);
  EXPECT_THROW(inflated_sphere("neo_hookean_log", 0.3, 1, 2, 1e-3), std::runtime_error);
  EXPECT_THROW(twisted_cylinder("neo_hookean_log", 0.3, 1e3), std::runtime_error);
}

Check made_of(std::function<void(const Subject&, Findings&)> run) {
  return {"family", "name", "title", "problem", "reference", std::move(run)};
}

TEST(RunCheck, FailsOnExceptionOrWithoutRows) {
  const Findings thrown = run_check(made_of([](const Subject&, Findings& found) {
                                      found.expect("before", {1, 1, 0}, "exact");
                                      throw std::runtime_error("the solver failed");
                                    }),
                                    {});
  EXPECT_FALSE(thrown.passes());
  ASSERT_EQ(thrown.rows.size(), 2u) << "earlier rows are kept";
  EXPECT_TRUE(thrown.rows[0].passes());
  EXPECT_EQ(thrown.rows[1].reason, "the solver failed");
  EXPECT_FALSE(run_check(made_of([](const Subject&, Findings&) {}), {}).passes());
}

TEST(Row, PassesOnlyWithFiniteNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto passes = [](double measured, double reference, double tolerance) {
    return Row{"", measured, reference, tolerance, "", ""}.passes();
  };
  EXPECT_TRUE(passes(1.1, 1, 0.2));
  EXPECT_TRUE(passes(1, 1, 0));
  EXPECT_FALSE(passes(1.1, 1, 0.05));
  EXPECT_FALSE(passes(nan, 1, 0.2));
  EXPECT_FALSE(passes(1, nan, 0.2));
  EXPECT_FALSE(passes(1, 1, nan));
  EXPECT_FALSE(passes(inf, 1, inf));
  EXPECT_FALSE(passes(inf, inf, 1));
}

}  // namespace
}  // namespace aspic::verify
