// The counts in README.md are those of the program.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "dynamics/simulation.h"
#include "material/registry.h"
#include "optimize/solver.h"

namespace aspic {
namespace {

// The number before the given words in README.md; -1: none.
int count_of(const std::string& words) {
  std::ostringstream text;
  text << std::ifstream(ASPIC_SOURCE_DIR "/README.md").rdbuf();
  const std::string all = text.str();
  std::smatch found;
  return std::regex_search(all, found, std::regex("(\\d+) " + words)) ? std::stoi(found[1]) : -1;
}

TEST(Readme, CountsMaterials) { EXPECT_EQ(count_of("hyperelastic models"), std::ssize(materials())); }
TEST(Readme, CountsTreatmentsOfHessians) {
  EXPECT_EQ(count_of("treatments of indefinite Hessians"), std::ssize(definiteness_names()) - 1);  // without auto
}
TEST(Readme, CountsIntegrators) { EXPECT_EQ(count_of("integrators"), std::ssize(integrator_names())); }

}  // namespace
}  // namespace aspic
