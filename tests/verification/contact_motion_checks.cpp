// Impacts: forces and times, momenta, energies, units.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/vectors.h"
#include "mesh/generators.h"
#include "verification/contact_models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// An elastic bar of length 1, area 1/100, E = rho = c = 1, flies at a wall with the speed v.
void check_bar(const Subject& subject, Findings& found) {
  const double v = 1e-3, side = 0.1, reach = 1e-5;
  const int cells = subject.quick ? 50 : 100;
  const double h = subject.quick ? 5e-3 : 2e-3;
  TouchingModel given{.bodies = {{make_box({{0, reach, 0}}, {{side, 1 + reach, side}}, {1, cells, 1})}},
                      .has_floor = true};
  given.bodies[0].young = subject.stiffness;
  given.bodies[0].density = 1;
  given.poisson = 0;
  given.contact = {.reach = reach, .stiffness = 0.1};
  given.material = subject.replacement("linear");
  Model model = make_touching(given);
  State start = at_rest(model.mesh);
  for (size_t i = 1; i < start.qdot.size(); i += 3) start.qdot[i] = -v;
  SimulationOptions options{.h = h, .integrator = subject.replacement("backward_euler"), .solver = {}};
  options.solver.minimize.tolerance = 1e-9;
  Simulation simulation(std::move(model), start, options);
  const double plateau = v * side * side;
  double impulse = 0, middle = 0, first = 0, last = 0, before = 0;
  int samples = 0;
  const int steps = static_cast<int>(std::lround(3 / h));
  for (int i = 1; i <= steps; ++i) {
    take_steps(simulation, 1, "bar on a wall");
    const double force = contact_force(simulation)[1], time = i * h;
    impulse += h * force;
    // A front with the profile s(t), smoothed by the scheme, changes the force by -2 F s at the wall, so the force ends
    // at the middle of the front. A small level avoids noise.
    const double level = 0.02 * plateau, crossing = time - h * (force - level) / (force - before);
    if (before < level && force >= level && first == 0) first = crossing;
    if (before >= level && force < level) last = crossing;
    if (time > 0.75 && time < 1.25) middle += force, ++samples;
    before = force;
  }
  found.expect("time of contact / (2 L / c)", {(last - first) / 2, 1, 0.02},
               "2 %: fronts have a width of several cells");
  found.expect("force / (rho c v A)", {middle / samples / plateau, 1, 0.02},
               "2 %: oscillations with the wavelength of a cell");
  const double velocity = mass_mean(simulation.model(), simulation.state().qdot)[1];
  found.expect("change of momentum / impulse", {(velocity + v) * side * side / impulse, 1, 1e-6},
               "the solves have a relative residual of 1e-9");
}

// Two boxes that fly at each other askew, without gravity.
TouchingModel flying_boxes(double size, double young, double density) {
  TouchingModel given{
      .bodies = {{make_box({{-0.1 * size, 0, -0.05 * size}}, {{-0.002 * size, 0.1 * size, 0.05 * size}}, {2, 2, 2})},
                 {make_box({{0, 0.03 * size, -0.03 * size}}, {{0.1 * size, 0.13 * size, 0.07 * size}}, {3, 3, 3})}},
      .friction = 0.4};
  for (TouchingBody& body : given.bodies) body.young = young, body.density = density;
  given.creep = 1e-4;
  return given;
}

struct Flight {
  Mat3d turn = identity3<double>();
  std::string integrator = "backward_euler";
};

Simulation flying(const TouchingModel& given, double h, double tolerance, const Flight& flight = {}) {
  Model model = make_touching(given);
  State start = at_rest(model.mesh);
  for (const size_t body : {0, 1}) {
    const auto [first, end] = vertices_of(given, body);
    const Vec3d velocity = flight.turn * (body == 0 ? Vec3d{{1, 0.5, 0}} : Vec3d{{-1, 0, 0}});
    for (int v = first; v < end; ++v)
      for (int k = 0; k < 3; ++k) start.qdot[3 * v + k] = velocity[k];
  }
  SimulationOptions options{.h = h, .integrator = flight.integrator, .solver = {}};
  options.solver.minimize.tolerance = tolerance;
  return Simulation(std::move(model), start, options);
}

