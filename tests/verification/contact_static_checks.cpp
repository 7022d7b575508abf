// Contact in statics: Hertz, patch tests, refinement, independence of the constants.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "mesh/generators.h"
#include "reference/statics.h"
#include "verification/contact_models.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

using std::numbers::pi;

// Hertz: quarters of soft spheres around the points where they touch.
constexpr double kPoisson = 0.3, kPatch = 0.02;  // the radius of contact

struct Sphere {
  double radius, young;
  double low(const Vec3d& X) const { return radius - std::sqrt(radius * radius - X[0] * X[0] - X[2] * X[2]); }
};

// One sphere lies on a rigid plane, two on each other.
struct Pair {
  double curvature = 0, compliance = 0;  // 1 / R and 1 / E* of Hertz
  explicit Pair(const std::vector<Sphere>& spheres) {
    for (const auto& [radius, young] : spheres)
      curvature += 1 / radius, compliance += (1 - kPoisson * kPoisson) / young;
  }
  double force() const { return 4 * kPatch * kPatch * kPatch * curvature / (3 * compliance); }
};

// Coordinates from 0 to about 8 patch radii, n cells in the patch, growing outside.
std::vector<double> graded(int n, double growth) {
  std::vector<double> at = {0};
  double size = kPatch / n;
  while (at.back() < 8 * kPatch) {
    at.push_back(at.back() + size);
    if (at.back() > 1.3 * kPatch) size *= growth;
  }
  return at;
}

struct Hertz {
  double force, radius, pressure;  // of whole spheres
  double off_profile;              // deviation from the fitted profile of pressure, root mean square
  double highest;                  // pressure of a vertex
};

// Displacement of a half-space y >= 0 by a force P at the origin into it.
Vec3d far_displacement(const Vec3d& X, double P, double young) {
  const double r = std::hypot(X[0], X[2]), y = X[1], rho = std::hypot(r, y);
  const double factor = P * (1 + kPoisson) / (2 * pi * young);
  const double out = factor * (y / (rho * rho * rho) - (1 - 2 * kPoisson) / (rho * (rho + y)));
  const double down = factor * (y * y / (rho * rho * rho) + 2 * (1 - kPoisson) / rho);
  return {{out * X[0], down, out * X[2]}};
}

// Fits p^2 = p0^2 (1 - r^2 / a^2), a line in r^2, to the inner pressures.
Hertz fitted(const Simulation& simulation, int points) {
  const Barrier& contact = *simulation.model().contact;
  std::vector<double> pressure(simulation.model().mesh.vertex_count()), force(simulation.state().q.size());
  for (const ContactPoint& touching : contact.contact_points(simulation.state().q, simulation.obstacle_time()))
    pressure[touching.row] = touching.pressure;
  double count = 0, x = 0, y = 0, xx = 0, xy = 0;
  const auto inner = [&](const auto& use) {
    for (int i = 0; i < points; ++i) {
      const Vec3d X = contact.mesh().rest[i];
      const double r2 = X[0] * X[0] + X[2] * X[2];
      if (contact.mesh().row[i] >= 0 && r2 < 0.8 * 0.8 * kPatch * kPatch)
        use(r2, std::pow(pressure[contact.mesh().row[i]], 2));
    }
  };
  inner([&](double r2, double p2) { count += 1, x += r2, y += p2, xx += r2 * r2, xy += r2 * p2; });
  const double slope = (count * xy - x * y) / (count * xx - x * x), top = (y - slope * x) / count;
  double off = 0;
  inner([&](double r2, double p2) { off += std::pow(std::sqrt(p2) - std::sqrt(std::max(0.0, top + slope * r2)), 2); });
  contact.add_gradient(simulation.state().q, {}, -1, force);
  double sum = 0;
  for (int i = 0; i < points; ++i) sum += force[3 * contact.mesh().row[i] + 1];
  return {4 * sum, std::sqrt(-top / slope), std::sqrt(top), std::sqrt(off / count),
          *std::max_element(pressure.begin(), pressure.end())};
}

