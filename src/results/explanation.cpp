#include "results/explanation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contact/barrier.h"
#include "dynamics/explanation_places.h"
#include "dynamics/pins.h"
#include "dynamics/rigid_motions.h"

namespace aspic {
namespace {

using namespace places;  // NOLINT(google-build-using-namespace)

std::string residual_place(const Model& model, const StepReport& report, std::span<const double> x) {
  if (report.worst_vertex < 0) return "";
  return vertex_name(model, report.worst_vertex) + " at " + point_text(x, report.worst_vertex) + " is farthest from " +
         "balance: " + text(report.worst_residual) + " N remain";
}

// Relative volume below which a tet counts as crushed.
constexpr double kPressedFlat = 1e-9;

// A residual up to this multiple of the estimated round-off counts as round-off.
constexpr double kNearRoundOff = 1000;

// Adaptive tolerances below this require substeps in which too few digits of the positions change.
constexpr double kFinest = 1e-9;

// Relative tolerances above this are useless.
constexpr double kLoosest = 1e-2;

class Explainer {
 public:
  Explainer(const Simulation& simulation, const StepReport& report)
      : simulation_(simulation),
        report_(report),
        model_(simulation.model()),
        solver_(simulation.options().solver),
        x_(simulation.state().q) {}

  Explanation explain() const {
    const bool is_unsolved = report_.status == Status::stuck || report_.status == Status::no_descent ||
                             report_.status == Status::iteration_limit;
    if (is_unsolved)
      if (const std::optional<Explanation> contact = squeezed_gap()) return *contact;
    if (is_unsolved && is_static())
      if (const std::optional<RigidMotion> motion = free_rigid_motion(model_, simulation_.snapshot().start.q))
        return not_held(*motion);
    switch (report_.status) {
      case Status::undefined:
        if (!simulation_.integrator().is_implicit) return blow_up();
        if (const Explanation pins = stretched_by_pins(); !pins.cause.empty()) return pins;
        return std::isfinite(report_.objective) && report_.iterations > 0 ? undefined_end() : undefined_start();
      case Status::stuck:
        return stuck();
      case Status::iteration_limit:
        return iteration_limit();
      case Status::no_descent:
        return no_descent();
      case Status::inaccurate:
        return inaccurate();
      case Status::inverted:
        return {"quadratic tets are inverted between their nodes, down to det F = " + text(report_.min_det_F) +
                    ", where their law is infinite",
                "body.order", "a finer mesh where they are compressed, or body.order = 1"};
      case Status::budget:
        return {"the time budget ended after " + std::to_string(report_.iterations) +
                    " iterations; the step keeps their result",
                "solver.time_budget = " + text(solver_.time_budget), "raise solver.time_budget, or solver.tolerance"};
      case Status::unstable:
        return blow_up();
      case Status::round_off:
        if (report_.lost_accuracy > 0) return lost_accuracy();
        break;
      case Status::converged:
      case Status::interrupted:
        break;
    }
    return {};
  }

 private:
  bool is_static() const { return simulation_.integrator().is_static(); }
  bool is_newton() const { return estimates_minimizer(solver_.method); }
  Explanation not_held(const RigidMotion& motion) const {
    const std::string body = model_.bodies.size() > 1 ? "body '" + model_.bodies[motion.body].name + "'" : "the body";
    const bool has_pins = !model_.pins.empty();
    return {motion.is_rotation ? "statics has no stiffness along a rigid motion that the pins leave free"
                               : "the equilibrium is not unique: nothing holds " + body,
            (has_pins ? "the pins let " + body + " " : "no pins in the scene: " + body + " can ") + to_string(motion),
            std::string(motion.is_rotation ? "pin one more vertex, away from that axis" : "pin some vertices") +
                ", or use time.integrator = \"backward_euler\""};
  }
  std::string step_text() const { return "time.step = " + text(simulation_.options().h); }
  std::string smaller_steps() const {
    const double tolerance = simulation_.options().adaptive.tolerance;
    if (tolerance > 0)  // the shortest substep, time.step / 2^20, failed as well
      return "raise time.adaptive.tolerance (" + text(tolerance) + " now): shorter substeps also failed";
    return is_static() ? "load the body in smaller steps (" + step_text() + " now)"
                       : "shorten the step (" + step_text() + " now)";
  }