// Sum of x_i x (M v)_i.
Vec3d moment(const Model& model, std::span<const double> x, std::span<const double> v) {
  std::vector<double> momentum(v.size());
  model.mass->multiply(v, momentum);
  Vec3d sum{};
  for (int i = 0; i < model.mesh.vertex_count(); ++i) sum = sum + cross(point(x, i), point(momentum, i));
  return sum;
}

// The boxes collide obliquely. Contact conserves the angular momentum L, friction up to its moment over the gap.
void check_angular_momentum(const Subject& subject, Findings& found) {
  const double t = 0.04, h = subject.quick ? 1e-3 : 5e-4;
  for (const std::string scheme : {"backward_euler", "bdf2"})
    for (const double friction : {0.0, 0.3}) {
      TouchingModel given = flying_boxes(1, 1e5, 1000);
      given.friction = friction;
      Simulation simulation = flying(given, h, 1e-11, {.integrator = subject.replacement(scheme)});
      const Model& model = simulation.model();
      const State& state = simulation.state();
      const Vec3d start = moment(model, state.q, state.qdot);
      const auto [first, end] = vertices_of(given, 0);
      const Vec3d flight = mass_mean(model, state.qdot, first, end);
      Vec3d by_scheme{};
      for (int i = 0; i < std::lround(t / h); ++i) {
        const std::vector<double> v = state.qdot;
        take_steps(simulation, 1, "boxes");
        by_scheme = by_scheme + h * moment(model, state.qdot, v);
      }
      const Vec3d change = moment(model, state.q, state.qdot) - start;
      const double impulse = norm(mass_mean(model, state.qdot, first, end) - flight);  // the mass is 1 kg
      const std::string name = scheme + ", mu = " + std::to_string(friction).substr(0, 3) + ": change of L / L";
      const double of_friction = friction > 0 ? model.contact->laws()(0, 1).reach * impulse / norm(start) : 0;
      if (scheme == "backward_euler")
        found.expect_small(name + ", without that of the scheme", norm(change - by_scheme) / norm(start),
                           1e-9 + of_friction, "residual of the solves; moment of friction: its impulse times the gap");
      else
        found.expect_small(name, norm(change) / norm(start), 5e-3, "some steps of the impact are backward Euler");
      found.expect("impact exists", {impulse > 0.1 ? 1.0 : 0.0, 1, 0}, "yes or no");
    }
}

// A stiff box that turns once per second about a vertical axis, in flight and on a floor without friction.
void check_spin(const Subject& subject, Findings& found) {
  const double h = 0.01, omega = 2 * std::numbers::pi;
  const int steps = subject.quick ? 30 : 100;
  for (const std::string scheme : {"backward_euler", "bdf2"})
    for (const bool has_floor : {false, true}) {
      TouchingModel given{.bodies = {{make_box({{-0.05, 1e-4, -0.05}}, {{0.05, 0.0501, 0.05}}, {2, 1, 2}), 1e7}},
                          .has_floor = has_floor,
                          .gravity = {{0, has_floor ? -kGravity : 0, 0}}};
      Model model = make_touching(given);
      State start = at_rest(model.mesh);
      for (int v = 0; v < model.mesh.vertex_count(); ++v)
        set_vec(cross(Vec3d{{0, omega, 0}}, model.mesh.rest[v]), v, start.qdot);
      SimulationOptions options{.h = h, .integrator = subject.replacement(scheme), .solver = {}};
      Simulation simulation(std::move(model), start, options);
      const auto spin = [&] { return moment(simulation.model(), simulation.state().q, simulation.state().qdot)[1]; };
      const double before = spin();
      take_steps(simulation, steps, "spinning box");
      const double left = 1 / std::sqrt(1 + 2 * h * omega * omega * steps * h);
      const std::string name = scheme + (has_floor ? ", on a floor" : ", in flight") + ": angular momentum left";
      if (scheme == "backward_euler")
        found.expect(name, {spin() / before, left, 5e-3}, "the formula is the limit of small steps");
      else
        found.expect(name, {spin() / before, 1, 0.01}, "0.4 % in the first step, which is one of backward Euler");
    }
}

