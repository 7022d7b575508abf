// Compares bodies in contact with a plane with analytic solutions.
#include "dynamics/contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "dynamics/model_builder.h"
#include "dynamics/simulation.h"
#include "mesh/generators.h"
#include "mesh/self_intersection.h"
#include "mesh/surface.h"

namespace aspic {
namespace {

constexpr double kYoung = 1e6;

ModelBuilder block(const Vec3d& gravity, double gap = 0.001) {
  ModelBuilder builder(make_box({{-0.05, gap, -0.05}}, {{0.05, gap + 0.05, 0.05}}, {4, 2, 4}), "block");
  builder.material("neo_hookean", {.young = kYoung, .poisson = 0.3}).density(1000).gravity(gravity);
  return builder;
}

// A block above the plane y = 0.
struct PlaneScene {
  double creep = 0, gap = 0.001;
  Motion motion = {};  // motion of the plane
  std::string integrator = "backward_euler";
};

Simulation above_plane(const Vec3d& gravity, double friction, double h, const PlaneScene& given = {}) {
  Model model = block(gravity, given.gap).build();
  ContactMesh contact;
  std::vector<int> rows(model.mesh.rest.size());
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  const std::vector<Triangle> surface = boundary_triangles(model.mesh, 0, model.mesh.tet_count());
  contact.add({.name = "block", .young = kYoung, .friction = friction}, model.mesh.rest, surface, rows);
  ContactPart floor{.name = "floor", .friction = friction};
  if (given.motion)
    floor.motion = [motion = given.motion](double time, std::span<const Vec3d> start, std::span<Vec3d> x) {
      for (size_t i = 0; i < x.size(); ++i) x[i] = motion(start[i], time);
    };
  contact.add_plane(floor, {}, {{0, 1, 0}});
  add_contact(std::move(contact), {}, given.creep, model);
  SimulationOptions options;
  options.h = h;
  options.integrator = given.integrator;
  return Simulation(std::move(model), options);
}

Vec3d center(const Simulation& simulation, std::span<const double> q) {
  const std::vector<double> w = weights(*simulation.model().mass, {{1, 0, 0}});
  Vec3d sum{};
  double mass = 0;
  for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v) {
    sum = sum + w[3 * v] * point(q, v);
    mass += w[3 * v];
  }
  return (1 / mass) * sum;
}

void expect_rest_above_plane(const std::string& integrator) {
  SCOPED_TRACE(integrator);
  Simulation simulation = above_plane({{0, -9.81, 0}}, 0.5, 0.01, {.integrator = integrator});
  StepReport report;
  double lowest = INFINITY, dissipated = 0, work = 0;
  const double start = simulation.start_report().potential_total + simulation.kinetic_energy();
  for (int i = 0; i < 60; ++i) {
    report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
    for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v)
      lowest = std::min(lowest, simulation.state().q[3 * v + 1]);
    dissipated += report.damping_loss + report.numerical_loss;
    work += report.residual_work;
    EXPECT_GT(report.numerical_loss, -1e-6 * (start - report.potential_total)) << i;
  }
  EXPECT_GT(lowest, 0);
  EXPECT_LT(report.kinetic, 1e-8);
  EXPECT_EQ(report.contacts, 25);
  EXPECT_GT(report.min_gap, 0);
  // Pressure of the weight, up to quadrature errors near the border.
  EXPECT_NEAR(report.max_pressure, 1000 * 9.81 * 0.05, 300);
  // The ledger is balanced with friction and contact.
  EXPECT_NEAR(start, report.potential_total + report.kinetic + dissipated - work, 1e-9 * std::abs(start));
}

TEST(Contact, FallingBlockComesToRestAbovePlane) {
  for (const char* integrator : {"backward_euler", "bdf2"}) expect_rest_above_plane(integrator);
}

// The block slides with a = g (sin - mu cos) [backward Euler: x_n = a h^2 n (n + 1) / 2], or sticks.
void expect_slides_or_sticks(const std::string& integrator) {
  SCOPED_TRACE(integrator);
  const double mu = 0.5, h = 0.01, g = 9.81;
  for (const double tangent : {0.45, 0.55}) {
    const double angle = std::atan(tangent);
    const double along = g * std::sin(angle), down = g * std::cos(angle);
    Simulation simulation = above_plane({{along, -down, 0}}, mu, h, {.integrator = integrator});
    std::vector<double> x;
    for (int i = 0; i < 100; ++i) {
      const StepReport report = simulation.step();
      ASSERT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
      x.push_back(center(simulation, simulation.state().q)[0]);
    }
    const double creep = 1e-4 * std::sqrt(g * 0.15);
    if (tangent < mu) {
      EXPECT_LT(std::abs(x[99] - x[49]), creep * 0.5);
    }
    const double a = g * (std::sin(angle) - mu * std::cos(angle));
    if (tangent > mu) {
      EXPECT_NEAR((x[99] - 2 * x[79] + x[59]) / 0.04, a, 0.01 * a);
    }
  }
}

