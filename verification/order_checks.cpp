// Orders of convergence in time, with motions that linear tets represent exactly.
#include <cmath>

#include "dynamics/integrator.h"
#include "verification/families.h"
#include "verification/integrators.h"
#include "verification/manufactured.h"

namespace aspic::verify {
namespace {

double order_between(double coarse, double fine) { return std::log2(coarse / fine); }

const char* text_of(Held held) {
  constexpr const char* kTexts[] = {"free", "one face held", "all faces held"};
  return kTexts[static_cast<size_t>(held)];
}

void check_time_order(const Subject& subject, Findings& found) {
  Plot plot{"error after 0.4 s, one face held", "time step h [s]", "largest error [m]", Scales::logarithmic, {}};
  for (const std::string& integrator : integrators_in_time()) {
    const int order = make_integrator(integrator)->facts().order;
    const std::string taken = subject.replacement(integrator);
    for (const Held held : {Held::on_one_face, Held::nowhere, Held::on_the_boundary}) {
      Curve curve{integrator, {}, {}, CurveStyle::line_and_points};
      const int count = subject.quick ? 3 : 4;
      for (int i = 0; i < count; ++i) {
        curve.x.push_back((order == 4 ? 0.04 : 0.01) / (1 << i));
        curve.y.push_back(affine_motion_error(taken, curve.x.back(), held));
      }
      found.expect(integrator + ": order, " + text_of(held),
                   {order_between(curve.y[curve.y.size() - 2], curve.y.back()), static_cast<double>(order), 0.2},
                   "the next term of the error has the relative size h; it changes the order by up to 0.1");
      if (held == Held::on_one_face) plot.curves.push_back(curve);
    }
  }
  found.plots.push_back(plot);
}

void check_driven_order(const Subject& subject, Findings& found) {
  for (const std::string& integrator : integrators_in_time()) {
    const int order = make_integrator(integrator)->facts().order;
    const double h = 0.004;
    const std::string taken = subject.replacement(integrator);
    found.expect(integrator + ": order",
                 {order_between(driven_oscillator_error(taken, h), driven_oscillator_error(taken, h / 2)),
                  static_cast<double>(order), 0.1},
                 "the next term of the error at w h = 0.04");
  }
}

// Returns the last of the errors C1 h^p + C2 h^(p+1) + ..., with h halved each time, after eliminating as many terms as
// possible.
double without_terms(std::vector<double> errors, int order) {
  for (; errors.size() > 1; ++order) {
    for (size_t i = 0; i + 1 < errors.size(); ++i)
      errors[i] = (std::exp2(order) * errors[i + 1] - errors[i]) / (std::exp2(order) - 1);
    errors.pop_back();
  }
  return errors[0];
}

void check_time_floor(const Subject& subject, Findings& found) {
  found.expect_small("rk4, h = 2.5 ms: error",
                     affine_motion_error(subject.replacement("rk4"), 0.0025, Held::on_one_face), 1e-10,
                     "the fourth order is visible down to the accuracy of the solves", "m");
  const std::string taken = subject.replacement("tr_bdf2");
  const double fine = affine_motion_error(taken, 0.0005, Held::on_one_face);
  const double coarse = affine_motion_error(taken, 0.01, Held::on_one_face);
  found.expect("tr_bdf2: error at 10 ms / error at 0.5 ms", {coarse / fine, 400, 40},
               "20 times smaller steps; a tenth for the next term of the error");
  for (const std::string integrator : {"backward_euler", "bdf2", "tr_bdf2", "midpoint"}) {
    std::vector<double> errors;
    for (int i = 0; i < 6; ++i)
      errors.push_back(affine_motion_error(subject.replacement(integrator), 0.01 / (1 << i), Held::on_one_face));
    found.expect_small(integrator + ", 10 to 0.3 ms: error without its first five terms",
                       without_terms(errors, make_integrator(integrator)->facts().order), 1e-10,
                       "only powers of h from the order upward, down to the accuracy of the solves", "m");
  }
}

void check_space_order(const Subject& subject, Findings& found) {
  Plot plot{"manufactured solution, nu = 0.3", "edge of a cell h [m]", "error", Scales::logarithmic, {}};
  const std::vector<int> cells = subject.quick ? std::vector<int>{4, 8} : std::vector<int>{4, 8, 16};
  for (const MaterialInfo& info : materials()) {
    Curve l2{info.name + ", L2", {}, {}}, h1{info.name + ", H1", {}, {}};
    for (const int n : cells) {
      const SpaceError error = manufactured_error(info.name, subject.replacement(info.name), 0.3, n);
      l2.x.push_back(error.h), l2.y.push_back(error.l2);
      h1.x.push_back(error.h), h1.y.push_back(error.h1);
    }
    const double tolerance = subject.quick ? 0.15 : 0.1;
    const std::string reason = "the next term of the error has the relative size h, with 8 or 16 cells along an edge";
    found.expect(info.name + ": order in L2", {order_between(l2.y[l2.y.size() - 2], l2.y.back()), 2, tolerance},
                 reason);
    found.expect(info.name + ": order in H1", {order_between(h1.y[h1.y.size() - 2], h1.y.back()), 1, tolerance},
                 reason);
    if (info.name != "neo_hookean_log" && info.name != "stable_neo_hookean" && info.name != "stvk") continue;
    plot.curves.push_back(l2);
    plot.curves.push_back(h1);
  }
  found.plots.push_back(plot);
}

}  // namespace

void add_order_checks(std::vector<Check>& checks) {
  checks.push_back({"orders",
                    "space",
                    "Order in space by a manufactured solution",
                    "A cube of irregular tets under the body force that belongs to a smooth deformation of up to 17 % "
                    "strain, held around: errors of position and of deformation gradient, every material.",
                    "Linear elements: 2 in L2, 1 in H1",
                    check_space_order,
                    {"Roache1998"},
                    {R"tex(\|x_h - x\|_{L^2} = O(h^2), \quad \|F_h - F\|_{L^2} = O(h))tex"}});
  checks.push_back(
      {"orders",
       "time",
       "Order in time by a manufactured motion",
       "A box moves by x = X + s(t) B X under the nodal forces that keep it going, held nowhere, on one "
       "face or all around: linear tets represent the motion exactly, so only time integration has an error.",
       "The order of the scheme",
       check_time_order,
       {"Hairer1996"},
       {R"tex(x(t) = X + s(t)\, B X)tex", R"tex(\max_i |x_i - x(t)| = O(h^p))tex"}});
  checks.push_back({"orders",
                    "time_floor",
                    "Orders are measured down to the accuracy of the solves",
                    "The same motion with short steps. Halving the steps separates the terms of the error by "
                    "order; a term of a lower order would remain.",
                    "The order of the scheme",
                    check_time_floor,
                    {"Hairer1996"},
                    {R"tex(e(h) = C_1 h^p + C_2 h^{p+1} + \dots)tex"}});
  checks.push_back({"orders",
                    "time_damped",
                    "Order in time with damping and a moving target",
                    "x'' + 2 x' + 100 (x - s(t)) = 0 with s such that x = cos 3t; position and velocity after 1 s.",
                    "The order of the scheme",
                    check_driven_order,
                    {"Hairer1996"},
                    {R"tex(\ddot x + 2 \dot x + 100\, (x - s(t)) = 0, \quad x = \cos 3 t)tex"}});
}

}  // namespace aspic::verify
