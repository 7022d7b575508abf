// Pages 10 to 22: finite differences of q, and the time at which dV/dq is evaluated.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "mesh/surface.h"

namespace aspic::cli::lecture {
namespace {

// Motion of all vertices with known derivatives: x_r = X_r cos(w_r t) + X_(r+1) sin(w_r t).
struct KnownMotion {
  const TetMesh& mesh;

  // k-th derivative of q at t.
  Vector derivative(int k, double t) const {
    constexpr std::array<double, 3> w = {3, 4, 5};  // [rad/s]
    Vector q;
    for (const Vec3d& X : mesh.rest)
      for (int r = 0; r < 3; ++r) {
        const double phase = w[r] * t + k * M_PI / 2;
        q.push_back(std::pow(w[r], k) * (X[r] * std::cos(phase) + X[(r + 1) % 3] * std::sin(phase)));
      }
    return q;
  }
};

struct DifferenceErrors {
  Vector h, first, second, second_ahead;
};

DifferenceErrors errors_of_differences(const KnownMotion& motion, double t) {
  DifferenceErrors errors;
  const Vector q = motion.derivative(0, t), qdot = motion.derivative(1, t), qddot = motion.derivative(2, t);
  for (const double h : {0.008, 0.004, 0.002, 0.001}) {
    const Vector before = motion.derivative(0, t - h), after = motion.derivative(0, t + h);
    const Vector first = scaled(plus(q, -1, before), 1 / h);
    const Vector second = scaled(plus(plus(after, -2, q), 1, before), 1 / (h * h));
    errors.h.push_back(h);
    errors.first.push_back(max_abs(plus(first, -1, qdot)));
    errors.second.push_back(max_abs(plus(second, -1, qddot)));
    errors.second_ahead.push_back(max_abs(plus(second, -1, motion.derivative(2, t + h))));
  }
  return errors;
}

void check_orders(const DifferenceErrors& e, Sheet& sheet) {
  CsvFile table = sheet.table("orders.csv", {"h_s", "first_m_s", "second_m_s2", "second_at_next_m_s2"});
  for (size_t i = 0; i < e.h.size(); ++i)
    table.append(CsvRow().add(e.h[i]).add(e.first[i]).add(e.second[i]).add(e.second_ahead[i]));
  const std::string why = "Taylor's expansion; the next term is a few per cent at these h";
  sheet.at_most("order of (q_i - q_(i-1)) / h, distance from 1", std::abs(observed_order(e.h, e.first) - 1), 0.05, "",
                why);
  sheet.at_most("order of (q_(i+1) - 2 q_i + q_(i-1)) / h^2 at t_i, distance from 2",
                std::abs(observed_order(e.h, e.second) - 2), 0.05, "", why);
  sheet.at_most("order of the same as q'' at t_(i+1), distance from 1",
                std::abs(observed_order(e.h, e.second_ahead) - 1), 0.05, "", why);
  sheet.draw("orders.svg", "Errors of the differences of a motion that is known",
             Chart{"order of accuracy",
                   {"h [s]", AxisScale::logarithmic},
                   {"largest error [m/s, m/s^2]", AxisScale::logarithmic},
                   {{"qdot", e.h, e.first, SeriesStyle::line_and_points},
                    {"q'' at t_i", e.h, e.second, SeriesStyle::line_and_points},
                    {"q'' at t_(i+1)", e.h, e.second_ahead, SeriesStyle::line_and_points}}});
}

}  // namespace

void show_differences(const Stage& stage, Sheet& sheet) {
  Scene scene = stage.on_real_mesh("05_swing");
  sheet.keep(scene);
  check_orders(errors_of_differences({scene.simulation.model().mesh}, 0.3), sheet);

  for (int i = 0; i < 3; ++i) scene.simulation.step();
  const Vector previous = scene.simulation.state().q;
  scene.simulation.step();
  OpenStep step(std::move(scene));
  const Vector from_positions = plus(scaled(step.q_t, 2), -1, previous);
  const Vector from_velocity = plus(step.q_t, step.h, step.qdot);
  const Vector misprint = plus(step.q_t, -step.h, step.qdot);
  const double error = max_abs(plus(from_velocity, -1, from_positions));
  sheet.at_most("|(q_i + h qdot_i) - (2 q_i - q_(i-1))|", error, 4 * kEpsilon * max_abs(step.q_t), "m",
                "four roundings of numbers of the size of q");
  sheet.at_least("|(q_i - h qdot_i) - (2 q_i - q_(i-1))|, the misprinted sign",
                 max_abs(plus(misprint, -1, from_positions)), 1e-4, "m", "it is off by 2 h qdot");
  sheet.show("2 h |qdot_i|", 2 * step.h * max_abs(step.qdot), "m");

  const Vector ghost = step.predicted, now = step.q_t;
  const StepReport report = step.scene.simulation.step();
  const Vector r = step.residual(step.scene.simulation.state().q);
  sheet.at_most("|M (q_(i+1) - q~) / h^2 + dV/dq(q_(i+1))| of the step", norm(r) / (step.h * step.h),
                report.residual_threshold, "N", "tolerance of the step");
  std::vector<double> ahead;
  for (size_t i = 0; i < now.size(); i += 3)
    ahead.push_back(1e3 * std::hypot(ghost[i] - now[i], ghost[i + 1] - now[i + 1], ghost[i + 2] - now[i + 2]));
  const TriMesh now_surface = surface_at(step.model(), now), ghost_surface = surface_at(step.model(), ghost);
  std::vector<double> on_surface;
  for (const int v : boundary_surface(step.model().mesh).tet_vertex) on_surface.push_back(ahead[v]);
  sheet.draw("ghost.png", "q_i, and q~ where the body would fly without forces, colored by how far that is",
             MeshPicture{.panels = {{"q_i", now_surface, std::vector<double>(on_surface.size(), 0.0)},
                                    {"q~", ghost_surface, on_surface}},
                         .eye = {{0.4, 0.3, 1}},
                         .up = {{0, 1, 0}},
                         .value_label = "|q~ - q_i| [mm]"});
}

namespace {

constexpr int kComparedSteps = 60;

struct Trajectory {
  Vector time, tip;       // [s], [m]
  Vector at_old, at_new;  // |M (q_(i+1) - q~)/h^2 + dV/dq| with dV/dq at q_i and at q_(i+1), of each step [N]
  double threshold = 0;   // threshold of the steps [N]
  double noise = 0;       // round-off of M (q_(i+1) - q~)/h^2: four roundings of q, over h^2, times masses [N]
};

Trajectory follow(Scene scene, int tip) {
  Simulation& simulation = scene.simulation;
  const Model& model = simulation.model();
  const Pins pins(model.pins, simulation.state().q);
  const double h = simulation.options().h;
  Trajectory path;
  path.noise = 4 * kEpsilon * max_abs(simulation.state().q) / (h * h) *
               norm(mass_times(model, Vector(simulation.state().q.size(), 1.0)));
  for (int i = 0; i < kComparedSteps; ++i) {
    const State old = simulation.state();
    const StepReport report = simulation.step();
    const Vector& q = simulation.state().q;
    const Vector inertia = mass_times(model, scaled(plus(q, -1, plus(old.q, h, old.qdot)), 1 / (h * h)));
    Vector old_balance = plus(inertia, 1, gradient_of_potential(model, old.q));
    Vector new_balance = plus(inertia, 1, gradient_of_potential(model, q));
    pins.set_zero(old_balance);
    pins.set_zero(new_balance);
    path.time.push_back(report.time);
    path.tip.push_back(q[3 * tip]);
    path.at_old.push_back(norm(old_balance));
    path.at_new.push_back(norm(new_balance));
    path.threshold = std::max(path.threshold, report.residual_threshold);
  }
  return path;
}

int highest_vertex(const TetMesh& mesh) {
  const auto lower = [](const Vec3d& a, const Vec3d& b) { return a[1] < b[1]; };
  return static_cast<int>(std::max_element(mesh.rest.begin(), mesh.rest.end(), lower) - mesh.rest.begin());
}

}  // namespace

void show_explicit_or_implicit(const Stage& stage, Sheet& sheet) {
  const std::string h = "time.step=1e-4";
  Scene scene = stage.on_real_mesh("05_swing", {h, "time.integrator=symplectic_euler"});
  sheet.keep(scene);
  const int tip = highest_vertex(scene.simulation.model().mesh);
  const Trajectory a = follow(std::move(scene), tip);
  const Trajectory b = follow(stage.on_real_mesh("05_swing", {h}), tip);
  CsvFile table = sheet.table("tip.csv", {"time_s", "explicit_m", "implicit_m", "explicit_at_old_N",
                                          "explicit_at_new_N", "implicit_at_old_N", "implicit_at_new_N"});
  for (size_t i = 0; i < a.time.size(); ++i)
    table.append(CsvRow()
                     .add(a.time[i])
                     .add(a.tip[i])
                     .add(b.tip[i])
                     .add(a.at_old[i])
                     .add(a.at_new[i])
                     .add(b.at_old[i])
                     .add(b.at_new[i]));
  sheet.remark("time.integrator switches: symplectic_euler takes dV/dq at q_i, backward_euler at q_(i+1).");
  sheet.at_most("explicit: |M q'' + dV/dq(q_i)|", max_abs(a.at_old), a.noise, "N",
                "M times four roundings of q over h^2, as q'' comes from three positions");
  sheet.at_least("explicit: the same with q_(i+1) / with q_i", max_abs(a.at_new) / max_abs(a.at_old), 1e3, "",
                 "it is not the implicit equation");
  sheet.at_most("implicit: |M q'' + dV/dq(q_(i+1))|", max_abs(b.at_new), b.threshold + b.noise, "N",
                "tolerance of the steps");
  sheet.at_least("implicit: the same with q_i / with q_(i+1)", max_abs(b.at_old) / max_abs(b.at_new), 1e3, "",
                 "it is not the explicit equation");
  sheet.show("largest difference of the tip", max_abs(plus(a.tip, -1, b.tip)), "m", "both are of first order in h");
  sheet.draw("tip.svg", "The highest vertex, sideways; same start, same h",
             Chart{"explicit or implicit",
                   {"time [s]"},
                   {"x of the tip [m]"},
                   {{"explicit", a.time, a.tip}, {"implicit", b.time, b.tip, SeriesStyle::dashed}}});
}

}  // namespace aspic::cli::lecture
