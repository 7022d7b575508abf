#include "math/lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>

namespace aspic {
namespace {

template <class T>
class LanesTest : public testing::Test {
 protected:
  template <std::size_t N>
  std::array<T, N> numbers() {
    std::array<T, N> a;
    for (T& value : a) value = uniform_(random_);
    return a;
  }

 private:
  std::mt19937 random_{1};
  std::uniform_real_distribution<T> uniform_{-1, 1};
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(LanesTest, Scalars);

TYPED_TEST(LanesTest, AddSubtractAndMultiplyLaneByLane) {
  constexpr int kCount = sizeof(TypeParam) == 4 ? 16 : 4;
  using L = Lanes<TypeParam, kCount>;
  const auto a = this->template numbers<kCount>(), b = this->template numbers<kCount>();
  const L x = L::load(a.data()), y = L::load(b.data());
  L sum = x, difference = x;
  sum += y, difference -= y;
  std::array<TypeParam, kCount> stored;
  (x * y).store(stored.data());
  for (int i = 0; i < kCount; ++i) {
    EXPECT_EQ((x + y)[i], a[i] + b[i]);
    EXPECT_EQ((x - y)[i], a[i] - b[i]);
    EXPECT_EQ(sum[i], a[i] + b[i]);
    EXPECT_EQ(difference[i], a[i] - b[i]);
    EXPECT_EQ(stored[i], a[i] * b[i]);
    EXPECT_EQ(L::all(a[3])[i], a[3]);
    EXPECT_EQ(L::zero()[i], 0);
  }
}

TYPED_TEST(LanesTest, LoadsAndStoresOfThreeTouchNoFourth) {
  const std::array<TypeParam, 4> from = {1, 2, 3, std::numeric_limits<TypeParam>::quiet_NaN()};
  const Quad<TypeParam> q = load3(from.data());
  EXPECT_EQ(q[3], 0);
  std::array<TypeParam, 4> to = {0, 0, 0, 7};
  store3(q, to.data());
  EXPECT_EQ(to, (std::array<TypeParam, 4>{1, 2, 3, 7}));
}

// Tolerance of a few eps: sums of three products of values below one may be rounded or fused.
TYPED_TEST(LanesTest, ProductsMatchColumnMajorBlock) {
  const TypeParam bound = 4 * std::numeric_limits<TypeParam>::epsilon();
  for (int repetition = 0; repetition < 20; ++repetition) {
    const auto A = this->template numbers<9 + kSpareLanes>();
    const auto x = this->template numbers<3>();
    const Quad<TypeParam> y = product(A.data(), x.data()), z = transposed_product(A.data(), load3(x.data()));
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(y[i], A[i] * x[0] + A[i + 3] * x[1] + A[i + 6] * x[2], bound);
      EXPECT_NEAR(z[i], A[3 * i] * x[0] + A[3 * i + 1] * x[1] + A[3 * i + 2] * x[2], bound);
    }
    EXPECT_EQ(z[3], 0);
  }
}

}  // namespace
}  // namespace aspic
