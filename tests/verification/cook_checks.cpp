// Cook's membrane: bending and shear in the plane with a singular corner.
#include <array>
#include <cmath>
#include <string>

#include "material/lame.h"
#include "mesh/tet_nodes.h"
#include "reference/membrane_reference.h"
#include "reference/models.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// Plane strain problem: E and nu, and the upward traction on the right edge.
struct Cook {
  std::string material;
  double young, poisson, traction;
  bool is_quadratic = false;
};

// Upward displacements at the middle and the top of the right edge.
struct Tip {
  double middle, top;
};

Tip tip(int n, const Cook& cook, const std::string& taken) {
  const double thickness = 48.0 / n;
  TetMesh mesh = make_layer(n, n, thickness, [](double x, double y) {
    return std::array{48 * x, 44 * x + y * (44 - 28 * x)};
  });
  if (cook.is_quadratic) mesh = raise_order(std::move(mesh));
  const auto is_loaded = [](const Vec3d& X) { return X[0] > 48 - 1e-9; };
  Model model = model_of(mesh, {.material = taken, .young = cook.young, .poisson = cook.poisson, .gravity = {}})
                    .pin("wall", [](const Vec3d& X) { return X[0] < 1e-9; })
                    .load(make_growing_load(traction_on(mesh, is_loaded, {{0, cook.traction, 0}})))
                    .build();
  hold_plane(model);
  const Simulation simulation = equilibrium(std::move(model), 2, "Cook's membrane", 1e-9);
  const auto mean_at = [&](double Y) {
    double sum = 0;
    const std::vector<int> at =
        vertices_where(mesh, [Y](const Vec3d& X) { return X[0] > 48 - 1e-9 && std::abs(X[1] - Y) < 1e-9; });
    for (const int v : at) sum += simulation.state().q[3 * v + 1] - Y;
    return sum / static_cast<double>(at.size());
  };
  return {mean_at(52), mean_at(60)};
}

// Limit of the last three meshes for errors of two orders: 2 of the smooth part and 1.29 of the corner.
double limit_of(const std::vector<double>& values) {
  const double* v = values.data() + values.size() - 3;
  const double a = std::exp2(2.0), b = std::exp2(1.29);
  const double first = (a * v[1] - v[0]) / (a - 1), second = (a * v[2] - v[1]) / (a - 1);  // eliminates the first order
  return (b * second - first) / (b - 1);  // eliminates the second order
}

void check_cook(const Subject& subject, Findings& found, const Cook& cook, double reference) {
  const std::vector<int> cells = subject.quick ? std::vector<int>{8, 16, 32} : std::vector<int>{16, 32, 64, 128};
  Curve curve{"linear tets", {}, {}}, limit{"reference", {}, {}, CurveStyle::dashed};
  for (const int n : cells) {
    curve.x.push_back(n), curve.y.push_back(tip(n, cook, subject.replacement(cook.material)).middle);
    limit.x.push_back(n), limit.y.push_back(reference);
  }
  const double error = reference - curve.y.back(), before = reference - curve.y[curve.y.size() - 2];
  found.expect(cook.material + ": u_y at (48, 52), limit of the last three meshes",
               {limit_of(curve.y), reference, (subject.quick ? 0.02 : 1e-3) * reference},
               "the next term of the error; the reference is known to 2e-4 of itself");
  found.expect(cook.material + ": order of the error, last two meshes", {std::log2(before / error), 1.65, 0.36},
               "between 1.29, that of the singular corner (0, 44), and 2, that of the rest");
  found.plots.push_back(
      {"Cook's membrane, " + cook.material, "cells along an edge", "u_y at (48, 52)", Scales::linear, {curve, limit}});
}

void check_logarithmic(const Subject& subject, Findings& found) {
  const Cook cook{"neo_hookean_log", 250, 0.3, 100.0 / 16};
  const Lame lame = lame_from_young_poisson(cook.young, cook.poisson);
  check_cook(subject, found, cook, membrane_reference(logarithmic_law(lame.mu, lame.lambda), cook.traction, 16));
}

void check_split(const Subject& subject, Findings& found) {
  const double mu = 422.5, poisson = 0.3, bulk = 2 * mu * (1 + poisson) / (3 * (1 - 2 * poisson));
  const Cook cook{"neo_hookean_isochoric", 2 * mu * (1 + poisson), poisson, 1000.0 / 16};
  const InvariantLaw law = split_law(mu, [bulk](double J) { return std::array{bulk * (J - 1), bulk}; });
  check_cook(subject, found, cook, membrane_reference(law, cook.traction, 16));
}

// Limit of a sequence whose errors fall by a constant factor.
double geometric_limit(double a, double b, double c) { return c + (c - b) * (c - b) / ((b - a) - (c - b)); }

// Linear tets err by 66 % on these meshes.
void check_incompressible(const Subject& subject, Findings& found) {
  const double mu = 80.1938, poisson = 0.4999;
  const Cook cook{"neo_hookean_isochoric", 2 * mu * (1 + poisson), poisson, 6.25, true};
  const int coarsest = subject.quick ? 4 : 8;
  std::array<Tip, 3> tips;
  for (int i = 0; i < 3; ++i) tips[i] = tip(coarsest << i, cook, subject.replacement(cook.material));
  const auto expect = [&](const std::string& place, double Tip::*member, double reference) {
    const double last = tips[2].*member, limit = geometric_limit(tips[0].*member, tips[1].*member, last);
    found.expect("u_y at " + place + ", limit of three meshes",
                 {limit, reference, (subject.quick ? 1e-2 : 3e-3) * reference}, "the error of the limit");
    found.expect("u_y at " + place + ", finest mesh", {last, reference, (subject.quick ? 1e-2 : 5e-3) * reference},
                 "order 1, because of the corners");
  };
  expect("(48, 52)", &Tip::middle, 6.963);
  expect("(48, 60)", &Tip::top, 6.931);
}

}  // namespace

void add_cook_checks(std::vector<Check>& checks) {
  const std::string reference =
      "Biquadratic quadrilaterals on a graded grid, which share nothing with the tets. With the volumetric energy of "
      "the source they give its 14.74";
  checks.push_back(
      {"statics",
       "cook",
       "Cook's membrane at finite strain",
       "Plane strain, neo_hookean_log, E = 250, nu = 0.3, a load of 100 on the right edge. The error of the "
       "singular corner at the wall is of order 1.29.",
       reference,
       check_logarithmic,
       {"Cook1974", "Pelteret2016", "Williams1952"}});
  checks.push_back(
      {"statics",
       "cook_published",
       "Cook's membrane as published",
       "Plane strain, neo_hookean_isochoric, mu = 422.5, nu = 0.3, a load of 1000 on the right edge: twice "
       "as large a deflection.",
       reference + "; neo_hookean_isochoric, which has K/2 (J - 1)^2 in place of its K/4 (J^2 - 1 - 2 ln J), "
                   "14.73",
       check_split,
       {"Cook1974", "Pelteret2016", "Williams1952"}});
  checks.push_back({"statics",
                    "cook_incompressible",
                    "Cook's membrane, nearly incompressible, with quadratic tets",
                    "Plane strain, neo_hookean_isochoric, mu = 80.1938, nu = 0.4999, a load of 100 on the right edge.",
                    "Biquadratic quadrilaterals with linear discontinuous pressures on a graded grid",
                    check_incompressible,
                    {"Cook1974", "Simo1985"}});
}

}  // namespace aspic::verify
