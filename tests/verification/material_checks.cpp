// Materials at one point: stress under uniaxial stretch.
#include <algorithm>
#include <cmath>

#include "reference/models.h"
#include "reference/uniaxial.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

std::string number(double x) {
  std::string text = std::to_string(x);
  text.erase(text.find_last_not_of('0') + 1);
  return text.back() == '.' ? text + "0" : text;
}

StretchedBox measured(const Subject& subject, const std::string& material, double poisson, double l,
                      const Uniaxial& expected) {
  const std::string taken = subject.replacement(material);
  return stretched_box(taken, material_parameters(taken, {.young = 1, .poisson = poisson}), l, expected.lateral);
}

void check_table(const Subject& subject, Findings& found) {
  double inner = 0;
  for (const UniaxialReference& row : uniaxial_table()) {
    const StretchedBox box = measured(subject, row.material, row.poisson, row.stretch, row.expected);
    inner = std::max(inner, box.inner_force);
    const std::string what =
        std::string(row.material) + ", nu = " + number(row.poisson) + ", l = " + number(row.stretch);
    const std::string reason = "half of the last printed digit of the reference";
    found.expect(what + ": lateral stretch", {box.lateral, row.expected.lateral, 0.51e-8}, reason);
    found.expect(what + ": stress / E", {box.stress, row.expected.stress, 0.51e-8}, reason);
  }
  found.expect_small("largest force on the free vertex inside, relative", inner, 1e-13,
                     "round-off: linear tets represent the exact state");
}

Plot stress_plot(const Subject& subject) {
  Plot plot{"uniaxial stress, nu = 0.3 (lines: reference)", "stretch l", "P / E", Scales::linear, {}};
  for (const char* material : {"neo_hookean_log", "neo_hookean", "stable_neo_hookean", "corotated", "stvk", "fung"}) {
    Curve line{"", {}, {}, CurveStyle::line}, points{material, {}, {}, CurveStyle::points};
    for (double l = 0.5; l < 1.81; l += 0.05) {
      line.x.push_back(l);
      const Uniaxial expected = uniaxial_of_energy(material, 1, 0.3, l);
      line.y.push_back(expected.stress);
      points.x.push_back(l);
      points.y.push_back(measured(subject, material, 0.3, l, expected).stress);
    }
    line.color = points.color = static_cast<int>(plot.curves.size() / 2);
    plot.curves.push_back(line);
    plot.curves.push_back(points);
  }
  return plot;
}

void check_formulas(const Subject& subject, Findings& found) {
  for (const MaterialInfo& info : materials()) {
    double lateral = 0, stress = 0;
    for (const double poisson : {0.0, 0.3, 0.45})
      for (const double l : {0.7, 0.85, 1.2, 1.5}) {
        const Uniaxial expected = uniaxial_of_energy(info.name, 1, poisson, l);
        const StretchedBox box = measured(subject, info.name, poisson, l, expected);
        lateral = std::max(lateral, std::abs(box.lateral - expected.lateral));
        stress = std::max(stress, std::abs(box.stress - expected.stress));
      }
    const std::string reason = "the differences of the reference err by 1e-14, amplified by the stiffening of fung";
    found.expect_small(info.name + ": lateral stretch, largest error", lateral, 1e-10, reason);
    found.expect_small(info.name + ": stress / E, largest error", stress, 1e-10, reason);
  }
  found.plots.push_back(stress_plot(subject));
}

}  // namespace

void add_material_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"materials", "uniaxial_table", "Uniaxial stretch with free sides: the printed table",
       "A box of distorted linear tets is stretched to l; its width t is found where the sides are free of force.",
       "A table that was computed independently of this program, to 8 decimals", check_table});
  checks.push_back(
      {"materials",
       "uniaxial",
       "Uniaxial stretch with free sides: every material",
       "The same for every material at nu = 0, 0.3, 0.45 and l = 0.7, 0.85, 1.2, 1.5.",
       "The printed formula in principal stretches, differentiated numerically in long double",
       check_formulas,
       {},
       {R"tex(P = \frac{\partial}{\partial l} \psi(l, t, t), \quad \frac{\partial}{\partial t} \psi(l, t, t) = 0)tex"}});
}

}  // namespace aspic::verify