TEST(Contact, BlockOnInclineSlidesOrSticks) {
  for (const char* integrator : {"backward_euler", "bdf2"}) expect_slides_or_sticks(integrator);
}

TEST(Contact, RejectsOtherIntegratorsWithAlternatives) {
  for (const char* integrator : {"tr_bdf2", "midpoint", "rk4"}) {
    try {
      above_plane({}, 0, 0.01, {.integrator = integrator});
      FAIL() << "accepted " << integrator;
    } catch (const InvalidInput& e) {
      EXPECT_NE(std::string(e.what()).find("choose backward_euler, bdf2"), std::string::npos) << e.what();
    }
  }
}

// The block falls, slides and is dragged by the plane.
TEST(Contact, Bdf2ContinuesFromSnapshotWithEqualBits) {
  const PlaneScene rising{.motion =
                              [](const Vec3d& x, double t) {
                                return x + Vec3d{{0.3 * t, 0.5 * t * t, 0}};
                              },
                          .integrator = "bdf2"};
  Simulation whole = above_plane({{0.5, -9.81, 0}}, 0.3, 0.005, rising);
  for (int i = 0; i < 12; ++i) whole.step();
  Simulation resumed = above_plane({{0.5, -9.81, 0}}, 0.3, 0.005, rising);
  resumed.restore(whole.snapshot());
  for (int i = 0; i < 12; ++i) {
    const StepReport expected = whole.step(), report = resumed.step();
    EXPECT_TRUE(is_success(expected.status)) << i;
    EXPECT_EQ(report.state_hash, expected.state_hash) << i;
  }
}

// The barrier of the initial gap is 1e6 times stiffer than the block, and vanishes after it has thrown off the block.
TEST(Contact, TinyInitialGapKeepsThresholds) {
  Simulation simulation = above_plane({{0, -9.81, 0}}, 0, 0.01, {.gap = 1e-9});
  const double weight = 1000 * 9.81 * 0.1 * 0.05 * 0.1;
  StepReport report;
  for (int i = 0; i < 100; ++i) {
    report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
    if (i > 0) {
      ASSERT_LT(report.residual_threshold, 1e-3 * weight) << i;
    }
  }
  EXPECT_NEAR(report.max_pressure, 1000 * 9.81 * 0.05, 300);
}

// A belt accelerates the block with mu g to its speed; friction dissipates half of the work of the belt. With bdf2,
// forces of an impact count less in the motion than in the work, so the block falls from a smaller height.
void expect_drag(const std::string& integrator, double gap, double round_off) {
  SCOPED_TRACE(integrator);
  constexpr double mu = 0.5, g = 9.81, speed = 0.4;
  const Motion moving = [](const Vec3d& start, double time) { return start + Vec3d{{speed * time, 0, 0}}; };
  Simulation simulation = above_plane({{0, -g, 0}}, mu, 0.01, {.gap = gap, .motion = moving, .integrator = integrator});
  const double start = simulation.start_report().potential_total + simulation.kinetic_energy();
  double sum = start, belt = 0;
  for (int i = 0; i < 60; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
    belt += report.obstacle_work;
    sum += report.obstacle_work + report.residual_work - report.damping_loss - report.numerical_loss;
    EXPECT_NEAR(sum, report.potential_total + report.kinetic, 1e-9 * std::abs(start)) << i;
    EXPECT_GE(report.friction_loss, -round_off);
  }
  const Vec3d v = center(simulation, simulation.state().qdot);
  EXPECT_NEAR(v[0], speed, 0.01 * speed);
  const double mass = 1000 * 0.1 * 0.05 * 0.1;
  EXPECT_NEAR(belt, mass * speed * speed, 0.05 * mass * speed * speed);
}

TEST(Contact, MovingPlaneDragsBlockWithBalancedLedger) {
  expect_drag("backward_euler", 1e-3, 1e-12);
  expect_drag("bdf2", 1e-4, 1e-5);
}

TEST(Contact, RisingPlaneLiftsBlock) {
  Simulation simulation = above_plane({{0, -9.81, 0}}, 0, 0.01, {.motion = [](const Vec3d& start, double time) {
                                        return start + Vec3d{{0, 0.5 * time, 0}};
                                      }});
  for (int i = 0; i < 30; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
    for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v)
      ASSERT_GT(simulation.state().q[3 * v + 1], 0.5 * report.time);
  }
  EXPECT_NEAR(center(simulation, simulation.state().qdot)[1], 0.5, 0.1);
}