Hertz pressed_spheres(const std::vector<Sphere>& spheres, int n, const Subject& subject, Findings& found) {
  const double reach = 1e-5;  // a fiftieth of about a quarter of an element in the patch
  const double gap = reach / static_cast<double>(spheres.size());
  const std::vector<double> at = graded(n, 1.4);
  const int cells = static_cast<int>(at.size()) - 1;
  const Pair hertz(spheres);
  TouchingModel given{
      .has_floor = spheres.size() == 1, .material = subject.replacement("neo_hookean_log"), .poisson = kPoisson};
  given.contact = {.reach = reach, .stiffness = 0.1};
  std::vector<Pin> pins;
  int first = 0;
  for (const Sphere& sphere : spheres) {
    const double side = first == 0 ? 1 : -1;  // above or below
    TetMesh mesh = make_box({{0, 0, 0}}, {{1, 1, 1}}, {cells, cells, cells});
    std::vector<int> held, x_plane, z_plane;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      Vec3d& X = mesh.rest[v];
      for (int k = 0; k < 3; ++k) X[k] = at[std::lround(X[k] * cells)];
      if (*std::max_element(X.a, X.a + 3) == at.back())
        held.push_back(first + v);
      else if (X[0] == 0 || X[2] == 0) {
        if (X[0] == 0) x_plane.push_back(first + v);
        if (X[2] == 0) z_plane.push_back(first + v);
      }
      X[1] = side * (X[1] + gap + sphere.low(X));
    }
    if (side < 0)
      for (Tet& tet : mesh.tets) std::swap(tet[0], tet[1]);
    // The height identifies the side that touches.
    const auto touches = [=](const Vec3d& X) { return std::abs(X[1]) < 1e-12 + gap + sphere.low(X); };
    given.bodies.push_back({mesh, subject.stiffness * sphere.young, 1, touches});
    const double force = hertz.force(), approach = side > 0 ? kPatch * kPatch * hertz.curvature : 0;
    pins.push_back(
        {"far", held, [=](const Vec3d& X, double t) {
           Vec3d u = far_displacement({{X[0], std::abs(X[1]) - gap - sphere.low(X), X[2]}}, force, sphere.young);
           u[1] = side * u[1] - approach;
           return X + t * u;
         }});
    pins.push_back({"x", x_plane, {}, {{{1, 0, 0}}}});
    pins.push_back({"z", z_plane, {}, {{{0, 0, 1}}}});
    first += mesh.vertex_count();
  }
  Model model = make_touching(given);
  model.pins = pins;
  const Simulation simulation = equilibrium(std::move(model), 4, "pressed sphere", 1e-8);
  expect_contact(std::to_string(n) + " elements: ", simulation, found);
  const std::vector<int>& row = simulation.model().contact->mesh().row;
  const int end = given.bodies[0].mesh.vertex_count();
  return fitted(simulation,
                static_cast<int>(std::count_if(row.begin(), row.end(), [end](int v) { return v >= 0 && v < end; })));
}

struct Elements {
  int in_radius;
  double of_radius, of_pressure;  // relative tolerances
};

void expect_hertz(const std::vector<Sphere>& spheres, const Subject& subject, Findings& found) {
  const Pair hertz(spheres);
  for (const auto& [n, of_radius, of_pressure] :
       subject.quick ? std::vector<Elements>{{8, 0.0625, 0.02}}
                     : std::vector<Elements>{{3, 0.2, 0.05}, {6, 0.1, 0.02}, {12, 0.03, 0.01}}) {
    const std::string name = std::to_string(n) + " elements in the radius: ";
    const Hertz measured = pressed_spheres(spheres, n, subject, found);
    const double F = measured.force, a = std::cbrt(3 * F * hertz.compliance / (4 * hertz.curvature)),
                 p0 = 3 * F / (2 * pi * a * a);
    found.expect(name + "radius of contact", {measured.radius, a, of_radius * a},
                 "the border of contact lies within an element", "m");
    found.expect(name + "highest pressure of a vertex / E", {measured.highest, p0, of_pressure * p0},
                 "the elements, which may halve the error where they double");
    found.expect(name + "largest pressure by the fit / E", {measured.pressure, p0, 0.05 * p0}, "5 %: the elements");
    found.expect_small(name + "deviation from the profile of pressure, root mean square / largest pressure",
                       measured.off_profile / p0, 0.05, "5 %: the elements, up to 0.8 of the radius");
    found.expect(name + "force / E of the approach a^2 / R", {F, hertz.force(), 0.05 * hertz.force()},
                 "elements and the far field, which has relative errors of (1/8)^2", "m^2");
  }
}

void check_hertz(const Subject& subject, Findings& found) { expect_hertz({{1, 1}}, subject, found); }
void check_two_spheres(const Subject& subject, Findings& found) { expect_hertz({{1, 1}, {2, 3}}, subject, found); }

// Two blocks of height 1/2 with unmatched meshes; the upper one is moved down. nu = 0, so that lateral sides stay.
// Lateral motion is held: the border of a block on the edge of another one would buckle sideways.
struct Pressed {
  double mean, reference;  // pressures [Pa]
  double second_layer;     // largest relative deviation of the stress in the tets of the second layers
  double border;           // relative change of the mean if all points had 5/3 of their area
};

struct Blocks {
  int lower, upper;  // cells in each lateral direction; n, n of height for the lower number n
  bool only_facing;  // only the facing sides touch
};

constexpr double kShortened = 0.05;  // of the height of both blocks, 1

