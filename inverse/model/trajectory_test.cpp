#include "model/trajectory.h"

#include <cmath>

#include "base/error.h"
#include "dynamics/models_test.h"
#include "material/registry.h"
#include "model/taylor_test.h"

namespace aspic {
namespace {

using namespace testing_models;
using taylor::Numbers;

TrajectoryOptions exact() {
  TrajectoryOptions options;
  options.h = 0.02;
  options.steps = 8;
  options.tolerance = 1e-14;
  options.adjoint_tolerance = 1e-14;
  return options;
}

// A model with every kind of parameter: a beam of unlike tets with a wall, a crank that turns, a spring whose target
// moves, weight and three kinds of damping.
struct Swinging {
  std::string material = "mooney_rivlin";
  std::vector<MaterialParameters> elastic;
  std::vector<double> density, viscosity;
  double mass_factor = 2, stiffness_factor = 4e-3;
  State start;
  MassKind mass = MassKind::consistent;
  bool slides = false;  // the wall and the crank hold some directions only
  TetMesh mesh = make_box({{0, 0, 0}}, {{1.2, 0.4, 0.3}}, {5, 2, 1});

  explicit Swinging(const std::string& name = "mooney_rivlin") : material(name) {
    const MaterialInfo& info = material_info(name);
    for (int t = 0; t < mesh.tet_count(); ++t) {
      MaterialParameters p{lame_from_young_poisson(3e4 * (1 + 0.5 * std::sin(t)), 0.3 + 0.05 * std::cos(t)), {}};
      for (size_t k = 0; k < info.extra.size(); ++k)
        p.extra[k] = info.extra[k].fallback * (1 + 0.2 * std::sin(3.0 * t));
      elastic.push_back(p);
      density.push_back(1000 * (1 + 0.3 * std::cos(2.0 * t)));
      viscosity.push_back(60 * (1 + 0.5 * std::sin(5.0 * t)));
    }
    start = at_rest(mesh);
    const std::vector<double> noise = Numbers(2)(2 * start.q.size());
    for (size_t i = 0; i < start.q.size(); ++i) {
      if (mesh.rest[i / 3][0] > 1e-9) start.q[i] += 0.01 * noise[i];
      start.qdot[i] = 0.5 * noise[start.q.size() + i] * mesh.rest[i / 3][0];
    }
  }

