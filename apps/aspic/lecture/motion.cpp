// Pages 5 to 10: equation of motion of finite elements, and of masses and springs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/lecture/course.h"
#include "aspic/lecture/run_scene.h"
#include "energy/springs.h"

namespace aspic::cli::lecture {
namespace {

struct SlopeCheck {
  Vector step, error;  // relative error of the central difference, and its width [m]
};

// Compares (V(q + s d) - V(q - s d)) / 2s with d'dV/dq.
SlopeCheck check_slope(const Model& model, const Vector& q, const Vector& d) {
  const double exact = dot(gradient_of_potential(model, q), d);
  SlopeCheck check;
  for (int k = 2; k <= 11; ++k) {
    const double s = std::pow(10, -0.5 * k);
    const double difference = potential(model, plus(q, s, d)) - potential(model, plus(q, -s, d));
    check.step.push_back(s);
    check.error.push_back(std::abs(difference / (2 * s) - exact) / std::abs(exact));
  }
  return check;
}

// The four highest vertices and the positions of their entries in q.
void write_stacked(const Sheet& sheet, const Model& model, const Vector& q) {
  std::vector<int> order(model.mesh.vertex_count());
  for (size_t v = 0; v < order.size(); ++v) order[v] = static_cast<int>(v);
  const size_t few = std::min<size_t>(4, order.size());
  std::partial_sort(order.begin(), order.begin() + few, order.end(),
                    [&](int a, int b) { return model.mesh.rest[a][1] > model.mesh.rest[b][1]; });
  CsvFile table = sheet.table("entries_of_q.csv", {"vertex", "first_entry", "x_m", "y_m", "z_m"});
  for (size_t k = 0; k < few; ++k) {
    const int v = order[k], name = model.numbering.vertex.to_user(v);
    table.append(CsvRow().add(name).add(3 * name).add(q[3 * v]).add(q[3 * v + 1]).add(q[3 * v + 2]));
  }
}

}  // namespace

void show_equation_of_motion(const Stage& stage, Sheet& sheet) {
  OpenStep step(stage.on_real_mesh("05_swing"));
  sheet.keep(step.scene);
  const Model& model = step.model();
  sheet.show("vertices", model.mesh.vertex_count(), "");
  sheet.show("tets", model.mesh.tet_count(), "");
  sheet.equals("entries of q", static_cast<double>(step.q_t.size()), 3.0 * model.mesh.vertex_count(), "",
               "three for each vertex, one vertex after another");
  write_stacked(sheet, model, step.q_t);

  const Vector d = smooth_direction(step);
  const SlopeCheck check = check_slope(model, step.q_t, d);
  CsvFile table = sheet.table("gradient.csv", {"width_m", "relative_error"});
  for (size_t i = 0; i < check.step.size(); ++i) table.append(CsvRow().add(check.step[i]).add(check.error[i]));
  const Vector two_steps(check.step.begin(), check.step.begin() + 3);
  sheet.at_most("order of the error of dV/dq, distance from 2",
                std::abs(observed_order(two_steps, {check.error.begin(), check.error.begin() + 3}) - 2), 0.1, "",
                "central differences are of second order; the next term is 1 % here");
  sheet.at_most("dV/dq against differences of V, relative", *std::min_element(check.error.begin(), check.error.end()),
                1e-8, "", "the best width has two thirds of the 16 digits; the sum over the tets loses more");

  // One explicit step yields the acceleration used by the program.
  Scene moving = stage.on_real_mesh("05_swing", {"time.integrator=symplectic_euler", "time.step=1e-5"});
  const State before = moving.simulation.state();
  moving.simulation.step();
  const Vector a = scaled(plus(moving.simulation.state().qdot, -1, before.qdot), 1 / moving.simulation.options().h);
  Vector balance = plus(mass_times(model, a), 1, gradient_of_potential(model, before.q));
  Vector force = gradient_of_potential(model, before.q);
  step.pins.set_zero(balance);
  step.pins.set_zero(force);
  sheet.at_most("|M q'' + dV/dq| / |dV/dq|, free vertices", norm(balance) / norm(force), 1e-10, "",
                "the system M q'' = -dV/dq is solved to 1e-12; the difference of velocities loses two digits");
  sheet.draw("gradient.svg", "Error of central differences against dV/dq",
             Chart{"dV/dq is the gradient of V",
                   {"width of the difference [m]", AxisScale::logarithmic},
                   {"relative error", AxisScale::logarithmic},
                   {{"", check.step, check.error, SeriesStyle::line_and_points}}});
  sheet.draw("mesh.png", "The mesh whose vertices q stacks, pulled sideways",
             MeshPicture{.panels = {{"", surface_at(model, step.q_t)}}, .eye = {{0.4, 0.3, 1}}, .up = {{0, 1, 0}}});
}

namespace {

double mean_height(const BodyRange& body, const Vector& q) {
  double sum = 0;
  for (int v = body.first_vertex; v < body.first_vertex + body.vertex_count; ++v) sum += q[3 * v + 1];
  return sum / body.vertex_count;
}

double mass_of(const Model& model, const BodyRange& body) {
  const auto mass = model.mass->vertex_mass().subspan(body.first_vertex, body.vertex_count);
  double sum = 0;
  for (const double m : mass) sum += m;
  return sum;
}

double volume_of(const Model& model, const BodyRange& body, const Vector& q) {
  TetMesh now{{}, model.mesh.tets, {}};
  for (size_t i = 0; i < q.size(); i += 3) now.rest.push_back({{q[i], q[i + 1], q[i + 2]}});
  double sum = 0;
  for (int t = body.first_tet; t < body.first_tet + body.tet_count; ++t) sum += volume(now, t);
  return sum;
}

}  // namespace

void show_springs_beside_elements(const Stage& stage, Sheet& sheet) {
  Scene scene = stage.on_real_mesh("08_springs_beside_elements");
  sheet.keep(scene);
  const Model& model = scene.simulation.model();
  const BodyRange &elements = model.bodies[0], &springs = model.bodies[1];
  const State start = scene.simulation.state();
  write_stacked(sheet, model, start.q);

  Vector time = {0}, drop_elements = {0}, drop_springs = {0};
  CsvFile table = sheet.table("drop.csv", {"time_s", "elements_m", "springs_m"});
  const Run result = run(scene.simulation, scene.steps, [&](const StepReport& report) {
    const Vector& q = scene.simulation.state().q;
    time.push_back(report.time);
    drop_elements.push_back(mean_height(elements, start.q) - mean_height(elements, q));
    drop_springs.push_back(mean_height(springs, start.q) - mean_height(springs, q));
    table.append(CsvRow().add(report.time).add(drop_elements.back()).add(drop_springs.back()));
  });
  const Vector& q = scene.simulation.state().q;
  sheet.equals("vertices of both", elements.vertex_count, springs.vertex_count, "", "one mesh twice");
  sheet.show("springs", static_cast<double>(edge_springs(model.mesh, springs.first_tet, springs.tet_count, 1).size()),
             "", "one along each edge");
  sheet.at_most("difference of the masses, relative", std::abs(mass_of(model, elements) / mass_of(model, springs) - 1),
                1e-10, "", "sums in another order");
  sheet.equals("steps that converged", scene.steps - result.unconverged, scene.steps, "", "all of them");
  sheet.at_least("largest mean drop of the elements", *std::max_element(drop_elements.begin(), drop_elements.end()),
                 1e-4, "m", "it sags under its weight");
  sheet.at_least("largest mean drop of the springs", *std::max_element(drop_springs.begin(), drop_springs.end()), 1e-4,
                 "m", "it sags under its weight");
  sheet.at_most("largest energy imbalance of a step", result.largest_ledger_error, 1e-9, "",
                "the balance is an identity for both kinds of V");
  sheet.show("volume of the elements at the end / at rest",
             volume_of(model, elements, q) / volume_of(model, elements, start.q), "");
  sheet.show("volume of the springs at the end / at rest",
             volume_of(model, springs, q) / volume_of(model, springs, start.q), "",
             "springs along edges do not resist changes of volume");
  sheet.draw("drop.svg", "Mean drop under gravity",
             Chart{"one mesh, two potentials V",
                   {"time [s]"},
                   {"mean drop [m]"},
                   {{"finite elements", time, drop_elements}, {"masses and springs", time, drop_springs}}});
  sheet.draw("both.png", "Finite elements on the left, masses and springs on the right, at the end",
             MeshPicture{.panels = {{"", surface_at(model, q)}}, .eye = {{0.2, 0.2, 1}}, .up = {{0, 1, 0}}});
}

}  // namespace aspic::cli::lecture