struct Resultant {
  double force, moment;  // |sum of forces| / sum of |force|, the same of moments
};

Resultant resultant(const std::vector<double>& q, const std::vector<double>& g) {
  Vec3d sum{}, moment{};
  double size = 0, arm = 0;
  for (size_t i = 0; i < g.size(); i += 3) {
    const Vec3d f{{g[i], g[i + 1], g[i + 2]}}, x{{q[i], q[i + 1], q[i + 2]}};
    sum = sum + f;
    moment = moment + cross(x, f);
    size += norm(f);
    arm += norm(f) * norm(x);
  }
  return {norm(sum) / size, norm(moment) / arm};
}

void check_third_law(const Subject& subject, Findings& found) {
  const TouchingModel given = flying_boxes(1, 1e5, 1000);
  Simulation simulation = flying(given, 1e-3, 1e-11);
  const Model& model = simulation.model();
  const auto momentum = [&] { return 2.0 * mass_mean(model, simulation.state().qdot); };
  const Vec3d before = momentum();
  Resultant worst{}, worst_friction{};
  double drift = 0;
  int contacts = 0;
  for (int i = 0; i < (subject.quick ? 10 : 30); ++i) {
    const std::vector<double> start = simulation.state().q;
    const StepReport report = simulation.step();
    if (!is_success(report.status)) throw std::runtime_error("boxes: a step did not converge");
    drift = std::max(drift, norm(momentum() - before));
    if (report.contacts == 0) continue;
    contacts += report.contacts;
    const std::vector<double>& q = simulation.state().q;
    std::vector<double> g(q.size());
    model.contact->add_gradient(q, {}, 1, g);
    const Resultant of_contact = resultant(q, g);
    worst = {std::max(worst.force, of_contact.force), std::max(worst.moment, of_contact.moment)};
    const Energy& friction = *model.damping.back();
    const auto context = friction.make_context();
    friction.begin_step({.start = start, .h = 1e-3}, *context);
    dynamic_cast<const LaggedEnergy&>(friction).update_lagged(q, false, *context);
    std::vector<double> f(q.size());
    friction.add_gradient(q, *context, 1, f);
    worst_friction.force = std::max(worst_friction.force, max_abs(f) > 0 ? resultant(q, f).force : 0);
  }
  found.expect_small("sum of contact forces / sum of their sizes", worst.force, 1e-12,
                     "round-off of the sum of each stencil");
  found.expect_small("sum of their moments, relative", worst.moment, 1e-12,
                     "round-off: each force acts along the line between its points");
  found.expect_small("sum of friction forces / sum of their sizes", worst_friction.force, 1e-12,
                     "round-off of the sum of each stencil");
  found.expect_small("change of the mean velocity / impact speed", drift / 2, 1e-9,
                     "each solve has a residual of 1e-11 of the balancing forces");
  found.expect("contacts in all steps exist", {contacts > 10 ? 1.0 : 0.0, 1, 0}, "yes or no");
}

