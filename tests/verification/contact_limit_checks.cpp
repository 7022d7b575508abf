// Contact at its limits: arches at the friction that they need, edges that slide along edges, bullets.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mesh/generators.h"
#include "verification/contact_models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// A cross section of a leaning body: foot on the floor from x = 0 to `foot`, upright face at x = `span`.
struct Leaning {
  std::string name;
  double foot, span, low, high;  // the last two: heights of the upright face [m]
};

TetMesh leaning_body(const Leaning& shape, bool is_mirrored) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {2, 4, 2});
  for (Vec3d& X : mesh.rest) {
    const double s = X[0], t = X[1];
    const double x = (1 - t) * s * shape.foot + t * shape.span, y = t * (s * shape.low + (1 - s) * shape.high);
    X = {{is_mirrored ? -x : x, y, 0.1 * X[2]}};
  }
  if (is_mirrored)
    for (Tet& tet : mesh.tets) std::swap(tet[0], tet[1]);
  return mesh;
}

// Two bodies lean against each other. With the thrust H at its highest point and the force on the foot at its inner
// edge, the moment of the weight gives H = m g (x - foot) / high for the center of mass x: the least friction.
TouchingModel arch(const Leaning& shape, double friction) {
  TouchingModel given{.bodies = {{leaning_body(shape, false), 1e8}, {leaning_body(shape, true), 1e8}},
                      .has_floor = true,
                      .friction = friction,
                      .gravity = {{0, -kGravity, 0}}};
  constexpr double kStart = 4e-5;                     // gaps at the start [m]
  given.contact = {.reach = 5e-5, .stiffness = 1e7};  // a smaller reach, so that stones tilt little on their edges
  for (Vec3d& X : given.bodies[0].mesh.rest) X = X + Vec3d{{-shape.span - kStart / 2, kStart, 0}};
  for (Vec3d& X : given.bodies[1].mesh.rest) X = X + Vec3d{{shape.span + kStart / 2, kStart, 0}};
  return given;
}

double height_of_top(const Simulation& simulation) {
  double top = 0;
  for (size_t i = 1; i < simulation.state().q.size(); i += 3) top = std::max(top, simulation.state().q[i]);
  return top;
}

void check_arch(const Subject& subject, Findings& found) {
  const int steps = subject.quick ? 60 : 150;
  for (const Leaning& shape : {Leaning{"stones", 0.04, 0.1, 0.09, 0.12}, {"cards", 0.002, 0.05, 0.097, 0.1}}) {
    const TouchingModel any = arch(shape, 1);
    const Model model = make_touching(any);
    const auto [first, end] = vertices_of(any, 0);
    const double arm = mass_mean(model, at_rest(model.mesh).q, first, end)[0] + shape.span - shape.foot;
    for (const double share : {0.95, 1.05}) {
      SimulationOptions options{.h = 0.01, .solver = {}};
      Simulation simulation = simulate(make_touching(arch(shape, share * arm / shape.high)), options);
      const double before = height_of_top(simulation);
      take_steps(simulation, steps, "arch of two " + shape.name);
      const double fallen = before - height_of_top(simulation);
      const std::string name = shape.name + ", mu = " + std::to_string(share).substr(0, 4) + " of the least: ";
      expect_contact(name, simulation, found);
      if (share > 1)
        found.expect_small(name + "fall of the top", fallen, 0.001, "an arch that stands settles by a few gaps", "m");
      else
        found.expect(name + "falls by a tenth of its height", {fallen > 0.1 * shape.high ? 1.0 : 0.0, 1, 0},
                     "yes or no");
    }
  }
}

// A corner with two walls, x < 0 and y < 0, and edges along z.
TetMesh corner() {
  TetMesh mesh = make_box({{-0.1, -0.1, -0.2}}, {{0.1, 0.1, 1.4}}, {2, 2, 8});
  std::erase_if(mesh.tets, [&](const Tet& tet) {
    double x = 0, y = 0;
    for (const int v : tet) x += mesh.rest[v][0], y += mesh.rest[v][1];
    return x > 0 && y > 0;
  });
  return mesh;
}

