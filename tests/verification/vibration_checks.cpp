// Natural frequencies and a pendulum.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "mesh/generators.h"
#include "reference/models.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

constexpr double kLayerYoung = 1e7;  // [Pa], with 1000 kg/m^3: wave speed 100 m/s

Model clamped_layer(const TetMesh& mesh, const std::string& material, double young, double poisson, double density) {
  Model model =
      model_of(mesh, {.material = material, .young = young, .poisson = poisson, .density = density, .gravity = {}})
          .pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
          .build();
  hold_plane(model);
  return model;
}

// Strip of 1 m x 0.05 m with n cells through the height.
Model strip(int n, const std::string& material, double young) {
  return clamped_layer(make_layer(20 * n, n, 0.05 / n,
                                  [](double x, double y) {
                                    return std::array{x, 0.05 * y};
                                  }),
                       material, young, 0, 1000);
}

struct ModeReferences {
  std::vector<std::string> names;
  std::vector<double> frequency;  // [Hz]
  std::vector<double> tolerance;  // relative
};

// Adds one row per mode: values converge to the reference as h^2, so the last two are extrapolated.
void expect_limits(Findings& found, const ModeReferences& modes, const std::vector<std::vector<double>>& by_mesh,
                   const std::string& reason) {
  const auto& [names, reference, tolerance] = modes;
  Findings orders;  // appended after the limits
  for (size_t k = 0; k < names.size(); ++k) {
    std::vector<double> values;
    for (const auto& mesh : by_mesh) values.push_back(mesh[k]);
    found.expect(names[k] + ": limit", {richardson(values, 2), reference[k], tolerance[k] * reference[k]}, reason,
                 "Hz");
    if (values.size() >= 3)
      orders.expect(names[k] + ": order of the last three meshes", {extrapolate(values).order, 2, 0.2},
                    "the next term of the error, with 4 cells or more through the height");
  }
  found.rows.insert(found.rows.end(), orders.rows.begin(), orders.rows.end());
}

void check_bar(const Subject& subject, Findings& found) {
  const std::string material = subject.replacement("neo_hookean_log");
  std::vector<std::vector<double>> by_mesh;
  for (const int n : {8, 16, 32}) {
    TetMesh mesh = make_box({{0, 0, 0}}, {{1, 0.02, 0.02}}, {n, 1, 1});
    Model model =
        model_of(mesh, {.material = material, .young = subject.stiffness * kLayerYoung, .poisson = 0, .gravity = {}})
            .pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
            .build();
    for (const int axis : {1, 2}) hold_plane(model, axis);  // no bending: the sides are held
    by_mesh.push_back(frequencies(model, 2));
  }
  expect_limits(found, {{"first", "second"}, {25, 75}, {1e-4, 1e-3}}, by_mesh,
                "the next term of the error, h^4, with 32 cells along the bar");
}

void check_beam(const Subject& subject, Findings& found) {
  std::vector<std::vector<double>> by_mesh;
  Plot plot{"frequencies of a clamped beam over the reference",
            "cells through the height",
            "ratio - 1",
            Scales::logarithmic,
            {}};
  const std::vector<double> reference = {0.8063748, 5.0047138, 13.8027409};
  const std::vector<std::string> names = {"first", "second", "third"};
  const std::vector<int> cells = subject.quick ? std::vector<int>{4, 8} : std::vector<int>{4, 8, 16};
  for (const int n : cells)
    by_mesh.push_back(
        frequencies(strip(n, subject.replacement("neo_hookean_log"), subject.stiffness * kLayerYoung), 3));
  for (size_t k = 0; k < names.size(); ++k) {
    Curve curve{names[k], {}, {}};
    for (size_t i = 0; i < cells.size(); ++i) {
      curve.x.push_back(cells[i]);
      curve.y.push_back(by_mesh[i][k] / reference[k] - 1);
    }
    plot.curves.push_back(curve);
  }
  expect_limits(found, {names, reference, std::vector<double>(3, subject.quick ? 5e-3 : 1e-3)}, by_mesh,
                "the shear factor 5/6 of the beam theory and the error of the extrapolation");
  expect_limits(found,
                {{"first, slender beam", "second, slender beam", "third, slender beam"},
                 {0.80770, 5.06177, 14.17311},
                 {3e-3, 0.02, 0.04}},
                {by_mesh.end() - 2, by_mesh.end()},
                "Euler and Bernoulli neglect shear and rotary inertia, which lower it by 0.16, 1.1 and 2.7 %");
  found.plots.push_back(plot);
}

void check_tapered_membrane(const Subject& subject, Findings& found) {
  const auto moduli = plane_stress(200e9, 0.3);
  const std::vector<double> reference = {44.623, 130.03, 162.70, 246.05, 379.90, 391.44};
  const std::vector<int> cells = subject.quick ? std::vector<int>{8, 16} : std::vector<int>{16, 32};
  std::vector<std::vector<double>> by_mesh;
  for (const int n : cells)
    by_mesh.push_back(
        frequencies(clamped_layer(make_layer(2 * n, n, 5.0 / n,
                                             [](double x, double y) {
                                               return std::array{10 * x, (y - 0.5) * (5 - 4 * x)};
                                             }),
                                  subject.replacement("neo_hookean_log"), moduli.young, moduli.poisson, 8000),
                    6));
  expect_limits(found,
                {{"mode 1", "mode 2", "mode 3", "mode 4", "mode 5", "mode 6"},
                 reference,
                 std::vector<double>(6, subject.quick ? 2e-2 : 1e-3)},
                by_mesh,
                "the extrapolation to h = 0 beside the corners of the clamped edge, and the reference's own mesh");
}