// A soft box that falls onto the floor askew and bounces.
void check_bounce(const Subject& subject, Findings& found) {
  for (const auto& [scheme, friction] :
       {std::pair("backward_euler", 0.0), std::pair("backward_euler", 0.4), std::pair("bdf2", 0.4)}) {
    const bool only_loses = std::string(scheme) == "backward_euler";
    const double h = 1e-3;
    TetMesh mesh = make_box({{-0.05, 0, -0.05}}, {{0.05, 0.1, 0.05}}, {2, 2, 2});
    for (Vec3d& X : mesh.rest) X = {{0.8 * X[0] - 0.6 * X[1], 0.6 * X[0] + 0.8 * X[1] + 0.032, X[2] + 0.1 * X[1]}};
    TouchingModel given{.bodies = {{mesh, 1e5}}, .has_floor = true, .friction = friction, .gravity = {{0, -9.81, 0}}};
    Model model = make_touching(given);
    State start = at_rest(model.mesh);
    for (size_t i = 0; i < start.qdot.size(); i += 3) start.qdot[i] = 1, start.qdot[i + 1] = -2;
    SimulationOptions options{.h = h, .integrator = subject.replacement(scheme), .solver = {}};
    Simulation simulation(std::move(model), start, options);
    const StepReport first = simulation.start_report();
    double total = first.potential_total + first.kinetic, gained = 0, ledger = 0, lost = 0;
    const double initial = total;
    int contacts = 0;
    for (int i = 0; i < (subject.quick ? 40 : 200); ++i) {
      const StepReport report = simulation.step();
      if (!is_success(report.status)) throw std::runtime_error("bouncing box: a step did not converge");
      const double now = report.potential_total + report.kinetic;
      gained = std::max(gained, (now - total) / initial);
      double largest = std::max({report.kinetic, report.damping_loss, std::abs(report.numerical_loss)});
      for (const double V : report.potential) largest = std::max(largest, std::abs(V));
      ledger = std::max(ledger, std::abs(report.ledger_error) / largest);
      lost += report.friction_loss;
      total = now;
      contacts += report.contacts;
    }
    const std::string name = std::string(scheme) + (friction > 0 ? ", with friction: " : ", without friction: ");
    found.expect_small(name + "largest gain of energy in a step / energy", std::max(gained, 0.0),
                       only_loses ? 1e-12 : 0.01,
                       only_loses ? "round-off: backward Euler only loses" : "larger gains repeat the step");
    found.expect_small(name + "energy at the end / energy", total / initial, 1, "contact adds no energy");
    found.expect_small(name + "largest ledger error / largest term", ledger, 1e-9, "round-off of the energies");
    found.expect(name + "friction dissipates energy, and contacts exist",
                 {(lost > 0) == (friction > 0) && lost >= 0 && contacts > 10 ? 1.0 : 0.0, 1, 0}, "yes or no");
  }
}

void check_contact_units(const Subject& subject, Findings& found) {
  struct Motion {
    std::vector<double> q;
    std::vector<int> iterations;
  };
  const auto run = [&](double a, double b) {
    TouchingModel given = flying_boxes(a, 1e5 * b, 1000 * b);
    given.creep = 1e-3;
    Simulation simulation = flying(given, 1e-3 * a, 1e-10);
    Motion motion;
    for (int i = 0; i < (subject.quick ? 10 : 20); ++i) motion.iterations.push_back(simulation.step().iterations);
    motion.q = simulation.state().q;
    for (double& x : motion.q) x /= 0.1 * a;
    return motion;
  };
  const Motion meters = run(1, 1);
  struct Units {
    const char* name;
    double a, b;
  };
  for (const Units& units : {Units{"lengths and times x 1000", 1e3, 1},
                             {"lengths and times / 1000", 1e-3, 1},
                             {"moduli and densities / 1e6", 1, 1e-6}}) {
    const Motion other = run(units.a, units.b);
    int changed = 0;
    for (size_t i = 0; i < other.iterations.size(); ++i) changed += other.iterations[i] != meters.iterations[i];
    found.expect_small(std::string(units.name) + ": largest relative change", largest_difference(other.q, meters.q),
                       1e-9, "the same iterations, apart from round-off");
    found.expect_small(std::string(units.name) + ": steps with another number of iterations", changed, 0,
                       "all constants scale");
  }
}

