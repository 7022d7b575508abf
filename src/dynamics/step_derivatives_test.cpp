#include "dynamics/step_derivatives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dynamics/models_test.h"

namespace aspic {
namespace {

using namespace testing_models;

Simulation simulation_of(Model model) {
  State state = at_rest(model.mesh);
  for (size_t i = 0; i < state.qdot.size(); ++i) state.qdot[i] = 0.1 * std::sin(static_cast<double>(i));
  return Simulation(std::move(model), std::move(state), {});
}

TEST(StepDerivatives, EveryTermOfDampedDrivenBeamPasses) {
  const Simulation simulation = simulation_of(damped_beam_with_moving_pins_and_targets());
  std::set<std::string> terms, states;
  for (const TermDerivatives& t : check_step_derivatives(simulation)) {
    EXPECT_TRUE(t.report.gradient.passed) << t.term << ", " << t.state << ": " << t.report.gradient.smallest_error;
    EXPECT_TRUE(t.report.hessian.passed) << t.term << ", " << t.state << ": " << t.report.hessian.smallest_error;
    if (t.term == "E" || t.term == "elasticity") {
      EXPECT_NEAR(t.report.gradient.order, 2, 0.15) << t.term << ", " << t.state;
      EXPECT_NEAR(t.report.hessian.order, 2, 0.15) << t.term << ", " << t.state;
    }
    terms.insert(t.term);
    states.insert(t.state);
  }
  EXPECT_EQ(states, (std::set<std::string>{"start", "rest", "deformed"}));
  for (const char* term : {"elasticity", "gravity", "pull", "inertia", "E"}) EXPECT_TRUE(terms.contains(term)) << term;
  EXPECT_EQ(terms.size(), 7u);  // and two of damping
}

// k/2 (x of one vertex - 0.5)^2, whose gradient or Hessian has a relative error of 1e-3.
class Wrong : public Energy {
 public:
  Wrong(int entry, double gradient_factor, double hessian_factor)
      : entry_(entry), gradient_factor_(gradient_factor), hessian_factor_(hessian_factor) {}
  std::string_view name() const override { return "wrong"; }
  double value(Positions x, const Context&) const override { return 50 * (x[entry_] - 0.5) * (x[entry_] - 0.5); }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    g[entry_] += scale * gradient_factor_ * 100 * (x[entry_] - 0.5);
  }
  void bind(const BlockPattern& pattern) override { slot_ = pattern.diagonal(entry_ / 3); }
  int add_hessian(Positions, const Context&, double scale, const Projection&, BlockSparse& H) const override {
    H.block[slot_](entry_ % 3, entry_ % 3) += scale * hessian_factor_ * 100;
    return 0;
  }

 private:
  int entry_;
  double gradient_factor_, hessian_factor_;
  int64_t slot_ = 0;
};

TEST(StepDerivatives, NamesVertexOfWrongTerm) {
  constexpr int kEntry = 3 * 17 + 1;
  for (const bool in_gradient : {true, false}) {
    Model model = beam(1);
    model.loads.push_back(std::make_unique<Wrong>(kEntry, in_gradient ? 1.001 : 1, in_gradient ? 1.001 : 0.999));
    const Simulation simulation = simulation_of(std::move(model));
    for (const TermDerivatives& t : check_step_derivatives(simulation)) {
      if (t.term == "E") continue;  // E hides an error in so soft a spring
      EXPECT_EQ(t.report.passed(), t.term != "wrong") << t.term;
      if (t.term != "wrong") continue;
      const DerivativeCheck& check = in_gradient ? t.report.gradient : t.report.hessian;
      EXPECT_FALSE(check.passed);
      EXPECT_EQ(check.row, kEntry);
      EXPECT_EQ(check.column, in_gradient ? -1 : kEntry);
      EXPECT_TRUE((in_gradient ? t.report.hessian : t.report.gradient).passed);
    }
  }
}

TEST(StepDerivatives, NamesEntries) {
  EXPECT_EQ(entry_name(37), "vertex 12, y");
  const TetMesh mesh = make_box({}, {{1, 1, 1}}, {1, 1, 1});
  const int tet = tet_with(mesh, 0, 7);
  ASSERT_GE(tet, 0);
  for (const int v : {0, 7}) EXPECT_EQ(std::count(mesh.tets[tet].begin(), mesh.tets[tet].end(), v), 1);
  EXPECT_EQ(tet_with(mesh, 0, 99), -1);
}

}  // namespace
}  // namespace aspic