// A pinned body blocks the plane, which stays at its position when later steps retry.
// The plane pushes the block within a step. A stop at any poll drops the step or changes nothing.
TEST(Contact, InterruptedStepIsRepeatedWithEqualBits) {
  const PlaneScene rising{.motion = [](const Vec3d& x, double t) { return x + Vec3d{{0, 0.5 * t, 0}}; }};
  Simulation whole = above_plane({{0, -9.81, 0}}, 0.5, 0.01, rising);
  Simulation limited = above_plane({{0, -9.81, 0}}, 0.5, 0.01, rising);
  int dropped = 0;
  for (int step = 0; step < 4; ++step) {
    const StepReport expected = whole.step();
    for (int polls = 0;; ++polls) {
      ASSERT_LT(polls, 10000);
      int left = polls;
      const StepReport report = limited.step({}, StopToken([&left] { return left-- <= 0; }));
      if (report.status == Status::interrupted) {
        ++dropped;
        continue;
      }
      EXPECT_EQ(report.status, expected.status) << polls;
      EXPECT_EQ(report.state_hash, expected.state_hash) << polls;
      break;
    }
  }
  EXPECT_GT(dropped, 40);
}

TEST(Contact, BlockedObstacleEndsUndefinedUntilItReturns) {
  Model model = block({}).build();
  std::vector<int> rows(model.mesh.rest.size());
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  model.pins.push_back({"all", rows, {}});
  ContactMesh contact;
  contact.add({.name = "block", .young = kYoung}, model.mesh.rest,
              boundary_triangles(model.mesh, 0, model.mesh.tet_count()), rows);
  const auto jump = [](double time, std::span<const Vec3d> start, std::span<Vec3d> x) {
    const double rise = time < 0.035 ? 100 * time : -0.01;
    for (size_t i = 0; i < x.size(); ++i) x[i] = start[i] + Vec3d{{0, rise, 0}};
  };
  const TetMesh plate = make_box({{-0.2, -0.1, -0.2}}, {{0.2, -0.05, 0.2}}, {1, 1, 1});
  contact.add({.name = "plate", .is_obstacle = true, .motion = jump}, plate.rest,
              boundary_triangles(plate, 0, plate.tet_count()), {});
  add_contact(std::move(contact), {}, 0, model);
  SimulationOptions options;
  options.h = 0.01;
  Simulation simulation(std::move(model), options);
  for (int i = 0; i < 3; ++i) {
    const StepReport report = simulation.step();
    EXPECT_EQ(report.status, Status::undefined);
    EXPECT_EQ(simulation.obstacle_time(), 0);
    EXPECT_EQ(report.carries == 1, i > 0) << report.carries;  // later steps do not try as hard
  }
  const StepReport report = simulation.step();
  EXPECT_TRUE(is_success(report.status)) << to_string(report.status);
  EXPECT_EQ(simulation.obstacle_time(), report.time);
}

// The gap is a thousandth of the way of the plate in a step, and the block is free.
TEST(Contact, FastObstacleCarriesFreeBlock) {
  Model model = block({}).build();
  std::vector<int> rows(model.mesh.rest.size());
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  ContactMesh contact;
  contact.add({.name = "block", .young = kYoung}, model.mesh.rest,
              boundary_triangles(model.mesh, 0, model.mesh.tet_count()), rows);
  const auto rise = [](double time, std::span<const Vec3d> start, std::span<Vec3d> x) {
    for (size_t i = 0; i < x.size(); ++i) x[i] = start[i] + Vec3d{{0, 200 * time, 0}};
  };
  double lowest = INFINITY;
  for (const Vec3d& X : model.mesh.rest) lowest = std::min(lowest, X[1]);
  const TetMesh plate = make_box({{-0.2, lowest - 0.052, -0.2}}, {{0.2, lowest - 0.002, 0.2}}, {1, 1, 1});
  contact.add({.name = "plate", .is_obstacle = true, .motion = rise}, plate.rest,
              boundary_triangles(plate, 0, plate.tet_count()), {});
  add_contact(std::move(contact), {}, 0, model);
  Simulation simulation(std::move(model), {.h = 0.01, .solver = {}});
  for (int i = 1; i <= 3; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
    EXPECT_EQ(simulation.obstacle_time(), report.time);
  }
}