  Explanation lost_accuracy() const {
    const auto digits = std::numeric_limits<double>::digits10;
    return {
        "round-off hides " + text(100 * report_.lost_accuracy) + " % of the forces or the velocities",
        "positions have " + std::to_string(digits) + " digits, and " + step_text(),
        "lengthen a tiny time.step, move a distant body to the origin, or lower an extreme stiffness (young, poisson); "
        "pin fixed parts"};
  }

  Explanation blow_up() const {
    const Explanation pins = pressed_by_pins();
    if (!pins.cause.empty()) return pins;
    const StableStep stable = simulation_.stable_step();
    const double h = simulation_.options().h;
    const std::string& name = simulation_.options().integrator;
    const bool gains_energy = simulation_.integrator().gains_energy;
    const std::string end = report_.status == Status::unstable
                                ? "has produced more than ten times the possible energy of the body"
                                : "left the range of numbers";
    if (gains_energy && h < stable.h)
      return {name + " adds energy in every step, however short, and " + end, "time.integrator = \"" + name + "\"",
              "time.integrator = \"symplectic_euler\" or \"backward_euler\""};
    if (h < stable.h)
      return {
          "the explicit scheme " + name + " " + end,
          step_text() + " is below " + text(stable.h) + " s, where it is stable for small motions, but not for these",
          "shorten time.step, or use time.integrator = \"backward_euler\""};
    const std::string cause = "the explicit scheme " + name + " blew up: its steps of " + text(h) +
                              " s are longer than the " + text(stable.h) + " s of its stability limit here";
    const std::string place =
        stable.is_damping ? " has the strongest damping, which limits the step"
                          : " vibrates fastest, at " + text(stable.frequency) + " Hz: small, stiff or light tets";
    return {cause, stable.vertex < 0 ? "" : vertex_name(model_, stable.vertex) + place,
            (gains_energy ? "" : "time.step = " + text(stable.h / 2) + " or less, or ") +
                "time.integrator = \"backward_euler\"" +
                (gains_energy ? ", as " + name + " adds energy in shorter steps, too" : "")};
  }

  // Positions at the start of the step, with the pins at their positions at its end.
  std::vector<double> placed() const {
    std::vector<double> placed = x_;
    Pins(model_.pins, simulation_.snapshot().start.q).place(report_.time, placed);
    return placed;
  }

  // Empty unless a tet with four pinned corners has lost its volume and its energy is infinite.
  Explanation pressed_by_pins() const {
    const std::vector<double> x = placed();
    const WorstTet worst = most_compressed(model_.mesh, x);
    if (worst.tet < 0 || worst.det_F > kPressedFlat || !is_pinned(worst.tet)) return {};
    if (std::all_of(model_.elasticity.begin(), model_.elasticity.end(),
                    [&](const auto& V) { return std::isfinite(V->value(x)); }))
      return {};
    return {
        "the pins themselves flatten or invert a tet, for any step length; the material has no "
        "energy there",
        tet_name(model_, worst.tet) + ", whose corners are all pinned: " + text(worst.det_F) + " of its volume",
        "material.model = \"stable_neo_hookean\", which tolerates it, or pins that stop earlier"};
  }

  // Empty unless the pins at the end of the step stretch a triangle beyond the limit of its sheet.
  Explanation stretched_by_pins() const {
    if (model_.mesh.sheet.empty()) return {};
    const WorstTriangle worst = overstretched(model_, placed());
    if (!(worst.stretch > 1)) return {};
    return {
        "the pins pull a sheet beyond the limit of its stretch, where its energy is infinite",
        tet_name(model_, worst.element) + " would be stretched by " + text(worst.stretch) + ", more than shell.limit",
        "raise shell.limit, move the pins less far, or " + smaller_steps()};
  }

