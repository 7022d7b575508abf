// Coulomb friction as a dissipation potential of a step [Li 2020, section 5]: D = sum of mu lambda f(|u|) over the
// stencils of a barrier, where u is the tangential relative displacement since the start of the step and lambda is the
// normal force. f(y) = y^2 / e - y^3 / (3 e^2) for y < e = speed * h, and y - e / 3 beyond. Bodies at rest creep at
// less than this speed. Normal forces and tangents are lagged, see LaggedEnergy. Updates
// of normal forces that alternate are relaxed, those that repeat extrapolated [Irons 1969].
#pragma once
#include "contact/barrier.h"

namespace aspic {

class Friction : public Energy, public LaggedEnergy, public PredictingEnergy, public StoppingEnergy {
 public:
  // `speed`: maximum creep speed of sticking surfaces [m/s]. `barrier` must outlive this.
  Friction(const Barrier& barrier, double speed) : barrier_(barrier), speed_(speed) {}

  std::string_view name() const override { return "friction"; }
  std::unique_ptr<Context> make_context() const override;
  void begin_step(const StepContext& step, Context& context) const override;
  void update_lagged(Positions x, bool keeps_directions, Context& context) const override;
  // Predicts normal forces for the next update: those at the next x jump with its small gaps, their linearizations do
  // not.
  void note_newton_step(Positions x, std::span<const double> d, double alpha, Context& context) const override;
  bool relax_lagged(Context& context) const override;
  double value(Positions x, const Context& context) const override;
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override;
  // Returns the work [J] on friction of obstacles that move during the step.
  double obstacle_work(Positions x, const Context& context) const;
  // Adds the difference that the last update of normal forces and tangents made to the gradient at x. After
  // begin_step() it is zero.
  void add_change(Positions x, const Context& context, std::span<double> g) const;
  // The parts with the largest friction at a vertex of the model, before or after the last update; -1: there are none.
  std::array<int, 2> parts_at(int row, const Context& context) const;
  // Largest slip since the start of the step of contacts that stick: below e [m].
  double creep(Positions x, const Context& context) const;
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override;
  int add_stops(Positions x, const Context& context, std::span<const double> d,
                const ScaledModel& model) const override;

 private:
  template <class Visit>
  void visit_tractions(Positions x, double time, const Visit& visit) const;
  void lag(Positions x, double time, bool keeps_directions, Context& context) const;

  const Barrier& barrier_;
  double speed_;
};

}  // namespace aspic