// The same motion in a turned and shifted frame, and with the vertices in reverse order.
void check_frames(const Subject& subject, Findings& found) {
  const double c = std::cos(1.0), s = std::sin(1.0);
  const Mat3d R = Mat3d{{c, s, 0, -s, c, 0, 0, 0, 1}} * Mat3d{{1, 0, 0, 0, s, c, 0, -c, s}};
  const Vec3d shift{{0.3, -0.2, 0.1}};
  const int steps = subject.quick ? 10 : 20;
  const auto end_of = [steps](const TouchingModel& given, const Mat3d& turn) {
    Simulation simulation = flying(given, 1e-3, 1e-11, {.turn = turn});
    take_steps(simulation, steps, "boxes in another frame");
    return simulation.state().q;
  };
  const TouchingModel given = flying_boxes(1, 1e5, 1000);
  const std::vector<double> q = end_of(given, identity3<double>());
  TouchingModel turned = given, reversed = given;
  for (TouchingBody& body : turned.bodies)
    for (Vec3d& X : body.mesh.rest) X = R * X + shift;
  for (TouchingBody& body : reversed.bodies) {
    std::reverse(body.mesh.rest.begin(), body.mesh.rest.end());
    for (Tet& tet : body.mesh.tets)
      for (int& v : tet) v = body.mesh.vertex_count() - 1 - v;
  }
  const std::vector<double> p = end_of(turned, R), r = end_of(reversed, identity3<double>());
  double by_turn = 0, by_order = 0;
  for (const size_t body : {0, 1}) {
    const auto [first, end] = vertices_of(given, body);
    for (int v = first; v < end; ++v) {
      by_turn = std::max(by_turn, norm(point(p, v) - (R * point(q, v) + shift)));
      by_order = std::max(by_order, norm(point(r, first + end - 1 - v) - point(q, v)));
    }
  }
  const std::string reason = "each solve has a relative residual of 1e-11; the motion of a step is 1e-3 m";
  found.expect_small("largest change by another frame", by_turn, 1e-9, reason, "m");
  found.expect_small("largest change by another numbering", by_order, 1e-9, reason, "m");
}

}  // namespace

void add_contact_motion_checks(std::vector<Check>& checks) {
  checks.push_back({"contact",
                    "bar",
                    "An elastic bar flies against a wall",
                    "Length 1, E = rho = 1, nu = 0, v = c / 1000.",
                    "The wave equation: duration and force of the contact",
                    check_bar,
                    {},
                    {R"tex(T = \frac{2 L}{c}, \quad F = \rho c v A, \quad c = \sqrt{\frac{E}{\rho}})tex"}});
  checks.push_back({"contact",
                    "third_law",
                    "Contact and friction conserve momentum",
                    "Two soft boxes collide askew.",
                    "Newton's third law; contact forces act along the line between their points",
                    check_third_law,
                    {},
                    {R"tex(\sum_i f_i = 0, \quad \sum_i x_i \times f_i = 0)tex"}});
  checks.push_back({"contact",
                    "angular_momentum",
                    "Contact conserves angular momentum",
                    "Two soft boxes collide obliquely, with and without friction.",
                    "Backward Euler changes the angular momentum L by the cross products of successive velocities",
                    check_angular_momentum,
                    {},
                    {R"tex(L_{n+1} - L_n = h \sum v_{n+1} \times M v_n)tex"}});
  checks.push_back({"contact",
                    "spin",
                    "Spinning bodies keep their angular momentum",
                    "A stiff box turns once per second, in flight and on a floor without friction, h = 10 ms.",
                    "Backward Euler loses rotation; bdf2 has order 2",
                    check_spin,
                    {},
                    {R"tex(\omega = \frac{\omega_0}{\sqrt{1 + 2 h \omega_0^2 t}} \quad (\text{backward Euler}))tex"}});
  checks.push_back({"contact",
                    "bounce",
                    "A bounce gains no energy",
                    "A soft box falls askew onto the floor.",
                    "Backward Euler loses energy in every step, bdf2 in all; the ledger closes",
                    check_bounce,
                    {},
                    {R"tex(E_{n+1} \le E_n)tex"}});
  checks.push_back({"contact", "frames", "Contact is invariant under frame and numbering",
                    "The boxes turned and shifted, and with vertices in reverse order.",
                    "The equations are independent of frame and numbering", check_frames});
  checks.push_back({"contact", "units", "Contact is independent of units",
                    "The boxes in other units of length and time, of modulus and density.",
                    "The equations are homogeneous", check_contact_units});
}

}  // namespace aspic::verify
