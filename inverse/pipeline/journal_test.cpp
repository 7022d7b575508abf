#include "pipeline/journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "io/atomic_file.h"
#include "io/folder_test.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

// r = [x - 1, 10 (x^2 - p_1)] with x^3 + x = p_0 solved by Newton's method from the previous x to a loose tolerance:
// the last digits of r depend on the initial guess, like those of an equilibrium.
class Looser : public LeastSquares {
 public:
  int parameter_count() const override { return 2; }
  int residual_count() const override { return 2; }
  bool evaluate(std::span<const double> p, std::span<double> r) override {
    if (++calls > limit) throw std::runtime_error("killed");
    if (!(std::abs(p[0]) < 1e3)) return false;
    while (std::abs(x * x * x + x - p[0]) > 1e-3) x -= (x * x * x + x - p[0]) / (3 * x * x + 1);
    r[0] = x - 1;
    r[1] = 10 * (x * x - p[1]);
    return true;
  }
  bool linearize() override {
    if (++calls > limit) throw std::runtime_error("killed");
    slope = 1 / (3 * x * x + 1);
    return true;
  }
  void multiply(std::span<const double> dp, std::span<double> dr) override {
    if (++calls > limit) throw std::runtime_error("killed");
    dr[0] = slope * dp[0];
    dr[1] = 20 * x * slope * dp[0] - 10 * dp[1];
  }
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override {
    if (++calls > limit) throw std::runtime_error("killed");
    pbar[0] = slope * (w[0] + 20 * x * w[1]);
    pbar[1] = -10 * w[1];
  }
  ModelState state() {
    return {[this] { return std::vector<double>{x}; }, [this](std::span<const double> saved) { x = saved[0]; }};
  }

  double x = 0, slope = 0;
  int calls = 0, limit = 1 << 20;
};

// Gradient descent with halved steps, for which every digit of an answer affects the result.
std::vector<double> descended(LeastSquares& model, int iterations) {
  std::vector<double> p = {30, 3}, r(2), g(2), Jg(2), trial(2);
  const auto cost = [&] { return r[0] * r[0] + r[1] * r[1]; };
  EXPECT_TRUE(model.evaluate(p, r));
  for (int i = 0; i < iterations; ++i) {
    const double before = cost();
    EXPECT_TRUE(model.linearize());
    model.multiply_transposed(r, g);
    model.multiply(g, Jg);
    double step = (g[0] * g[0] + g[1] * g[1]) / (Jg[0] * Jg[0] + Jg[1] * Jg[1]);
    if (i == 1) step *= 1e5;  // leaves the domain
    for (int k = 0; k < 60; ++k, step *= 0.5) {
      for (int j = 0; j < 2; ++j) trial[j] = p[j] - step * g[j];
      if (model.evaluate(trial, r) && cost() < before) break;
    }
    p = trial;
  }
  return p;
}

class JournalTest : public FolderTest {
 protected:
  std::vector<double> whole() {
    Looser model;
    Journal journal(model, model.state(), path("whole"), "f", JournalStart::anew);
    std::vector<double> p = descended(journal, 12);
    calls = model.calls;
    return p;
  }
  int calls = 0;  // of the whole fit
};

TEST_F(JournalTest, KilledAtAnyCallItResumesBitReproducibly) {
  const std::vector<double> expected = whole();
  ASSERT_GT(calls, 50);
  for (int limit = 1; limit < calls; limit += 3) {
    {
      Looser model;
      model.limit = limit;
      Journal journal(model, model.state(), path("a"), "f", JournalStart::anew);
      EXPECT_THROW(descended(journal, 12), std::runtime_error);
    }
    Looser model;
    Journal journal(model, model.state(), path("a"), "f", JournalStart::resume);
    EXPECT_EQ(descended(journal, 12), expected) << "killed at call " << limit;
    EXPECT_LE(model.calls, calls - limit + 30) << "stored evaluations are not repeated";
  }
}

TEST_F(JournalTest, AFinishedFitIsRepeatedWithoutTheModel) {
  const std::vector<double> expected = whole();
  Looser model;
  Journal journal(model, model.state(), path("whole"), "f", JournalStart::resume);
  EXPECT_TRUE(journal.is_replaying());
  EXPECT_EQ(descended(journal, 12), expected);
  EXPECT_LE(model.calls, 15);
  EXPECT_FALSE(journal.is_replaying());
}

TEST_F(JournalTest, WhatFollowsAnInterruptionIsNotWritten) {
  const std::vector<double> expected = whole();
  {
    Looser model;
    Journal journal(model, model.state(), path("a"), "f", JournalStart::anew);
    descended(journal, 5);
    journal.stop_writing();
    std::vector<double> r(2);
    journal.evaluate(std::vector<double>{1, 1}, r);
  }
  Looser model;
  Journal journal(model, model.state(), path("a"), "f", JournalStart::resume);
  EXPECT_EQ(descended(journal, 12), expected);
}

TEST_F(JournalTest, OtherDataAndOtherProgramsAreRefused) {
  whole();
  Looser model;
  const auto resumed = [&](const std::string& fingerprint) {
    return Journal(model, model.state(), path("whole"), fingerprint, JournalStart::resume);
  };
  EXPECT_THAT(message_of([&] { resumed("g"); }), HasSubstr("belongs to another fit"));
  EXPECT_THAT(message_of([&] {
                Journal journal = resumed("f");
                std::vector<double> r(2);
                journal.evaluate(std::vector<double>{1, 2}, r);
              }),
              HasSubstr("differs from the one that wrote it; restart with --force"));
  write_file(path("whole.journal"), "short");
  EXPECT_THAT(message_of([&] { resumed("f"); }), HasSubstr("has 5 bytes where"));
}

TEST_F(JournalTest, WithoutFilesResumingBeginsAnew) {
  const std::vector<double> expected = whole();
  Looser model;
  Journal journal(model, model.state(), path("none"), "f", JournalStart::resume);
  EXPECT_FALSE(journal.is_replaying());
  EXPECT_EQ(descended(journal, 12), expected);
  Journal::remove(path("none"));
  EXPECT_FALSE(std::filesystem::exists(path("none.journal")));
  EXPECT_FALSE(std::filesystem::exists(path("none.state")));
}

}  // namespace
}  // namespace aspic
