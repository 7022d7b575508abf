#include "math/pack.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace aspic {
namespace {

double ulp(double x) { return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x); }

// Positive normal numbers below max/8, above which the standard library is used (its cbrt errs by up to 4 ulp). Half of
// them are near 1, half cover the whole range of exponents.
std::vector<Pack> positive_numbers() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> near(-0.5, 0.5), anywhere(-1022, 1020);
  std::vector<Pack> all(20000);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (int lane = 0; lane < kPackWidth; ++lane) all[i].set(lane, std::exp2(i % 2 ? near(random) : anywhere(random)));
  return all;
}

template <class Fn, class Reference>
void expect_within_ulps(double ulps, Fn fn, Reference reference) {
  for (const Pack& x : positive_numbers()) {
    const Pack y = fn(x);
    for (int lane = 0; lane < kPackWidth; ++lane) {
      const long double exact = reference(static_cast<long double>(x[lane]));
      ASSERT_LE(std::abs(static_cast<double>(y[lane] - exact)), ulps * ulp(static_cast<double>(exact))) << x[lane];
    }
  }
}

TEST(Pack, LogIsWithinOneUlp) {
  expect_within_ulps(
      1, [](Pack x) { return log(x); }, [](long double x) { return std::log(x); });
}
TEST(Pack, CbrtIsWithinTwoUlps) {
  expect_within_ulps(
      2, [](Pack x) { return cbrt(x); }, [](long double x) { return std::cbrt(x); });
}

TEST(Pack, LogAndCbrtMatchLibraryForSpecialValues) {
  const double inf = std::numeric_limits<double>::infinity(), tiny = std::numeric_limits<double>::denorm_min();
  for (const double special : {0.0, -0.0, tiny, -1.0, inf, -inf, std::nan("")}) {
    Pack x = 2.0;
    x.set(1, special);
    const Pack y = log(x), z = cbrt(x);
    EXPECT_NEAR(y[0], std::log(2.0), 2 * ulp(0.69));
    EXPECT_NEAR(z[0], std::cbrt(2.0), 2 * ulp(1.26));
    if (std::isnan(std::log(special))) {
      EXPECT_TRUE(std::isnan(y[1]));
    } else {
      EXPECT_EQ(y[1], std::log(special));
    }
    if (std::isnan(special)) {
      EXPECT_TRUE(std::isnan(z[1]));
    } else {
      EXPECT_EQ(z[1], std::cbrt(special));
    }
  }
}

TEST(Pack, LogOfOneIsExactlyZero) {
  EXPECT_EQ(log(Pack(1.0))[0], 0);
  EXPECT_EQ(cbrt(Pack(1.0))[0], 1);
  EXPECT_EQ(cbrt(Pack(27.0))[0], 3);
}

TEST(Pack, SelectsLaneByLane) {
  Pack condition = 1.0;
  condition.set(1, std::nan(""));
  const Pack chosen = where_positive(condition, 3.0, 4.0);
  EXPECT_EQ(chosen[0], 3);
  EXPECT_EQ(chosen[1], 4);
  EXPECT_EQ(lanes_not_positive(condition), 2u);
  EXPECT_TRUE(any_positive(condition));
  EXPECT_FALSE(any_positive(Pack(0.0)));
  EXPECT_EQ(lanes_from_bits<Pack>(2)[0], 0);
  EXPECT_EQ(lanes_from_bits<Pack>(2)[1], 1);
}

// Rows of a table, some shared by several lanes; the last row ends at the end of the allocation.
struct Rows {
  static constexpr int kCount = 5, kLength = 9;
  std::vector<double> number;
  Rows() {
    for (int i = 0; i < kCount * kLength; ++i) number.push_back(1 + 0.25 * i);
  }
  static int row(int lane) { return lane % 3 == 2 ? kCount - 1 : lane % kCount; }
  double* operator()(int lane, int length) { return number.data() + row(lane) * kLength + (kLength - length); }
};

TEST(Pack, GathersOneRowPerLane) {
  Rows rows;
  const std::array<Pack, 3> x = gather3([&](int lane) { return rows(lane, 3); });
  for (int lane = 0; lane < kPackWidth; ++lane)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(x[c][lane], rows(lane, 3)[c]) << lane << ", " << c;
}

template <std::size_t N>
std::array<Pack, N> numbered_columns() {
  std::array<Pack, N> a;
  for (std::size_t c = 0; c < N; ++c)
    for (int lane = 0; lane < kPackWidth; ++lane) a[c].set(lane, 100.0 * (lane + 1) + static_cast<double>(c));
  return a;
}

template <std::size_t N, class Scatter>
void expect_rows_to_be_added(Scatter scatter) {
  const std::array<Pack, N> a = numbered_columns<N>();
  Rows rows, expected;
  scatter(a, [&](int lane) { return rows(lane, N); });
  for (int lane = 0; lane < kPackWidth; ++lane)
    for (std::size_t c = 0; c < N; ++c) expected(lane, N)[c] += a[c][lane];
  EXPECT_EQ(rows.number, expected.number);
}

TEST(Pack, AddsRowPerLaneWithSharedRows) {
  expect_rows_to_be_added<3>([](const auto& a, const auto& row) { scatter3(a, row); });
  expect_rows_to_be_added<9>([](const auto& a, const auto& row) { scatter9(a, row); });
}

}  // namespace
}  // namespace aspic