// A box slides along the corner. All edges of both along z are close to one another and parallel.
void check_corner(const Subject& subject, Findings& found) {
  const double speed = 0.5, h = 0.002, gap = 0.001, down = kGravity / std::sqrt(2.0);
  const int steps = subject.quick ? 100 : 1000;
  TouchingModel given{.bodies = {{corner()}, {make_box({{gap, gap, 0}}, {{0.1 + gap, 0.1 + gap, 0.2}}, {2, 2, 3})}},
                      .gravity = {{-down, -down, 0}}};
  Model model = make_touching(given);
  const auto [first, end] = vertices_of(given, 1);
  std::vector<int> walls;
  for (int v = 0; v < first; ++v) walls.push_back(v);
  model.pins.push_back({"walls", walls, {}});
  State start = at_rest(model.mesh);
  for (int v = first; v < end; ++v) start.qdot[3 * v + 2] = speed;
  Simulation simulation(std::move(model), start, {.h = h, .solver = {}});
  const Vec3d before = mass_mean(simulation.model(), simulation.state().q, first, end);
  int contacts = 0;
  for (int i = 0; i < steps; ++i) {
    take_steps(simulation, 1, "box in a corner");
    contacts += simulation.model().contact->summary(simulation.state().q, 0).contacts > 0;
  }
  const Vec3d moved = mass_mean(simulation.model(), simulation.state().q, first, end) - before;
  expect_contact("", simulation, found);
  found.expect("steps in contact / steps", {static_cast<double>(contacts) / steps, 1, 0.2},
               "the box falls by a gap first");
  found.expect("distance along the edges", {moved[2], speed * steps * h, 1e-3 * speed * steps * h},
               "1e-3: the energy of contact depends on where vertices meet", "m");
  for (const int k : {0, 1})
    found.expect_small(std::string("motion towards the wall ") + "xy"[k], std::abs(moved[k]), gap,
                       "the gap at the start", "m");
}

// A bullet at a plate that is thinner than the way of the bullet in a step. Neither is held.
void check_bullet(const Subject& subject, Findings& found) {
  const double speed = 1000, h = 1e-4;
  TouchingModel given{.bodies = {{make_box({{-0.5, 0, -0.5}}, {{0.5, 0.01, 0.5}}, {1, 1, 1}), 1e11},
                                 {make_box({{-0.05, 0.06, -0.05}}, {{0.05, 0.16, 0.05}}, {2, 2, 2}), 1e11}}};
  Model model = make_touching(given);
  const auto [first, end] = vertices_of(given, 1);
  State start = at_rest(model.mesh);
  for (int v = first; v < end; ++v) start.qdot[3 * v + 1] = -speed;
  SimulationOptions options{.h = h, .solver = {}};
  options.solver.minimize.tolerance = 1e-9;
  Simulation simulation(std::move(model), start, options);
  const double momentum = mass_mean(simulation.model(), simulation.state().qdot)[1];
  int contacts = 0;
  double gained = 0, total = simulation.start_report().kinetic;
  const double initial = total;
  for (int i = 0; i < (subject.quick ? 6 : 20); ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status)) throw std::runtime_error("bullet: a step did not converge");
    contacts += report.contacts;
    gained = std::max(gained, report.kinetic + report.potential_total - total);
    total = report.kinetic + report.potential_total;
  }
  const std::vector<double>& q = simulation.state().q;
  const double bullet = mass_mean(simulation.model(), q, first, end)[1];
  const double plate = mass_mean(simulation.model(), q, 0, first)[1];
  found.expect("the bullet has hit and is above the plate", {contacts > 0 && bullet > plate ? 1.0 : 0.0, 1, 0},
               "yes or no");
  found.expect_small("change of the momentum, relative",
                     std::abs(mass_mean(simulation.model(), simulation.state().qdot)[1] / momentum - 1), 1e-6,
                     "the solves leave 1e-9 of the forces");
  found.expect_small("largest gain of energy in a step / energy", std::max(gained, 0.0) / initial, 1e-9,
                     "round-off: backward Euler only loses");
}

}  // namespace

void add_contact_limit_checks(std::vector<Check>& checks) {
  checks.push_back({"contact",
                    "arch",
                    "Two stones, or two cards, lean against each other if friction suffices",
                    "Coefficients of friction of 0.95 and 1.05 of the least one, mu. Cards of 1 mm lean at 27 degrees.",
                    "Limit analysis: the thrust acts at the highest point y of contact between them, the floor at "
                    "the inner edge f of the foot; x is the center of mass",
                    check_arch,
                    {},
                    {R"tex(\mu = \frac{x - f}{y})tex"}});
  checks.push_back({"contact",
                    "corner",
                    "Edges slide along parallel edges",
                    "A box slides in a corner along its edges, 1 000 steps.",
                    "The speed is constant without friction",
                    check_corner,
                    {},
                    {R"tex(v(t) = v_0)tex"}});
  checks.push_back({"contact",
                    "bullet",
                    "A bullet does not pass through a thin plate",
                    "1 000 m/s, 0.1 m per step; the plate has one layer of tets, 0.01 m thick.",
                    "Momentum is conserved, and energy does not grow",
                    check_bullet,
                    {},
                    {R"tex(p_{n+1} = p_n, \quad E_{n+1} \le E_n)tex"}});
}

}  // namespace aspic::verify
