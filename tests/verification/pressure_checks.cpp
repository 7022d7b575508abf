// Follower pressure on open patches: resultants by integrals over the rim alone.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "dynamics/state.h"
#include "dynamics/step_derivatives.h"
#include "energy/cavity.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "reference/hollow_sphere.h"
#include "reference/models.h"
#include "reference/radial_reference.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// Curves through vertices: of degree 1 between neighbors, or of degree 2 through every other one.
struct Curve3 {
  std::vector<Vec3d> x;
  bool is_quadratic;
};

// Integral of f(x, dx) along a curve, by three Gauss points per piece.
template <class F>
Vec3d along(const Curve3& curve, const F& f) {
  const double root = std::sqrt(0.15);
  Vec3d sum{};
  const size_t step = curve.is_quadratic ? 2 : 1;
  for (size_t i = 0; i + step < curve.x.size(); i += step) {
    const Vec3d &a = curve.x[i], &b = curve.x[i + step];
    const Vec3d bend = curve.is_quadratic ? curve.x[i + 1] - 0.5 * (a + b) : Vec3d{};  // at the middle
    for (const auto& [s, weight] : {std::pair(0.5 - root, 5.0 / 18), {0.5, 8.0 / 18}, {0.5 + root, 5.0 / 18}})
      sum = sum + weight * f(a + s * (b - a) + (4 * s * (1 - s)) * bend, (b - a) + (4 - 8 * s) * bend);
  }
  return sum;
}

// Stokes: the integrals of n da and of x cross n da over a surface, from its rim.
Vec3d area_vector(const Curve3& rim) {
  return along(rim, [](const Vec3d& x, const Vec3d& dx) { return 0.5 * cross(x, dx); });
}
Vec3d area_moment(const Curve3& rim) {
  return along(rim, [](const Vec3d& x, const Vec3d& dx) { return (-0.5 * dot(x, x)) * dx; });
}

// Deformed vertices whose rest positions satisfy `is_part`, in ascending order of `place`.
template <class Place>
Curve3 curve_of(const Simulation& simulation, const Predicate& is_part, const Place& place) {
  const TetMesh& mesh = simulation.model().mesh;
  std::vector<int> vertices = vertices_where(mesh, is_part);
  std::sort(vertices.begin(), vertices.end(), [&](int v, int w) { return place(mesh.rest[v]) < place(mesh.rest[w]); });
  Curve3 curve{{}, !mesh.mids.empty()};
  for (const int v : vertices) curve.x.push_back(point(simulation.state().q, v));
  return curve;
}

TetMesh with_order(TetMesh mesh, int order) { return order == 2 ? raise_order(std::move(mesh)) : mesh; }

Simulation loaded(Model model) {
  SimulationOptions options{.h = 0.5, .integrator = "quasi_static", .solver = {}};
  options.solver.minimize.tolerance = 1e-10;
  return simulate(std::move(model), options);
}

void expect_vector(Findings& found, const std::string& name, const std::array<Vec3d, 2>& numbers, double size,
                   const std::string& unit) {
  for (int r = 0; r < 3; ++r)
    found.expect(
        name + ", " + "xyz" [r], { numbers[0][r], numbers[1][r], 1e-9 * size }, "tolerance of the equilibrium", unit);
}

constexpr double kBarPressure = 1e3;  // [Pa]; E = 1e5 Pa

Model pressed_bar(int order) {
  const TetMesh mesh = with_order(make_box({{0, 0, 0}}, {{4, 1, 1}}, {8, 2, 2}), order);
  return model_of(mesh, {.young = 1e5, .poisson = 0.3, .gravity = {}})
      .pin("wall", [](const Vec3d& X) { return X[0] == 0; })
      .pressure("pressure", faces_where(mesh, [](const Vec3d& X) { return X[2] == 1 && X[0] >= 1 && X[0] <= 3; }),
                [](double t) { return kBarPressure * std::min(t, 1.0); })
      .build();
}

