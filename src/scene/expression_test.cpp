#include "scene/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <locale>
#include <numbers>
#include <thread>

#include "base/error.h"
#include "scene/value.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

double value(const std::string& text, Vec3d X = {{0.25, 0.5, 2}}) { return Expression(text).at(X); }

std::string formula_refusal(const std::string& text, ExpressionVariables variables = ExpressionVariables::position) {
  try {
    Expression(text, variables).at({{0, 0, 0}});
  } catch (const InvalidInput& e) {
    return e.what();
  }
  return "";
}

TEST(Expression, FollowsArithmeticPrecedence) {
  EXPECT_EQ(value("1 + 2 * 3 ^ 2"), 19);
  EXPECT_EQ(value("-2 ^ 2"), -4);
  EXPECT_EQ(value("(1 + 2) * 3 / 2"), 4.5);
  EXPECT_EQ(value("1e3 + 2.5e-1"), 1000.25);
}

TEST(Expression, AcceptsPositionInEitherCase) {
  EXPECT_EQ(value("X + 10 * Y + 100 * Z"), 205.25);
  EXPECT_EQ(value("x + 10 * y + 100 * z"), 205.25);
}

TEST(Expression, AcceptsTimeOnlyIfThereIsOne) {
  const Expression moving("X + t", ExpressionVariables::position_and_time);
  EXPECT_EQ(moving.at({{1, 0, 0}}, 0.5), 1.5);
  EXPECT_THAT(formula_refusal("X + t"), HasSubstr("'t' is not allowed"));
}

TEST(Expression, HoldsWhereAPredicateIsTrue) {
  const Expression where("y > 0.9 && x < 0");
  EXPECT_TRUE(where.holds_at({{-1, 1, 0}}));
  EXPECT_FALSE(where.holds_at({{-1, 0.9, 0}}));
  EXPECT_FALSE(where.holds_at({{0, 1, 0}}));
  EXPECT_TRUE(Expression("!(x > 0) || z == 3").holds_at({{-1, 0, 0}}));
  EXPECT_TRUE(Expression("x != 0").holds_at({{-1, 0, 0}}));
  EXPECT_TRUE(Expression("all").holds_at({{0, 0, 0}}));
}

TEST(Expression, ChoosesByCondition) {
  EXPECT_EQ(value("X < 0.5 ? 1e5 : 3e5"), 1e5);
  EXPECT_EQ(value("X > 0.5 ? 1e5 : (Y > 0.4 ? 2e5 : 3e5)"), 2e5);
}

TEST(Expression, CallsItsFunctions) {
  EXPECT_EQ(value("sin(X)"), std::sin(0.25));
  EXPECT_EQ(value("log(Z)"), std::log(2.0));
  EXPECT_EQ(value("max(X, Y, Z) - min(X, Y, Z)"), 1.75);
  EXPECT_EQ(value("atan2(1, 1) * 4"), std::numbers::pi);
  EXPECT_EQ(value("abs(-3) + sqrt(4) + exp(0) + sign(-2)"), 5);
  EXPECT_EQ(value("2 * pi"), 2 * std::numbers::pi);
}

TEST(Expression, RejectsNonFiniteValues) {
  EXPECT_THAT(formula_refusal("1 / X"), ::testing::AllOf(HasSubstr("1 / X"), HasSubstr("inf"), HasSubstr("(0, 0, 0)")));
  EXPECT_THAT(formula_refusal("sqrt(X - 1)"), HasSubstr("nan"));
  EXPECT_THAT(formula_refusal("max()"), ::testing::Not(""));
}

TEST(Expression, NamesColumnAndNearestName) {
  EXPECT_THAT(formula_refusal("1 + sqt(X)"),
              ::testing::AllOf(HasSubstr("column 5"), HasSubstr("did you mean 'sqrt'?")));
  EXPECT_THAT(formula_refusal("X +"), HasSubstr("ends too early"));
  EXPECT_THAT(formula_refusal("(X + 1"), HasSubstr("parenthesis"));
  EXPECT_THAT(formula_refusal("X + * 2"), HasSubstr("column 5"));
  EXPECT_THAT(formula_refusal("  "), HasSubstr("empty"));
}

TEST(Expression, HasNoSideEffectsAndNoStrings) {
  EXPECT_THAT(formula_refusal("X = 3"), ::testing::AllOf(HasSubstr("column 3"), HasSubstr("'=='")));
  EXPECT_THAT(formula_refusal("X == 3, Y"), HasSubstr("one value"));
  EXPECT_THAT(formula_refusal("1, 2"), HasSubstr("one value"));
  EXPECT_THAT(formula_refusal("\"a\""), HasSubstr("unexpected character"));
  EXPECT_THAT(formula_refusal("X; Y"), HasSubstr("unexpected character ';'"));
  EXPECT_THAT(formula_refusal("X += 2"), ::testing::Not(""));
}

TEST(Expression, IsBoundedInLengthAndDepth) {
  std::string sum = "1";
  while (sum.size() + 2 <= kMaxExpressionLength) sum += "+1";
  EXPECT_EQ(value(sum), 500);
  EXPECT_THAT(formula_refusal(sum + "+1"), HasSubstr("at most 1000"));
  const auto nested = [](int n) { return std::string(n, '(') + "1" + std::string(n, ')'); };
  EXPECT_EQ(value(nested(kMaxExpressionDepth)), 1);
  EXPECT_THAT(formula_refusal(nested(kMaxExpressionDepth + 1)), HasSubstr("open parentheses"));
}

TEST(Expression, DoesNotDependOnTheLocale) {
  struct DecimalComma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const double sum = value("1.5 + 0.25 + 1000");
  const std::string refused = formula_refusal("1/X");
  std::locale::global(before);
  EXPECT_EQ(sum, 1001.75);
  EXPECT_THAT(refused, HasSubstr("(0, 0, 0)"));
}

TEST(Expression, IsSafeToShareBetweenThreads) {
  const Expression square("X * X");
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      for (int i = 0; i < 2000; ++i) wrong[k] += square.at({{double(i), 0, 0}}) != double(i) * i;
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace aspic
