#include "aspic/formulas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "aspic/lecture/course.h"
#include "dynamics/integrator.h"
#include "dynamics/simulation.h"
#include "material/registry.h"
#include "verification/check.h"

namespace aspic::cli {
namespace {

void expect_rendered(const std::string& name, const std::vector<std::string>& formulas) {
  for (const std::string& tex : formulas)
    EXPECT_THAT(formulas_of(tex), testing::ElementsAre(testing::StartsWith("<math"))) << name << ": " << tex;
}

TEST(Formulas, EveryMaterialHasItsEnergyDensity) {
  for (const MaterialInfo& info : materials()) {
    ASSERT_FALSE(info.tex.empty()) << info.name;
    EXPECT_THAT(info.tex.front(), testing::HasSubstr(R"(\psi =)")) << info.name;
    expect_rendered(info.name, info.tex);
  }
}

TEST(Formulas, EveryIntegratorHasItsUpdateRule) {
  for (const std::string& name : integrator_names())
    expect_rendered(name, {std::string(make_integrator(name)->facts().tex)});
}

TEST(Formulas, EveryDemonstrationHasItsFormulas) {
  for (const lecture::Demonstration& d : lecture::demonstrations()) {
    EXPECT_FALSE(formulas_of(d.key).empty()) << d.key;
    for (const std::string& formula : formulas_of(d.key)) EXPECT_THAT(formula, testing::StartsWith("<math")) << d.key;
  }
}

TEST(Formulas, EveryClosedFormReferenceIsRendered) {
  // Tables, other programs and symmetries are references without a formula.
  const std::set<std::string> without = {"materials/uniaxial_table",
                                         "derivatives/automatic",
                                         "derivatives/edges",
                                         "invariants/numbering",
                                         "invariants/units",
                                         "patch/symmetry_planes",
                                         "statics/cook",
                                         "statics/cook_published",
                                         "contact/constants",
                                         "vibration/tapered_membrane",
                                         "contact/frames",
                                         "contact/units",
                                         "statics/cook_incompressible",
                                         "statics/scordelis_lo",
                                         "statics/pinched_hemisphere",
                                         "statics/mesh_error",
                                         "statics/mesh_error_invariance",
                                         "statics/beam_incompressible",
                                         "sheets/strip",
                                         "tissue/heart_beam",
                                         "tissue/heart_inflation",
                                         "tissue/heart_contraction",
                                         "tissue/dispersed_fibres"};
  for (const verify::Check& check : verify::checks()) {
    EXPECT_EQ(check.formulas.empty(), without.contains(check.key())) << check.key();
    expect_rendered(check.key(), check.formulas);
  }
}

}  // namespace
}  // namespace aspic::cli
