// Default distance at which contact begins: gaps, clearances and thin parts that the user modeled.
#include <algorithm>
#include <cmath>

#include "mesh/generators.h"
#include "reference/statics.h"
#include "reference/uniaxial.h"
#include "verification/contact_models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

constexpr double kGap = 1e-4;        // between surfaces at the start [m]
constexpr double kReach = kGap / 5;  // the default for this gap [m]
constexpr double kSide = 0.1;        // of the cube in the press [m]
constexpr double kThickness = 2e-4;  // of a card [m]
constexpr int kCards = 3;

double highest(const Simulation& simulation) {
  double top = -INFINITY;
  for (size_t i = 1; i < simulation.state().q.size(); i += 3) top = std::max(top, simulation.state().q[i]);
  return top;
}

double lowest(const Simulation& simulation) {
  double bottom = INFINITY;
  for (size_t i = 1; i < simulation.state().q.size(); i += 3) bottom = std::min(bottom, simulation.state().q[i]);
  return bottom;
}

// Takes steps. Returns the largest rise of the highest point above the start [m].
double largest_rise(Simulation& simulation, int steps, const std::string& what) {
  const double start = highest(simulation);
  double most = start;
  for (int i = 0; i < steps; ++i) {
    take_steps(simulation, 1, what);
    most = std::max(most, highest(simulation));
  }
  return most - start;
}

struct Press {
  std::string material;
  double poisson, stretch;
  Uniaxial expected;  // for E = 1
};

// A cube of 0.1 m with free sides, between plates without friction that start `kGap` from it and both move.
Uniaxial pressed(const Press& press, const Subject& subject, Findings& found) {
  TouchingModel given{.bodies = {{make_box({{0, 0, 0}}, {{kSide, kSide, kSide}}, {4, 4, 4}), 1e5 * subject.stiffness}},
                      .material = subject.replacement(press.material),
                      .poisson = press.poisson};
  const double travel = press.stretch == 1 ? 0 : kGap + kSide * (1 - press.stretch) / 2;
  given.walls = {{{{0, -kGap, 0}}, {{0, 1, 0}}, {{0, travel, 0}}},
                 {{{0, kSide + kGap, 0}}, {{0, -1, 0}}, {{0, -travel, 0}}}};
  Model model = make_touching(given);
  for (const int k : {0, 1, 2}) {
    Vec3d axis{};
    axis[k] = 1;
    const double at = k == 1 ? kSide / 2 : 0;
    model.pins.push_back({std::string("middle ") + "xyz" [k],
                          vertices_where(model.mesh, [=](const Vec3d& X) { return std::abs(X[k] - at) < 1e-9; }),
                          {},
                          {axis}});
  }
  const auto upper = vertices_where(model.mesh, [](const Vec3d& X) { return X[1] > 0.51 * kSide; });
  const Simulation simulation = equilibrium(std::move(model), 10, "press", 1e-10);
  if (travel > 0) expect_contact(press.material + ": ", simulation, found);
  double width = 0;
  for (size_t i = 0; i < simulation.state().q.size(); i += 3) width = std::max(width, simulation.state().q[i]);
  return {width / kSide, sum_over(upper, elastic_forces(simulation))[1] / (kSide * kSide)};
}

void check_press(const Subject& subject, Findings& found) {
  const UniaxialReference& half = uniaxial_table().front();
  for (const Press& press : {Press{"linear", 0, 0.982, {1, -0.018}},
                             {half.material, half.poisson, half.stretch, half.expected},
                             {"linear", 0, 1, {1, 0}}}) {
    const Uniaxial measured = pressed(press, subject, found);
    const double gaps = press.stretch == 1 ? 0 : 2 * kReach / kSide;
    const std::string name = press.material + ", stretch " + std::to_string(press.stretch).substr(0, 5) + ": ";
    const std::string reason = gaps == 0 ? "the reach is smaller than the gap" : "two gaps of at most the reach";
    found.expect(name + "stress / E", {measured.stress / 1e5, press.expected.stress, gaps + 1e-12}, reason);
    found.expect(name + "lateral stretch", {measured.lateral, press.expected.lateral, gaps + 1e-8}, reason);
  }
}

// A block between two walls, 0.1 mm from each.
TouchingModel slot(const Vec3d& gravity) {
  TouchingModel given{.bodies = {{make_box({{kGap, 0, 0}}, {{0.1 + kGap, 0.1, 0.1}}, {4, 4, 4}), 1e6}},
                      .friction = 0.5,
                      .gravity = gravity};
  given.walls = {{{{0, 0, 0}}, {{1, 0, 0}}, {}}, {{{0.1 + 2 * kGap, 0, 0}}, {{-1, 0, 0}}, {}}};
  return given;
}

