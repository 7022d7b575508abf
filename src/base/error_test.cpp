#include "base/error.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

const std::vector<std::string> kKnown = {"young", "poisson", "density", "box"};

TEST(NearestName, HasFewestTypingErrors) {
  EXPECT_EQ(nearest_name("young", kKnown), "young");
  EXPECT_EQ(nearest_name("yuong", kKnown), "young");     // two letters exchanged
  EXPECT_EQ(nearest_name("poison", kKnown), "poisson");  // one letter missing
  EXPECT_EQ(nearest_name("densitty", kKnown), "density");
  EXPECT_EQ(nearest_name("bax", kKnown), "box");
}

TEST(NearestName, FindsSynonyms) {
  EXPECT_EQ(nearest_name("E", kKnown), "young");
  EXPECT_EQ(nearest_name("Youngs_modulus", kKnown), "young");
  EXPECT_EQ(nearest_name("nu", kKnown), "poisson");
  EXPECT_EQ(nearest_name("rho", kKnown), "density");
  EXPECT_EQ(nearest_name("rho", {"young"}), "");
}

TEST(NearestName, IsEmptyIfNoneIsClose) {
  EXPECT_EQ(nearest_name("gravity", kKnown), "");
  EXPECT_EQ(nearest_name("young", {}), "");
  EXPECT_EQ(nearest_name(std::string(65, 'y'), {std::string(65, 'y')}), "");  // not a typing error
}

TEST(NearestName, IsFirstAmongEquallyClose) {
  EXPECT_EQ(nearest_name("bxx", {"bax", "bix"}), "bax");
  EXPECT_EQ(nearest_name("bxx", {"bix", "bax"}), "bix");
}

TEST(NearestName, AllowsMoreErrorsInLongerWords) {
  EXPECT_EQ(nearest_name("bekwrd_euller", {"backward_euler"}), "backward_euler");  // 3 of 13
  EXPECT_EQ(nearest_name("abc", {"xyz"}), "");
}

TEST(Suggestion, NamesNearestOrListsAll) {
  EXPECT_EQ(suggestion("yung", kKnown), " (did you mean 'young'?)");
  EXPECT_EQ(suggestion("gravity", kKnown), " (known: young, poisson, density, box)");
  EXPECT_EQ(suggestion("anything", {}), "");
}

}  // namespace
}  // namespace aspic