void check_open_patch(const Subject&, Findings& found) {
  for (const int order : {1, 2}) {
    Simulation simulation = loaded(pressed_bar(order));
    take_steps(simulation, 1, "bar under pressure");
    const StepReport report = simulation.step();
    const std::string elements = order == 1 ? "linear tets: " : "quadratic tets: ";
    found.expect(elements + "status", {is_success(report.status) ? 1.0 : 0.0, 1, 0}, "1: converged");
    const auto is_rim = [](const Vec3d& X) {
      const bool is_inside = X[0] > 1 && X[0] < 3 && X[1] > 0 && X[1] < 1;
      return X[2] == 1 && X[0] >= 1 && X[0] <= 3 && !is_inside;
    };
    Curve3 rim = curve_of(simulation, is_rim, [](const Vec3d& X) {  // counter-clockwise from (1, 0)
      return X[1] == 0 ? X[0] - 1 : X[0] == 3 ? 2 + X[1] : X[1] == 1 ? 3 + (3 - X[0]) : 6 - X[1];
    });
    rim.x.push_back(rim.x.front());
    const Resultant& load = report.resultants.loads[report.resultants.loads.size() - 1];
    const double size = 2 * kBarPressure;
    expect_vector(found, elements + "force of the load", {load.force, -kBarPressure * area_vector(rim)}, size, "N");
    expect_vector(found, elements + "moment of the load", {load.moment, -kBarPressure * area_moment(rim)}, 4 * size,
                  "N m");
    const Resultant& wall = report.resultants.pins[0];
    expect_vector(found, elements + "reaction of the wall", {wall.force, -1.0 * load.force}, size, "N");
    found.expect_small(elements + "error of the ledger / work", report.ledger_error / std::abs(report.potential_total),
                       1e-10, "round-off");
  }
}

void check_octant(const Subject& subject, Findings& found) {
  constexpr double kPressure = 2e3;
  for (const int order : {1, 2}) {
    const TetMesh mesh = with_order(hollow_sphere(octant(octahedral_sphere(subject.quick ? 2 : 3)), 2, 1, 2), order);
    ModelBuilder builder = model_of(mesh, {.young = 1e4, .poisson = 0.3, .gravity = {}});
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d n{};
      n[axis] = 1;
      builder.pin(std::string(1, "xyz"[axis]), [axis](const Vec3d& X) { return std::abs(X[axis]) < 1e-9; }, {}, {n});
    }
    // The middles of straight edges are inside the sphere.
    const std::vector<Face> inside = faces_where(mesh, [](const Vec3d& X) { return norm(X) < 1 + 1e-9; });
    builder.pressure("pressure", inside, [](double t) { return kPressure * std::min(t, 1.0); });
    Simulation simulation = loaded(builder.build());
    take_steps(simulation, 1, "octant under pressure");
    const StepReport report = simulation.step();
    const std::string elements = order == 1 ? "linear tets: " : "quadratic tets: ";
    found.expect(elements + "status", {is_success(report.status) ? 1.0 : 0.0, 1, 0}, "1: converged");
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      const auto is_rim = [axis](const Vec3d& X) { return std::abs(X[axis]) < 1e-9 && norm(X) < 1 + 1e-9; };
      const Curve3 rim = curve_of(simulation, is_rim, [&](const Vec3d& X) { return std::atan2(X[last], X[next]); });
      const double area = area_vector(rim)[axis];  // of the sector to the origin
      found.expect(elements + "reaction of the plane " + "xyz"[axis] + " = 0 / (p area)",
                   {-report.resultants.pins[axis].force[axis] / (kPressure * area), 1, 1e-8},
                   "tolerance of the equilibrium");
    }
  }
}