// Two blocks above a floor; the upper one is tilted, so that an edge hits first.
Simulation colliding_blocks(double friction, const SolverOptions& solver) {
  TetMesh mesh = make_box({{-0.05, 0.01, -0.05}}, {{0.05, 0.06, 0.05}}, {3, 2, 3});
  TetMesh other = make_box({{-0.05, 0.2, -0.05}}, {{0.05, 0.25, 0.05}}, {4, 2, 4});
  const int first = mesh.vertex_count();
  for (const Vec3d& X : other.rest)
    mesh.rest.push_back({{0.8 * X[0] + 0.6 * X[1] - 0.13, 0.8 * X[1] - 0.6 * X[0], X[2] + 0.02 * X[0] / 0.05}});
  for (const Tet& t : other.tets) mesh.tets.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
  ModelBuilder builder(mesh, "blocks");
  builder.material("neo_hookean", {.young = 2e4, .poisson = 0.4}).density(1000).gravity({{0, -9.81, 0}});
  Model model = builder.build();
  std::vector<int> rows(mesh.rest.size());
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  ContactMesh contact;
  contact.add({.name = "blocks", .young = 2e4, .friction = friction}, mesh.rest,
              boundary_triangles(mesh, 0, mesh.tet_count()), rows);
  contact.add_plane({.name = "floor", .friction = friction}, {}, {{0, 1, 0}});
  add_contact(std::move(contact), {}, 0, model);
  State start = at_rest(model.mesh);
  for (size_t v = first; v < mesh.rest.size(); ++v) start.qdot[3 * v + 1] = -4;
  return Simulation(std::move(model), start, {.h = 0.01, .solver = solver});
}

// The intersection test is exact and shares no code with contact.
TEST(Contact, CollidingBlocksNeverIntersect) {
  Simulation simulation = colliding_blocks(0, {});
  const TetMesh& mesh = simulation.model().mesh;
  TriMesh surface{mesh.rest, boundary_triangles(mesh, 0, mesh.tet_count())};
  int contacts = 0;
  for (int i = 0; i < 40; ++i) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
    contacts += report.contacts;
    for (size_t v = 0; v < surface.vertices.size(); ++v) {
      surface.vertices[v] = point(simulation.state().q, static_cast<int>(v));
      ASSERT_GT(surface.vertices[v][1], 0) << i;
    }
    ASSERT_TRUE(self_intersections(surface).pairs.empty()) << i;
  }
  EXPECT_GT(contacts, 100);
}

// Normal forces are updated once more where the direction is short, so that the criterion can hold.
TEST(Contact, VelocityCriterionEndsStepsWithFriction) {
  SolverOptions solver;
  solver.minimize.criterion = Criterion::velocity;
  solver.minimize.tolerance = 1e-3;
  Simulation simulation = colliding_blocks(0.3, solver);
  for (int i = 0; i < 40; ++i) {
    const StepReport report = simulation.step();
    EXPECT_TRUE(is_success(report.status)) << i << " " << to_string(report.status);
    EXPECT_LT(report.iterations, 100) << i;
  }
}

TEST(Contact, RejectsIntersectingInitialState) {
  Model model = block({}).build();
  ContactMesh contact;
  std::vector<int> rows(model.mesh.rest.size());
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<int>(i);
  contact.add({.name = "block", .young = kYoung}, model.mesh.rest,
              boundary_triangles(model.mesh, 0, model.mesh.tet_count()), rows);
  const TetMesh box = make_box({{0, 0, 0}}, {{0.2, 0.2, 0.2}}, {1, 1, 1});
  contact.add({.name = "ledge", .is_obstacle = true}, box.rest, boundary_triangles(box, 0, box.tet_count()), {});
  add_contact(std::move(contact), {}, 0, model);
  try {
    const Simulation simulation(std::move(model), SimulationOptions());
    FAIL() << "accepted";
  } catch (const InvalidInput& e) {
    EXPECT_NE(std::string(e.what()).find("block and ledge"), std::string::npos) << e.what();
  }
}

TEST(Contact, RejectsGapBelowRoundOff) {
  EXPECT_THROW(above_plane({}, 0, 0.01, {.gap = 1e-15}), InvalidInput);
  EXPECT_NO_THROW(above_plane({}, 0, 0.01, {.gap = 1e-12}));
}

TEST(Contact, ReportsAreEmptyWithoutContact) {
  SimulationOptions options;
  Simulation simulation(block({}).build(), options);
  const StepReport report = simulation.step();
  EXPECT_EQ(report.contacts, 0);
  EXPECT_EQ(report.min_gap, 0);
  EXPECT_EQ(report.friction_loss, 0);
}

}  // namespace
}  // namespace aspic
