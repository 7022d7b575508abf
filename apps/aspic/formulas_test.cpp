#include "aspic/formulas.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "material/registry.h"

namespace aspic::cli {
namespace {

TEST(Formulas, EveryMaterialHasItsEnergyDensity) {
  for (const MaterialInfo& info : materials()) {
    const std::vector<std::string> formulas = formulas_of(info.name);
    ASSERT_FALSE(formulas.empty()) << info.name << ": add psi to web/src/formulas.json";
    EXPECT_THAT(formulas.front(), testing::AllOf(testing::StartsWith("<math"), testing::HasSubstr("<mi>ψ</mi>")));
  }
}

}  // namespace
}  // namespace aspic::cli