  Model model() const {
    Model model = ModelBuilder(mesh)
                      .material(material, elastic)
                      .density(density)
                      .mass(mass)
                      .gravity({{1, -9.81, 0}})
                      .load(make_point_springs("pull", {{mesh.vertex_count() - 1, 500,
                                                         [](double t) {
                                                           return Vec3d{{1.5, 3 * t, 0.2}};
                                                         }}}))
                      .rayleigh_damping(mass_factor, stiffness_factor)
                      .pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
                      .pin("crank", std::vector{mesh.vertex_count() / 2},
                           [](const Vec3d& X, double t) {
                             return X + Vec3d{{0, 0.05 * std::sin(8 * t), 0}};
                           })
                      .build();
    model.damping.push_back(make_strain_rate_damping(mesh, 0, viscosity));
    if (slides) {
      model.pins[0].directions = {{{0.6, 0.8, 0}}, {{0, 0, 1}}};
      model.pins[1].directions = {{{0, 1, 0}}};
    }
    return model;
  }
};

// |q - rest|^2 / 2 + 0.02 |qdot|^2 / 2 at some points, more at the end.
TrajectoryObjective distance_from_rest(const TetMesh& mesh, int steps) {
  return
      [rest = at_rest(mesh).q, steps](int point, const State& state, std::span<double> qbar, std::span<double> vbar) {
        const double weight = point == steps ? 2 : point % 3 == 0 ? 1 : 0;
        double value = 0;
        for (size_t i = 0; i < rest.size(); ++i) {
          const double d = state.q[i] - rest[i], v = state.qdot[i];
          value += weight * (d * d + 0.02 * v * v) / 2;
          if (qbar.empty()) continue;
          qbar[i] += weight * d;
          vbar[i] += weight * 0.02 * v;
        }
        return value;
      };
}

double value_of(const Swinging& body, const TrajectoryOptions& options) {
  Trajectory trajectory(body.model(), body.start, options);
  const TrajectoryReport report = trajectory.simulate(distance_from_rest(body.mesh, options.steps));
  EXPECT_TRUE(report.ok) << report.message;
  return report.value;
}

TrajectoryGradient gradient_of(const Swinging& body, const TrajectoryOptions& options,
                               TrajectoryReport* out = nullptr) {
  Trajectory trajectory(body.model(), body.start, options);
  TrajectoryGradient gradient;
  const TrajectoryReport report = trajectory.differentiate(distance_from_rest(body.mesh, options.steps), gradient);
  EXPECT_TRUE(report.ok) << report.message;
  if (out) *out = report;
  return gradient;
}

// A change of all parameters of one kind by eps, and its rate by the gradient.
struct Kind {
  std::string name;
  std::function<void(Swinging&, double eps)> change;
  std::function<double(const TrajectoryGradient&)> slope;
  double largest = 0.1;
};

Kind elastic_kind(const std::string& name, const Swinging& body, int k) {
  const int count = 2 + static_cast<int>(material_info(body.material).extra.size());
  const std::vector<double> d = Numbers(6)(body.elastic.size());
  const auto of = [k](MaterialParameters& p) -> double& {
    return k == 0 ? p.lame.mu : k == 1 ? p.lame.lambda : p.extra[k - 2];
  };
  std::vector<double> rate(d.size());
  for (size_t t = 0; t < d.size(); ++t) {
    MaterialParameters p = body.elastic[t];
    rate[t] = (0.7 + 0.3 * d[t]) * of(p);
  }
  return {name,
          [=](Swinging& b, double eps) {
            for (size_t t = 0; t < rate.size(); ++t) of(b.elastic[t]) += eps * rate[t];
          },
          [=](const TrajectoryGradient& g) {
            double sum = 0;
            for (size_t t = 0; t < rate.size(); ++t) sum += g.elastic[t * count + k] * rate[t];
            return sum;
          }};
}

// The same for one of the vectors of the body.
Kind vector_kind(const std::string& name, const std::vector<double>& rate,
                 const std::function<std::vector<double>&(Swinging&)>& vector,
                 const std::function<const std::vector<double>&(const TrajectoryGradient&)>& gradient,
                 double largest = 0.1) {
  return {name,
          [=](Swinging& b, double eps) {
            for (size_t i = 0; i < rate.size(); ++i) vector(b)[i] += eps * rate[i];
          },
          [=](const TrajectoryGradient& g) { return dot(gradient(g), rate); }, largest};
}

std::vector<double> in_proportion(const std::vector<double>& to, unsigned seed) {
  std::vector<double> rate = Numbers(seed)(to.size());
  for (size_t i = 0; i < rate.size(); ++i) rate[i] = (0.7 + 0.3 * rate[i]) * to[i];
  return rate;
}

std::vector<Kind> all_kinds(const Swinging& body) {
  using Gradient = TrajectoryGradient;
  std::vector<double> dq = Numbers(7)(body.start.q.size()), dv = Numbers(8)(body.start.q.size());
  for (size_t i = 0; i < dq.size(); ++i) dq[i] *= 0.1, dv[i] *= 2;
  for (const Pin& pin : body.model().pins)
    for (const int v : pin.vertices) dq[3 * v] = dq[3 * v + 1] = dq[3 * v + 2] = 0;
  std::vector<Kind> kinds = {elastic_kind("mu", body, 0), elastic_kind("lambda", body, 1)};
  for (size_t k = 0; k < material_info(body.material).extra.size(); ++k)
    kinds.push_back(elastic_kind(material_info(body.material).extra[k].name, body, 2 + static_cast<int>(k)));
  kinds.push_back(vector_kind(
      "density", in_proportion(body.density, 9), [](Swinging& b) -> std::vector<double>& { return b.density; },
      [](const Gradient& g) -> const std::vector<double>& { return g.density; }));
  kinds.push_back(vector_kind(
      "viscosity", in_proportion(body.viscosity, 10), [](Swinging& b) -> std::vector<double>& { return b.viscosity; },
      [](const Gradient& g) -> const std::vector<double>& { return g.damping[1]; }));
  kinds.push_back({"mass damping", [](Swinging& b, double eps) { b.mass_factor *= 1 + 3 * eps; },
                   [&body](const Gradient& g) { return 3 * body.mass_factor * g.damping[0][0]; }});
  if (body.stiffness_factor > 0)
    kinds.push_back({"stiffness damping", [](Swinging& b, double eps) { b.stiffness_factor *= 1 + 3 * eps; },
                     [&body](const Gradient& g) { return 3 * body.stiffness_factor * g.damping[0][1]; }});
  kinds.push_back(vector_kind(
      "q0", dq, [](Swinging& b) -> std::vector<double>& { return b.start.q; },
      [](const Gradient& g) -> const std::vector<double>& { return g.q; }));
  kinds.push_back(vector_kind(
      "qdot0", dv, [](Swinging& b) -> std::vector<double>& { return b.start.qdot; },
      [](const Gradient& g) -> const std::vector<double>& { return g.qdot; }));
  return kinds;
}

void expect_slopes_2(const Swinging& body) {
  const TrajectoryGradient gradient = gradient_of(body, exact());
  for (const Kind& kind : all_kinds(body)) {
    const double slope = kind.slope(gradient);
    EXPECT_GT(std::abs(slope), 1e-6) << kind.name;
    taylor::expect_slope_2(
        [&](double eps) {
          Swinging changed = body;
          kind.change(changed, eps);
          return std::vector<double>{value_of(changed, exact())};
        },
        {slope}, kind.largest, body.material + ", " + kind.name);
  }
}

TEST(Trajectory, GradientHasTaylorSlope2ForEveryParameter) {
  expect_slopes_2(Swinging("mooney_rivlin"));
  expect_slopes_2(Swinging("fung"));
  expect_slopes_2(Swinging("corotated"));
  Swinging without_kinks("stable_neo_hookean");  // of the clamped matrix of damping
  without_kinks.stiffness_factor = 0;
  expect_slopes_2(without_kinks);
}

TEST(Trajectory, GradientWithRollersHasTaylorSlope2) {
  Swinging body;
  body.slides = true;
  expect_slopes_2(body);
}

TEST(Trajectory, LumpedMassDensityGradientHasTaylorSlope2) {
  Swinging body;
  body.mass = MassKind::lumped;
  const TrajectoryGradient gradient = gradient_of(body, exact());
  for (const Kind& kind : all_kinds(body))
    if (kind.name == "density")
      taylor::expect_slope_2(
          [&](double eps) {
            Swinging changed = body;
            kind.change(changed, eps);
            return std::vector<double>{value_of(changed, exact())};
          },
          {kind.slope(gradient)}, kind.largest, kind.name);
}

TEST(Trajectory, GradientIsBitReproducibleForAnyStoredStates) {
  const Swinging body;
  TrajectoryOptions options = exact();
  options.steps = 13;
  options.stored_states = 13;
  TrajectoryReport report;
  const TrajectoryGradient all = gradient_of(body, options, &report);
  EXPECT_EQ(report.steps, 13);
  for (const int stored : {1, 2, 3}) {
    options.stored_states = stored;
    const TrajectoryGradient few = gradient_of(body, options, &report);
    EXPECT_GT(report.steps, 13);
    EXPECT_EQ(all.elastic, few.elastic);
    EXPECT_EQ(all.density, few.density);
    EXPECT_EQ(all.damping, few.damping);
    EXPECT_EQ(all.q, few.q);
    EXPECT_EQ(all.qdot, few.qdot);
  }
}

TEST(Trajectory, AgreesWithSimulation) {
  const Swinging body;
  const TrajectoryOptions options = exact();
  SimulationOptions same{.h = options.h, .solver = {}};
  same.solver.minimize.tolerance = options.tolerance;
  Simulation simulation(body.model(), body.start, same);
  Trajectory trajectory(body.model(), body.start, options);
  const TrajectoryReport report =
      trajectory.simulate([&](int point, const State& state, std::span<double>, std::span<double>) {
        double largest = 0;
        for (size_t i = 0; i < state.q.size(); ++i)
          largest = std::max(largest, std::abs(state.q[i] - simulation.state().q[i]));
        EXPECT_LE(largest, 1e-12) << point;
        EXPECT_EQ(state.time, simulation.state().time);
        if (point < options.steps) simulation.step();
        return 1.0;
      });
  EXPECT_TRUE(report.ok);
  EXPECT_EQ(report.value, options.steps + 1);
}

TEST(Trajectory, AdjointStepTakesOneSolveWithKeptFactor) {
  const Swinging body;
  TrajectoryOptions options;
  options.h = 0.02;
  options.steps = 10;
  options.linear = options.adjoint = "cholesky";
  TrajectoryReport report;
  gradient_of(body, options, &report);
  EXPECT_EQ(report.adjoint_solves, options.steps);
  EXPECT_GE(report.newton_iterations, 3 * report.adjoint_solves);
  EXPECT_LE(2 * report.adjoint_factorizations, report.adjoint_solves);
  EXPECT_LE(report.adjoint_iterations, 8 * report.adjoint_solves);
  EXPECT_EQ(report.steps, options.steps);
}

TEST(Trajectory, UnconvergedStepIsReported) {
  const Swinging body;
  TrajectoryOptions options;
  options.max_iterations = 1;
  Trajectory trajectory(body.model(), body.start, options);
  TrajectoryGradient gradient;
  const TrajectoryReport report = trajectory.differentiate(distance_from_rest(body.mesh, options.steps), gradient);
  EXPECT_FALSE(report.ok);
  EXPECT_NE(report.message.find("step 0): Newton's method did not converge"), std::string::npos) << report.message;
}

TEST(Trajectory, RefusesModelsWithoutGradient) {
  const Swinging body;
  const auto refused = [&](TrajectoryOptions options, Model model, const std::string& expected) {
    try {
      const Trajectory trajectory(std::move(model), body.start, options);
      FAIL() << expected;
    } catch (const InvalidInput& e) {
      EXPECT_NE(std::string(e.what()).find(expected), std::string::npos) << e.what();
    }
  };
  for (const std::string& integrator : integrator_names())
    if (integrator != "backward_euler") refused({.integrator = integrator}, body.model(), integrator);
  refused({.h = 0}, body.model(), "must be positive");
  refused({.stored_states = 0}, body.model(), "stored_states");
  Model strange = body.model();
  strange.damping.push_back(make_linear_load("wind", std::vector<double>(body.start.q.size())));
  refused({}, std::move(strange), "'wind' has no derivatives");
}

TEST(Trajectory, LoadOtherThanWeightHasNoDensityGradient) {
  const Swinging body;
  Model model = body.model();
  std::vector<double> force(body.start.q.size());
  force[7] = 1;
  model.loads[0] = make_linear_load("gravity", force);
  TrajectoryOptions options = exact();
  Trajectory trajectory(std::move(model), body.start, options);
  TrajectoryGradient gradient;
  EXPECT_TRUE(trajectory.differentiate(distance_from_rest(body.mesh, options.steps), gradient).ok);
  EXPECT_TRUE(gradient.density.empty());
}

}  // namespace
}  // namespace aspic
