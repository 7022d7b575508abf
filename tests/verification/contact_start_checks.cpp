// Default distance at which contact begins: gaps, clearances and thin parts that the user modeled.
#include <algorithm>
#include <cmath>

#include "mesh/generators.h"
#include "reference/statics.h"
#include "verification/contact_models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

constexpr double kGap = 1e-4;        // between surfaces at the start [m]
constexpr double kReach = kGap / 5;  // the default for this gap [m]
constexpr double kPressedBy = 9e-4;  // shortening of the block in the press [m]
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

// A cube of 0.1 m, nu = 0, under a plate that moves down by `travel` from `gap` above it. Returns the force [N].
double press_force(double gap, double travel, double young, Findings& found) {
  TouchingModel given{
      .bodies = {{make_box({{0, 0, 0}}, {{0.1, 0.1, 0.1}}, {6, 6, 6}), young}}, .material = "linear", .poisson = 0};
  given.walls = {{{{0, 0.1 + gap, 0}}, {{0, -1, 0}}, {{0, -travel, 0}}}};
  Model model = make_touching(given);
  const std::vector<int> bottom = vertices_where(model.mesh, [](const Vec3d& X) { return X[1] == 0; });
  model.pins.push_back({"bottom", bottom, {}});
  const Simulation simulation = equilibrium(std::move(model), 4, "press", 1e-10);
  if (travel > gap) expect_contact("gap " + std::to_string(1e3 * gap) + " mm: ", simulation, found);
  return sum_over(bottom, elastic_forces(simulation))[1];
}

void check_press(const Subject& subject, Findings& found) {
  const double young = 1e5 * subject.stiffness, exact = 1e5 * 0.01 * kPressedBy / 0.1;
  found.expect("force, plate 0.1 mm above the block",
               {press_force(kGap, kGap + kPressedBy, young, found), exact, exact * kReach / kPressedBy},
               "surfaces stay apart by at most the reach, a fifth of the gap: 2.2 % of the shortening", "N");
  found.expect_small("force of the plate at rest", press_force(kGap, 0, young, found), 1e-9,
                     "the reach is smaller than the gap", "N");
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
  Simulation simulation = simulate(make_touching(given), {.h = 0.01, .solver = {}});
  const double rise = largest_rise(simulation, subject.quick ? 50 : 300, "cube on the floor");
  expect_contact("", simulation, found);
  found.expect_small("rise above the start", rise, 1e-9, "nothing pushes at the start", "m");
  found.expect_small("gap at rest", lowest(simulation), kAbove / 5,
                     "at most the reach, a fifth of the gap at the start", "m");
}

}  // namespace

void add_contact_start_checks(std::vector<Check>& checks) {
  checks.push_back({"contact",
                    "press",
                    "A plate presses a block",
                    "A block of 0.1 m, E = 1e5 Pa, nu = 0. The plate starts 0.1 mm above it and shortens it by 0.9 mm.",
                    "F = E A 0.009, and no force of a plate that stays 0.1 mm away",
                    check_press,
                    {},
                    {R"tex(F = E A \frac{0.9}{100})tex"}});
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
                    "It rests on the floor",
                    check_drop,
                    {},
                    {R"tex(0 < d \le \frac{1}{5} d_0)tex"}});
}

}  // namespace aspic::verify
