// The counts in README.md are those of the program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "dynamics/simulation.h"
#include "io/atomic_file.h"
#include "material/registry.h"
#include "optimize/solver.h"

namespace aspic {
namespace {

// Compares the number before `words` in README.md with `count`, or writes it.
void expect_count(std::ptrdiff_t count, const std::string& words) {
  const std::filesystem::path page = ASPIC_SOURCE_DIR "/README.md";
  const std::string expected = std::to_string(count) + " " + words;
  if (std::getenv("ASPIC_UPDATE_DOCS"))
    write_file(page, std::regex_replace(read_file(page), std::regex("\\d+ " + words), expected));
  EXPECT_NE(read_file(page).find(" " + expected), std::string::npos)
      << expected << ": ASPIC_UPDATE_DOCS=1 test_crossing --gtest_filter='Readme*' writes README.md anew";
}

TEST(Readme, CountsMaterials) { expect_count(std::ssize(materials()), "hyperelastic models"); }
TEST(Readme, CountsTreatmentsOfHessians) {
  expect_count(std::ssize(definiteness_names()) - 1, "treatments of indefinite Hessians");  // without auto
}
TEST(Readme, CountsIntegrators) { expect_count(std::ssize(integrator_names()), "integrators"); }

}  // namespace
}  // namespace aspic