// Stiff bar hanging from one edge of its end, released horizontally: time between two rests.
double swing_period(const std::string& integrator, double h) {
  const double length = 1, width = 0.1;
  Model model = make_model(make_box({{0, 0, 0}}, {{length, width, width}}, {4, 1, 1}),
                           {.young = 1e9, .poisson = 0.3, .gravity = {{0, -9.81, 0}}});
  model.pins.push_back(
      {"hinge", vertices_where(model.mesh, [](const Vec3d& X) { return X[0] == 0 && X[1] == 0; }), {}});
  const std::vector<double> weights(model.mass->vertex_mass().begin(), model.mass->vertex_mass().end());
  Simulation simulation = simulate(std::move(model), {.h = h, .integrator = integrator, .solver = {}});
  // The center of mass reverses where its angular velocity about z changes sign.
  const auto turning = [&] {
    double rate = 0;
    for (size_t v = 0; v < weights.size(); ++v) {
      const double *q = &simulation.state().q[3 * v], *u = &simulation.state().qdot[3 * v];
      rate += weights[v] * (q[0] * u[1] - q[1] * u[0]);
    }
    return rate;
  };
  double before = 0, first = 0;
  int turns = 0;
  for (int i = 0; i < 20 / h; ++i) {
    take_steps(simulation, 1, integrator);
    const double now = turning(), time = simulation.state().time;
    if (before * now < 0) {
      const double zero = time - h * now / (now - before);
      if (++turns == 1) first = zero;
      if (turns == 7) return (zero - first) / 3;
    }
    before = now;
  }
  throw std::runtime_error("the pendulum did not swing");
}

void check_pendulum(const Subject& subject, Findings& found) {
  // About the edge: I / m = (l^2 + w^2) / 3; the center is at distance d, at the angle of the diagonal.
  const double l = 1, w = 0.1, d = std::hypot(l, w) / 2, inertia = (l * l + w * w) / 3;
  const double angle = std::numbers::pi / 2 + std::atan2(w, l);  // angle from the vertical
  const double reference = 4 * std::comp_ellint_1(std::sin(angle / 2)) * std::sqrt(inertia / (9.81 * d));
  for (const std::string integrator : {"midpoint", "tr_bdf2"}) {
    const double coarse = swing_period(subject.replacement(integrator), 0.01);
    const double fine = swing_period(subject.replacement(integrator), 0.005);
    found.expect(integrator + ": period, extrapolated in h",
                 {richardson({coarse, fine}, 2), reference, 2e-4 * reference},
                 "the bar bends and stretches by 1e-5 of its length; h^4", "s");
    found.expect(integrator + ": period, h = 5 ms", {fine, reference, 1e-3 * reference}, "(w h)^2 / 12 and less", "s");
  }
}

}  // namespace

void add_vibration_checks(std::vector<Check>& checks) {
  checks.push_back({"vibration",
                    "bar",
                    "Waves along a bar, clamped at one end",
                    "E = 1e7 Pa, 1000 kg/m^3, 1 m, nu = 0, held sideways; 8, 16 and 32 cells.",
                    "The wave equation",
                    check_bar,
                    {"Weaver1990"},
                    {R"tex(f_k = \frac{2 k - 1}{4 L} \sqrt{\frac{E}{\rho}})tex"}});
  checks.push_back(
      {"vibration",
       "beam",
       "Bending of a clamped beam",
       "1 x 0.05 m of the same material. Linear tets are too stiff in bending by an error of order h^2; "
       "the limit is judged, and the trend.",
       "Timoshenko's beam with the shear factor 5/6, and Euler and Bernoulli's for a slender one",
       check_beam,
       {"Timoshenko1921"},
       {R"tex(\tfrac56 G A\, \frac{d}{dx} \left(\frac{dw}{dx} - \varphi\right) + \rho A\, \omega^2 w = 0)tex",
        R"tex(E I \frac{d^2 \varphi}{dx^2} + \tfrac56 G A \left(\frac{dw}{dx} - \varphi\right) + \rho I\, \omega^2 \varphi = 0)tex",
        R"tex(f_k = \frac{\beta_k^2}{2 \pi L^2} \sqrt{\frac{E I}{\rho A}}, \quad \cos \beta_k \cosh \beta_k = -1 \quad \text{(slender)})tex"}});
  checks.push_back({"vibration",
                    "tapered_membrane",
                    "NAFEMS FV32: in-plane vibration of a tapered membrane",
                    "10 m long, 5 m high at the clamped edge and 1 m at the other; E = 200 GPa, nu = 0.3, 8000 kg/m^3, "
                    "plane stress.",
                    "The published frequencies",
                    check_tapered_membrane,
                    {"Abbassian1987"}});
  checks.push_back({"vibration",
                    "pendulum",
                    "A stiff bar swings from one edge",
                    "1 x 0.1 x 0.1 m, released when level: large swings, seven turns.",
                    "The physical pendulum; K is the complete elliptic integral of the first kind",
                    check_pendulum,
                    {"Landau1976"},
                    {R"tex(T = 4\, K\left(\sin \tfrac{\alpha}{2}\right) \sqrt{\frac{I}{m g d}})tex"}});
}

}  // namespace aspic::verify