// The reference is for a ball; the cavity of the mesh is a polyhedron, so that ratios of volumes are compared.
void check_cavity(const Subject& subject, Findings& found) {
  const TetMesh mesh =
      raise_order(hollow_sphere(octahedral_sphere(subject.quick ? 1 : 2), subject.quick ? 1 : 2, 1, 2));
  const std::vector<Face> inside = faces_where(mesh, [](const Vec3d& X) { return norm(X) < 1 + 1e-9; });
  constexpr double kYoung = 1e4;
  for (const auto& [name, content] :
       {std::pair<std::string, CavityContent>("gas", {CavityContent::gas, 2e3, [](double t) { return 1 + 2 * t; }}),
        {"liquid", {CavityContent::liquid, 1e7, [](double t) { return 1 + t; }}}}) {
    Simulation simulation = loaded(model_of(mesh, {.young = kYoung, .poisson = 0.3, .gravity = {}})
                                       .load(make_cavity("cavity", mesh, inside, content, at_rest(mesh).q))
                                       .pin("corner", [](const Vec3d& X) { return X[0] > 2 - 1e-9; })
                                       .build());
    const double start = simulation.start_report().cavities[0].volume;
    take_steps(simulation, 1, "ball with " + name);
    const StepReport report = simulation.step();
    found.expect(name + ": status", {is_success(report.status) ? 1.0 : 0.0, 1, 0}, "1: converged");
    const auto [volume, pressure] = report.cavities[0];
    const double inner = std::cbrt(volume / start);
    const double expected = kYoung * inflated_sphere("neo_hookean_log", 0.3, 1, 2, inner).force / (inner * inner);
    found.expect(name + ": pressure for an inner radius of " + std::to_string(inner) + " m / reference",
                 {pressure / expected, 1, subject.quick ? 0.1 : 0.03}, "mesh");
    found.expect(name + ": pressure / law of the content",
                 {pressure / (name == "gas" ? 2e3 * (3 * start / volume - 1) : 1e7 * (2 - volume / start)), 1, 1e-9},
                 "round-off");
  }
}

void check_rim_derivatives(const Subject&, Findings& found) {
  for (const int order : {1, 2}) {
    Simulation simulation = loaded(pressed_bar(order));
    take_steps(simulation, 1, "bar under pressure");
    for (const TermDerivatives& term : check_step_derivatives(simulation)) {
      if (!term.term.starts_with("pressure")) continue;
      const std::string what = "order " + std::to_string(order) + ", " + term.term + ", " + term.state + ": ";
      found.expect_small(what + "smallest error of the gradient", term.report.gradient.smallest_error, 1e-6,
                         "where the error h^2 of the difference meets its round-off 1e-16 / h");
      found.expect_small(what + "smallest error of the Hessian", term.report.hessian.smallest_error, 1e-6,
                         "where the error h^2 of the difference meets its round-off 1e-16 / h");
    }
  }
}

}  // namespace

void add_pressure_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"statics",
       "open_pressure",
       "Follower pressure on a patch of a bar",
       "A bar 4 x 1 x 1 m, E = 0.1 MPa, is bent by 1 kPa on 1 < x < 3 of its upper side. Force and moment of the load "
       "are "
       "those of p on the deformed patch.",
       "Stokes' theorem: integrals over the deformed rim alone",
       check_open_patch,
       {},
       {R"tex(\int_S n\, da = \tfrac{1}{2} \oint x \times dx, \quad \int_S x \times n\, da = -\tfrac{1}{2} \oint |x|^2\, dx)tex"}});
  checks.push_back(
      {"statics",
       "pressurized_octant",
       "An eighth of a hollow sphere under pressure",
       "Radii 1 and 2 m, E = 10 kPa, 2 kPa inside, three planes of symmetry. Each plane reacts with p times "
       "the deformed area of the cavity in it.",
       "Equilibrium of the content of the cavity",
       check_octant,
       {},
       {R"tex(R = p\, A)tex"}});
  checks.push_back({"statics",
                    "cavity",
                    "Gas and liquid in a hollow sphere",
                    "Radii 1 and 2 m, E = 10 kPa, held at a point. Two more parts of gas from outside at 2 kPa, or a "
                    "doubled volume of "
                    "liquid of 10 MPa, inflate it. Their pressures belong to the radius.",
                    "Shooting for one radius, and the laws of the contents",
                    check_cavity,
                    {},
                    {R"tex(p = p_0 (a\, v_0 / v - 1), \quad p = K (a - v / v_0))tex"}});
  checks.push_back(
      {"derivatives",
       "pressure",
       "Gradients and Hessians of a follower pressure",
       "The bar of statics/open_pressure, its pressure with the swept volume and the share of the rim, which "
       "is lagged.",
       "Central differences",
       check_rim_derivatives,
       {},
       {R"tex(\frac{f(x + h) - f(x - h)}{2 h} = \frac{df}{dx} + O(h^2))tex"}});
}

}  // namespace aspic::verify