Pressed pressed_blocks(const Blocks& blocks, double young, Findings& found) {
  const double gap = 0.03;  // so large that it does not limit the reach
  const auto [n, up, only_facing] = blocks;
  TouchingModel given{.bodies = {{make_box({{0, 0, 0}}, {{1, 0.5, 1}}, {n, n, n})},
                                 {make_box({{0, 0.5 + gap, 0}}, {{1, 1 + gap, 1}}, {up, n, up})}},
                      .material = "linear",
                      .poisson = 0};
  given.contact.reach_per_edge = kStaticReachPerEdge;
  for (TouchingBody& body : given.bodies) {
    body.young = young;
    if (only_facing) body.touches = [=](const Vec3d& X) { return std::abs(X[1] - 0.5) < 1.5 * gap; };
  }
  Model model = make_touching(given);
  const auto held = vertices_where(model.mesh, [](const Vec3d& X) { return X[1] == 0; });
  const auto moved = vertices_where(model.mesh, [=](const Vec3d& X) { return X[1] > 1 + 0.5 * gap; });
  const auto between = vertices_where(model.mesh, [=](const Vec3d& X) { return X[1] > 0 && X[1] < 1 + 0.5 * gap; });
  const double down = kShortened + gap;
  model.pins.push_back({"bottom", held, {}});
  model.pins.push_back({"sides", between, {}, {{{1, 0, 0}}, {{0, 0, 1}}}});
  model.pins.push_back({"top", moved, [down](const Vec3d& X, double t) { return X - Vec3d{{0, t * down, 0}}; }});
  const ContactLaw law = model.contact->laws()(1, 0);
  const Simulation simulation = equilibrium(std::move(model), 4, "pressed blocks", 1e-10);
  expect_contact(std::to_string(n) + " and " + std::to_string(up) + " cells: ", simulation, found);
  double p = young * kShortened;  // solves p = E (shortened + gap of p)
  for (int i = 0; i < 100; ++i) p = young * (kShortened + gap_of_pressure(law, p));
  const double wider = gap_of_pressure(law, 0.6 * p) - gap_of_pressure(law, p);
  const TetMesh& mesh = simulation.model().mesh;
  const std::vector<double>& q = simulation.state().q;
  const double layer = 0.5 / n;
  double worst = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const double height = 0.25 * (mesh.rest[a][1] + mesh.rest[b][1] + mesh.rest[c][1] + mesh.rest[d][1]);
    const double away = std::abs(height - 0.5 - (height > 0.5 ? gap : 0));
    if (away < layer || away > 2 * layer) continue;
    const Vec3d x = point(q, a);
    const Mat3d F = from_columns(point(q, b) - x, point(q, c) - x, point(q, d) - x) * inverse(edge_matrix(mesh, t));
    worst = std::max(worst, std::abs(young * (1 - F(1, 1)) / p - 1));
  }
  return {-sum_over(moved, elastic_forces(simulation))[1], p, worst, young * wider / p};
}

// Largest relative deviation of nodal loads: the coarser side has the share s of the integral and areas larger by
// 1 / r, which points of the finer side below its points receive.
double load_scatter(int coarse, int fine) {
  const double r = std::pow(static_cast<double>(coarse) / fine, 2), s = r * r * r / (1 + r * r * r);
  return s * (1 / r - 1);
}

void check_patch(const Subject& subject, Findings& found) {
  const double E = subject.stiffness;
  for (const int n : subject.quick ? std::vector<int>{4} : std::vector<int>{4, 8})
    for (const auto& [name, upper, bound, reason] :
         {std::tuple{"matched", n, 1e-9, "the discrete state is uniform"},
          {"2 : 1", 2 * n, 0.01, "1 %: coarse points lie on fine ones"},
          {"3 : 2", 3 * n / 2, load_scatter(2, 3),
           "nodal loads deviate by up to s (1 / r - 1) for the ratio r of areas and s = r^3 / (1 + r^3)"}}) {
      const Pressed one = pressed_blocks({n, upper, true}, E, found);
      const double mean_bound = upper == n ? 1e-9 : upper == 2 * n ? 1e-3 : bound * bound / n;
      const std::string mean_reason =
          upper == n ? reason
          : upper == 2 * n
              ? "1e-3: quadrature"
              : "scattered loads indent a layer as high as a cell: the square of the scatter times the cell";
      const std::string cells = std::to_string(n) + " cells, " + name;
      found.expect(cells + ": mean pressure / E", {one.mean, one.reference / E, mean_bound * one.reference},
                   mean_reason);
      found.expect_small(cells + ": stress in the second layers, largest relative deviation", one.second_layer, bound,
                         reason);
      const Pressed whole = pressed_blocks({n, upper, false}, E, found);
      found.expect(
          cells + ", whole surfaces: mean pressure / E",
          {whole.mean, whole.reference / E, whole.border * whole.reference},
          "points of the border count triangles of the sides, 5/3 of their area at most, which widens the gap");
    }
}