  Explanation undefined_start() const {
    if (const std::string names = blocked_obstacles(); !names.empty())
      return {"obstacles cannot move to their next positions: bodies are in the way and do not yield", names,
              smaller_steps() + ", or move the obstacles more slowly"};
    const Explanation pins = pressed_by_pins();
    if (!pins.cause.empty()) return pins;
    const WorstTet worst = most_compressed(model_.mesh, placed());
    if (!(worst.det_F > 0) && worst.tet >= 0)
      return {"the pins invert a tet in one step, where the material has no finite energy",
              tet_name(model_, worst.tet) + ": " + text(worst.det_F) + " of its volume",
              smaller_steps() + ", or move the pins more slowly"};
    if (report_.iterations > 0) return undefined_end();
    int fastest = 0;
    double most = -1;
    const std::vector<double>& v = simulation_.state().qdot;
    for (size_t i = 0; i + 2 < v.size(); i += 3) {
      const double speed = std::hypot(v[i], v[i + 1], v[i + 2]);
      if (!(speed <= most)) most = speed, fastest = static_cast<int>(i / 3);
    }
    return {"the energy at the start of the step is not a finite number",
            vertex_name(model_, model_.vertex_of_row(fastest)) + " is fastest: " + text(most) + " m/s",
            smaller_steps() + ", and look for forces, pins or velocities that are too large"};
  }

  // The obstacles that did not move with the time and the bodies on their paths.
  std::string blocked_obstacles() const {
    if (!model_.contact || simulation_.obstacle_time() == report_.time) return "";
    std::string names;
    for (const std::string& pair : model_.contact->blocked_parts(x_, simulation_.obstacle_time(), report_.time))
      names += (names.empty() ? "" : "; ") + pair;
    return names;
  }

  // Explains iterations that led to a state of infinite energy.
  Explanation undefined_end() const {
    const std::string& name = simulation_.options().integrator;
    const std::string remedy = "time.integrator = \"backward_euler\", whose line search keeps the energy finite";
    if (simulation_.integrator().takes_one_iteration)
      return {"one Newton iteration without a line search left the domain of the energy",
              "time.integrator = \"" + name + "\"", remedy};
    if (simulation_.integrator().ends_beyond_minimum)
      return {"the step of " + name + " extrapolates beyond the minimum and left the domain of the energy",
              "time.integrator = \"" + name + "\"", remedy};
    if (solver_.minimize.line_search.test == DecreaseTest::none)
      return {"without a line search the iterations left the range of numbers", "solver.line_search.test = \"none\"",
              "solver.line_search.test = \"textbook\""};
    return {"the iterations left the range of numbers", residual_place(model_, report_, x_),
            smaller_steps() + ", and look for forces, pins or velocities that are too large"};
  }

  bool is_pinned(int tet) const {
    const auto& corners = model_.mesh.tets[tet];
    const Pins pins(model_.pins, simulation_.snapshot().start.q);
    return std::all_of(corners.begin(), corners.end(), [&](int corner) { return pins.holds(corner); });
  }

  Explanation too_fine() const {
    return {"the substeps became too short for the 16 digits of positions",
            "time.adaptive.tolerance = " + text(simulation_.options().adaptive.tolerance),
            "time.adaptive.tolerance = 1e-06"};
  }

  // Explains steps that contact makes short: two parts are pressed together so hard that only short ones keep them
  // apart.
  std::optional<Explanation> squeezed_gap() const {
    constexpr double kSmallGap = 0.02, kShortStep = 1e-3;  // relative to the reach, and to the direction
    if (!model_.contact) return {};
    const ContactSummary contact = model_.contact->summary(x_, simulation_.obstacle_time());
    const bool is_short = report_.step_limit < kShortStep;
    if (contact.contacts == 0 || !(is_short || contact.min_gap < kSmallGap * contact.reach)) return {};
    const std::string limit =
        is_short ? "limits the last step to " + text(report_.step_limit) : "allows only short steps";
    return Explanation{"contact " + limit + ": the gap between " + model_.contact->mesh().pair_name(contact.parts) +
                           " is " + text(contact.min_gap) + " m, " + text(contact.min_gap / contact.reach) +
                           " of the distance at which contact begins",
                       "contact", smaller_steps() + ", or a slower impact, or a larger contact.reach"};
  }

  Explanation inaccurate() const {
    if (report_.friction_passes >= kMaxUpdates && report_.friction_residual == 0)
      return {"the rims of pressures did not settle after " + std::to_string(report_.friction_passes) + " updates",
              "body.pressure", "less pressure, or a rim that is fixed; in dynamics shorter steps"};
    if (report_.friction_passes >= kMaxUpdates)
      return {"normal forces and friction did not settle after " + std::to_string(report_.friction_passes) +
                  " updates: the last one changes friction by " + text(report_.friction_residual) + " N",
              "contact.friction" + (report_.friction_pair.empty() ? "" : " between " + report_.friction_pair),
              smaller_steps() + ", or less friction"};
    if (simulation_.options().adaptive.tolerance < kFinest) return too_fine();
    return {"the error estimate of the smallest substep, time.step / 2^20, exceeds its share",
            "time.adaptive.tolerance = " + text(simulation_.options().adaptive.tolerance),
            "raise time.adaptive.tolerance; pins that jump cannot be resolved by shorter steps"};
  }