void check_slot(const Subject&, Findings& found) {
  constexpr int kSteps = 20;
  constexpr double h = 0.01;
  Simulation falling = simulate(make_touching(slot({{0, -kGravity, 0}})), {.h = h, .solver = {}});
  take_steps(falling, kSteps, "block in a slot");
  const double fall = kGravity * h * h * kSteps * (kSteps + 1) / 2;
  found.expect("fall in 20 steps", {-lowest(falling), fall, 1e-9 * fall}, "free fall: the walls exert no force", "m");
  Simulation leaning = simulate(make_touching(slot({{-0.1, 0, 0}})), {.h = 0.05, .solver = {}});
  take_steps(leaning, 40, "block leans on a wall");
  expect_contact("leaning: ", leaning, found);
  const double shift = -mass_mean(leaning.model(), leaning.state().q)[0] + 0.05 + kGap;
  found.expect("play to one side", {shift, kGap, 1.1 * kReach}, "the clearance less at most the reach", "m");
}

// Cards above the floor and one another, at rest at the end. Returns the height of the top [m].
double stacked(double gap, const Subject& subject, Findings& found) {
  TouchingModel given{.bodies = {}, .has_floor = true, .poisson = 0.3, .gravity = {{0, -kGravity, 0}}};
  for (int i = 0; i < kCards; ++i) {
    const double bottom = gap + i * (gap + kThickness);
    given.bodies.push_back({make_box({{0, bottom, 0}}, {{0.05, bottom + kThickness, 0.03}}, {4, 1, 3}), 1e9});
  }
  Simulation simulation = simulate(make_touching(given), {.h = 0.01, .solver = {}});
  const double rise = largest_rise(simulation, subject.quick ? 20 : 60, "stack of cards");
  const std::string name = "gaps of " + std::to_string(gap * 1e3).substr(0, 4) + " mm: ";
  expect_contact(name, simulation, found);
  found.expect_small(name + "rise above the start", rise, 1e-9, "nothing pushes at the start", "m");
  return highest(simulation);
}

void check_cards(const Subject& subject, Findings& found) {
  for (const double gap : {5e-5, 1e-3}) {
    const double reach = std::min(gap / 5, kThickness / 10), top = kCards * kThickness;
    found.expect("gaps of " + std::to_string(gap * 1e3).substr(0, 4) + " mm: height of the stack",
                 {stacked(gap, subject, found), top, 1.1 * kCards * reach},
                 "gaps of at most the reach: a fifth of the gap at the start, a tenth of the thickness", "m");
  }
}

void check_drop(const Subject& subject, Findings& found) {
  constexpr double kAbove = 5e-3;
  TouchingModel given{.bodies = {{make_box({{0, kAbove, 0}}, {{1, 1 + kAbove, 1}}, {1, 1, 1}), 1e7}},
                      .has_floor = true,
                      .gravity = {{0, -kGravity, 0}}};
  for (const double h : {0.01, 0.001}) {
    const std::string name = "steps of " + std::to_string(std::lround(1e3 * h)) + " ms: ";
    Simulation simulation = simulate(make_touching(given), {.h = h, .solver = {}});
    const double top = highest(simulation);
    const int flight = static_cast<int>(std::sqrt(0.25 + 1.5 * kAbove / (kGravity * h * h)) - 0.5);
    take_steps(simulation, flight, "falling cube");
    found.expect(name + "speed before the impact",
                 {-mass_mean(simulation.model(), simulation.state().qdot)[1], kGravity * h * flight, 1e-9},
                 "free fall through 3/4 of the height, backward Euler", "m/s");
    const double fallen = top - highest(simulation);
    const double rise = largest_rise(simulation, static_cast<int>((subject.quick ? 0.5 : 3) / h), "cube on the floor");
    expect_contact(name, simulation, found);
    found.expect_small(name + "rise above the start", std::max(0.0, rise - fallen), 1e-9,
                       "nothing pushes at the start, and a rebound ends below it", "m");
    found.expect_small(name + "gap at rest", lowest(simulation), kAbove / 5,
                       "at most the reach, a fifth of the gap at the start", "m");
  }
}

}  // namespace

void add_contact_start_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"contact",
       "press",
       "Two plates press a block",
       "A cube of 0.1 m. The plates start 0.1 mm from it and shorten it by 1.8 % (linear, nu = 0) and by half "
       "(neo_hookean_log, nu = 0.3); its sides are free.",
       "The uniaxial state, and no force of plates that stay away",
       check_press,
       {},
       {R"tex(P(l, t) = -0.93535206\, E, \quad t = 1.21076739 \quad (l = \tfrac12))tex"}});
  checks.push_back({"contact",
                    "slot",
                    "A block in a slot with a clearance of 0.1 mm",
                    "It falls along the slot, or rests on one wall.",
                    "Free fall; the clearance",
                    check_slot,
                    {},
                    {R"tex(y_n = -\frac{1}{2} g h^2 n (n + 1))tex"}});
  checks.push_back({"contact",
                    "cards",
                    "A stack of cards",
                    "Three cards of 0.2 mm, with elements of 10 mm, fall onto one another.",
                    "The height of the stack is three times the thickness",
                    check_cards,
                    {},
                    {R"tex(H = 3 t)tex"}});
  checks.push_back({"contact",
                    "drop",
                    "A heavy cube falls by 5 mm",
                    "A cube of 1 m and 1 t, one cell, starts 5 mm above the floor.",
                    "Free fall, no rebound, rest on the floor",
                    check_drop,
                    {},
                    {R"tex(v_n = g h n, \quad 0 < d \le \frac{1}{5} d_0)tex"}});
}

}  // namespace aspic::verify