void check_refinement(const Subject& subject, Findings& found) {
  std::vector<double> error;
  for (const int n : subject.quick ? std::vector<int>{3, 6} : std::vector<int>{3, 6, 12})
    error.push_back(pressed_blocks({n, n + n / 3, false}, 1, found).mean / kShortened - 1);
  for (size_t i = 1; i < error.size(); ++i)
    found.expect("order, cells halved " + std::to_string(i) + " times", {std::log2(error[i - 1] / error[i]), 1, 0.15},
                 "the gap is a part of the reach that depends on pressure, which changes by a few percent");
  found.expect_small("error of the pressure on the finest mesh", error.back(), subject.quick ? 0.1 : 0.05,
                     "a gap of at most the reach");
}

// Height of a settled soft block on the floor and of another one on it.
std::vector<double> heights_at_rest(const ContactOptions& constants, Findings& found) {
  TouchingModel given{.bodies = {{make_box({{0, 0.001, 0}}, {{0.1, 0.051, 0.1}}, {3, 2, 3})},
                                 {make_box({{0.02, 0.053, 0.02}}, {{0.08, 0.103, 0.08}}, {2, 2, 2})}},
                      .has_floor = true,
                      .gravity = {{0, -9.81, 0}}};
  for (TouchingBody& body : given.bodies) body.young = 1e5;
  given.contact = constants;
  Simulation simulation = simulate(make_touching(given), {.h = 0.05, .solver = {}});
  take_steps(simulation, 40, "blocks come to rest");
  expect_contact("", simulation, found);
  std::vector<double> heights;
  for (const size_t body : {0, 1}) {
    const auto [first, end] = vertices_of(given, body);
    heights.push_back(mass_mean(simulation.model(), simulation.state().q, first, end)[1]);
  }
  return heights;
}

void check_constants(const Subject&, Findings& found) {
  const double reach = 8e-4, stiffness = 1e4;
  const std::vector<double> base = heights_at_rest({reach, stiffness}, found);
  for (const auto& [name, constants] : {std::pair{"half the reach", ContactOptions{reach / 2, stiffness}},
                                        {"half the stiffness", ContactOptions{reach, stiffness / 2}},
                                        {"ten times the stiffness", ContactOptions{reach, 10 * stiffness}}}) {
    const std::vector<double> other = heights_at_rest(constants, found);
    for (const size_t body : {0, 1})
      found.expect_small(std::string(name) + ": motion of block " + std::to_string(body + 1),
                         std::abs(other[body] - base[body]), 2 * reach,
                         "one gap below the first block and two below the second change by less than the reach", "m");
  }
}

}  // namespace

void add_contact_static_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"contact",
       "hertz",
       "A soft sphere on a plane",
       "Around the lowest point, E = 1, nu = 0.3; far boundaries move as a half-space under a point force. Radius and "
       "pressure by a fit of p^2 in r^2.",
       "Hertz's solution: radius, largest pressure and approach",
       check_hertz,
       {"Johnson1985"},
       {R"tex(a^3 = \frac{3 F R (1 - \nu^2)}{4 E}, \quad p_0 = \frac{3 F}{2 \pi a^2}, \quad \delta = \frac{a^2}{R})tex"}});
  checks.push_back(
      {"contact",
       "two_spheres",
       "A soft sphere on a larger, stiffer one",
       "As above, with the radii 1 and 2 and the moduli 1 and 3.",
       "Hertz's solution for the sums of curvatures and of compliances",
       check_two_spheres,
       {"Johnson1985"},
       {R"tex(\frac1R = \frac1{R_1} + \frac1{R_2}, \quad \frac1{E^*} = (1 - \nu^2) \left(\frac1{E_1} + \frac1{E_2}\right))tex"}});
  checks.push_back(
      {"contact",
       "patch",
       "Uniform pressure between unmatched meshes",
       "Two blocks are pressed together by 5 %, nu = 0.",
       "Uniform stress with the gap d at which the barrier exerts the pressure p",
       check_patch,
       {},
       {R"tex(p = E (\varepsilon + d), \quad \kappa\, \left|\frac{\partial b}{\partial d}\right| = p)tex"}});
  checks.push_back({"contact",
                    "refinement",
                    "Contact converges with the mesh",
                    "The same blocks; the reach is a fiftieth of the edges.",
                    "Uniform stress",
                    check_refinement,
                    {},
                    {R"tex(p_h = E \varepsilon + O(h))tex"}});
  checks.push_back({"contact", "constants", "Contact is independent of reach and stiffness",
                    "Two soft blocks, stacked on the floor, at rest.",
                    "A state of rest moves by less than twice the reach", check_constants});
}

}  // namespace aspic::verify