  Explanation too_strict(const std::string& cause) const {
    return {cause + ": a full Newton step lowers the energy by half of g.d, less than required",
            "solver.line_search.c = " + text(solver_.minimize.line_search.sufficient_decrease),
            "solver.line_search.c = 1e-4"};
  }

  Explanation stuck() const {
    const LineSearchOptions& search = solver_.minimize.line_search;
    const std::string cause = "the line search found no step that lowers the energy enough";
    if (search.test == DecreaseTest::slide)
      return {cause + ": the slide's test requires the decrease c g.d of a full step for any step length",
              "solver.line_search.test = \"slide\"", "solver.line_search.test = \"textbook\""};
    if (search.sufficient_decrease > 0.5) return too_strict(cause);
    if (search.tolerance > 1e-5)
      return {cause + " before it became shorter than tol", "solver.line_search.tol = " + text(search.tolerance),
              "solver.line_search.tol = 1e-10"};
    return {cause, compressed_place(model_, x_), smaller_steps() + "; `aspic check` finds bad tets"};
  }

  Explanation iteration_limit() const {
    const std::string cause = "not converged after " + std::to_string(report_.iterations) + " iterations";
    const MinimizeOptions& options = solver_.minimize;
    const double adaptive = simulation_.options().adaptive.tolerance;
    if (adaptive > 0 && adaptive < kFinest) return too_fine();
    const double threshold = report_.residual_threshold, round_off = report_.residual_round_off;
    if (threshold > 0 && threshold < round_off && report_.residual <= kNearRoundOff * round_off) {
      const double reachable = power_of_ten_above(options.tolerance * 10 * round_off / threshold);
      const bool is_useful = options.criterion == Criterion::absolute || is_static() || reachable <= kLoosest;
      return {cause + ": round-off alone is " + text(round_off) + " N, above the threshold",
              is_useful ? "solver.tolerance = " + text(options.tolerance) : step_text(),
              is_useful ? "solver.tolerance = " + text(reachable)
                        : "increase time.step: positions have 16 digits, and too few of them change in a short step"};
    }
    const std::string& B = solver_.preconditioner;
    if (!is_newton() && B != "auto" && B != "hessian")
      return {cause + ": without the Hessian " + solver_.method + " needs many more for stiff bodies",
              "solver.preconditioner = \"" + B + "\"", "solver.preconditioner = \"hessian\""};
    if (!is_newton())
      return {cause + ": methods without the Hessian need many more for stiff bodies",
              "solver.method = \"" + solver_.method + "\"",
              "solver.method = \"newton\", or raise solver.max_iterations"};
    if (options.line_search.sufficient_decrease > 0.5) return too_strict(cause);
    if (options.line_search.test == DecreaseTest::none)
      return {cause + ": without a line search Newton's method overshoots", "solver.line_search.test = \"none\"",
              "solver.line_search.test = \"textbook\""};
    if (options.max_iterations < MinimizeOptions().max_iterations)
      return {cause, "solver.max_iterations = " + std::to_string(options.max_iterations),
              "solver.max_iterations = " + std::to_string(MinimizeOptions().max_iterations)};
    return {cause, residual_place(model_, report_, x_), smaller_steps() + ", or raise solver.max_iterations"};
  }

  Explanation no_descent() const {
    if (is_newton() && solver_.definiteness == "exact")
      return {"the exact Hessian has directions of negative curvature, along which Newton's method would climb",
              "solver.definiteness = \"exact\"", "solver.definiteness = \"on_demand\""};
    return {"no descent direction could be computed", compressed_place(model_, x_),
            smaller_steps() + "; `aspic check` finds bad tets"};
  }

  const Simulation& simulation_;
  const StepReport& report_;
  const Model& model_;
  const SolverOptions& solver_;
  const std::vector<double>& x_;
};

}  // namespace

Explanation explain(const Simulation& simulation, const StepReport& report) {
  return Explainer(simulation, report).explain();
}

}  // namespace aspic
