#include "base/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <set>
#include <thread>
#include <vector>

#include "allocation_counter.h"

namespace aspic {
namespace {

class Parallel : public testing::TestWithParam<int> {  // parameter: number of threads
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(before_); }

 private:
  int before_ = thread_count();
};

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 3, 8), testing::PrintToStringParamName());

TEST_P(Parallel, ForVisitsEachIndexOnce) {
  for (const int count : {0, 1, 2, 7, 1000}) {
    std::vector<std::atomic<int>> visits(count);
    parallel_for(count, [&](int i) { ++visits[i]; });
    for (const auto& n : visits) EXPECT_EQ(n, 1);
  }
}

TEST_P(Parallel, LoopsRunInForkedProcess) {
  std::atomic<int> visits = 0;
  const auto visit_all = [&] { parallel_for(1000, [&](int) { ++visits; }); };
  visit_all();
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);  // ends a process that hangs
    visit_all();
    std::exit(visits == 2000 ? 0 : 1);  // joins the threads
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  visit_all();
  EXPECT_EQ(visits, 2000);
}

TEST_P(Parallel, ChunksCoverRangeWithoutOverlap) {
  for (const int count : {0, 1, kChunkSize - 1, kChunkSize, kChunkSize + 1, 5 * kChunkSize + 3}) {
    std::vector<std::atomic<int>> visits(count);
    parallel_chunks(count, [&](int first, int last) {
      EXPECT_EQ(first % kChunkSize, 0);
      EXPECT_LE(last - first, kChunkSize);
      for (int i = first; i < last; ++i) ++visits[i];
    });
    for (const auto& n : visits) ASSERT_EQ(n, 1);
  }
}

double term(int i) { return std::sin(i) * std::exp(i % 50); }  // rounding depends on the order

double sum_of_terms(int count) {
  return parallel_sum(count, [](int first, int last) {
    double sum = 0;
    for (int i = first; i < last; ++i) sum += term(i);
    return sum;
  });
}

TEST_P(Parallel, SumIsBitReproducible) {
  const int count = 20 * kChunkSize + 17;
  const double sum = sum_of_terms(count);
  set_thread_count(1);
  EXPECT_EQ(sum, sum_of_terms(count));
  EXPECT_EQ(sum_of_terms(0), 0);
}

TEST_P(Parallel, InnerLoopRunsOnThreadOfOuterLoop) {
  std::atomic<int> visits = 0, strangers = 0;
  parallel_for(20, [&](int) {
    const auto outer = std::this_thread::get_id();
    parallel_for(30, [&](int) {
      ++visits;
      strangers += std::this_thread::get_id() != outer;
    });
  });
  EXPECT_EQ(visits, 20 * 30);
  EXPECT_EQ(strangers, 0);
}

TEST_P(Parallel, NestedSumDoesNotChangeOuterSum) {
  const int outer = 4 * kChunkSize;
  const double inner = sum_of_terms(3 * kChunkSize);
  const double sum = parallel_sum(outer, [&](int first, int) { return first + sum_of_terms(3 * kChunkSize); });
  double expected = 0;
  for (int first = 0; first < outer; first += kChunkSize) expected += first + inner;
  EXPECT_EQ(sum, expected);
}

TEST_P(Parallel, LoopsOfTwoThreadsDoNotMix) {
  const double expected = sum_of_terms(4 * kChunkSize);
  std::atomic<int> wrong = 0;
  const auto work = [&] {
    for (int repeat = 0; repeat < 200; ++repeat) wrong += sum_of_terms(4 * kChunkSize) != expected;
  };
  std::thread other(work);
  work();
  other.join();
  EXPECT_EQ(wrong, 0);
}

TEST_P(Parallel, LoopsDoNotAllocate) {
  double a = 1, b = 2, c = 3, d = 4;  // more than std::function stores without allocating
  std::vector<double> x(3 * kChunkSize, 0.0);
  const auto loops = [&] {
    parallel_for(100, [&](int i) { x[i] = a + b + c + d; });
    parallel_chunks(3 * kChunkSize, [&](int first, int last) { std::fill(&x[first], &x[first] + (last - first), a); });
    return parallel_sum(3 * kChunkSize, [&](int first, int last) { return a * x[first] + b * x[last - 1] + c + d; });
  };
  loops();
  const test::AllocationCounter counter;
  const double sum = loops();
  EXPECT_EQ(counter.count(), 0);
  EXPECT_EQ(sum, 3 * (a * a + b * a + c + d));
}

TEST_P(Parallel, ShortLoopsWorkWithAwakeAndSleepingThreads) {
  for (int loop = 0; loop < 3000; ++loop) {
    const int count = 2 + loop % 7;
    std::array<int, 8> value{};
    parallel_for(count, [&](int i) { value[i] = loop + i; });
    for (int i = 0; i < count; ++i) ASSERT_EQ(value[i], loop + i);
    if (loop % 100 == 0) std::this_thread::sleep_for(std::chrono::microseconds(loop / 10));
  }
}

TEST(ParallelThreads, MayChangeNumberBetweenLoops) {
  const int before = thread_count();
  for (const int threads : {2, 8, 1, 3, 1, 8, 2}) {
    set_thread_count(threads);
    EXPECT_EQ(thread_count(), threads);
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::vector<std::atomic<int>> visits(100);
      std::vector<std::thread::id> by(100);
      parallel_for(100, [&](int i) {
        ++visits[i];
        by[i] = std::this_thread::get_id();
      });
      for (const auto& n : visits) ASSERT_EQ(n, 1);
      EXPECT_LE(std::set<std::thread::id>(by.begin(), by.end()).size(), static_cast<size_t>(threads));
    }
  }
  set_thread_count(before);
}

}  // namespace
}  // namespace aspic
