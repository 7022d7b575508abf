// Derivatives at one point: all materials at ordinary and extreme deformation gradients.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "material/list.h"
#include "material/registry.h"
#include "material/states.h"
#include "math/jet.h"
#include "math/vectors.h"
#include "optimize/derivative_check.h"
#include "reference/models.h"
#include "reference/uniaxial.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// A material with constants that differ from each other and from their defaults.
struct Law {
  MaterialInfo info;
  double (*psi)(const Mat3d& F);                  // energy density [J/m^3]
  Mat3d (*pk1)(const Mat3d& F);                   // as implemented by the library [Pa]
  Mat9d (*hessian)(const Mat3d& F);               //
  Jet<double> (*differentiated)(const Mat3d& F);  // psi and its derivatives by automatic differentiation of psi
  std::vector<NamedState> states;                 // states where psi is twice differentiable
};

template <class M>
Law make_law() {
  return {
      M::info(),
      [](const Mat3d& F) { return M::psi(F, ordinary_params<M>()); },
      [](const Mat3d& F) { return M::pk1(F, ordinary_params<M>()); },
      [](const Mat3d& F) { return M::hessian(F, ordinary_params<M>()); },
      [](const Mat3d& F) { return M::psi(jet_variables(F), broadcast_params<M, Jet<double>>(ordinary_params<M>())); },
      smooth_states<M>()};
}

// Throws InvalidInput for an unknown material.
const Law& law(const std::string& material) {
  static const std::map<std::string, Law> laws = [] {
    std::map<std::string, Law> all;
    for_each_material([&all]<class M>() { all.emplace(M::info().name, make_law<M>()); });
    return all;
  }();
  return laws.at(material_info(material).name);
}

std::string kind_of(const NamedState& state) { return state.name.substr(0, state.name.find(',')); }

// States by kind, in order of first appearance.
std::vector<std::pair<std::string, std::vector<Mat3d>>> by_kind(const std::vector<NamedState>& states) {
  std::vector<std::pair<std::string, std::vector<Mat3d>>> kinds;
  for (const NamedState& state : states) {
    const std::string kind = kind_of(state);
    auto found = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == kind; });
    if (found == kinds.end()) found = kinds.insert(kinds.end(), {kind, {}});
    found->second.push_back(state.F);
  }
  return kinds;
}

// States where psi need not be differentiable: unless smooth for a material, refused or with finite values.
struct Edge {
  const char* name;
  Mat3d F;
};
const std::array<Edge, 4> kEdges = {{{"F = 0", {}},
                                     {"J < 0, mirror image", {{1, 0, 0, 0, 1, 0, 0, 0, -1}}},
                                     {"J = 1e-8, flat", {{1, 0, 0, 0, 1, 0, 0, 0, 1e-8}}},
                                     {"|F| = 1e6", {{1e6, 0, 0, 0, 1, 0, 0, 0, 1}}}}};

// Errors of psi, P and H, relative to the stiffness and |F|; NaN if one is.
double automatic_error(const Law& own, const Law& taken, const Mat3d& F) {
  const Jet<double> expected = own.differentiated(F);
  const Mat9d H = hessian(expected);
  double stiffness = max_abs(H.a);
  if (stiffness == 0) stiffness = max_abs(own.hessian(identity3<double>()).a);  // stable_neo_hookean at F = 0
  const double size = 1 + std::sqrt(squared_norm(F));
  const double errors[] = {std::abs(taken.psi(F) - expected.value) / (stiffness * size * size),
                           largest_difference(taken.pk1(F).a, gradient(expected).a) / (stiffness * size),
                           largest_difference(taken.hessian(F).a, H.a) / stiffness};
  return max_abs(errors);
}

void check_automatic(const Subject& subject, Findings& found) {
  const std::string reason = "round-off, relative to the stiffness and to |F|";
  for (const MaterialInfo& info : materials()) {
    const Law &own = law(info.name), &taken = law(subject.replacement(info.name));
    for (const auto& [kind, states] : by_kind(own.states)) {
      std::vector<double> errors;
      for (const Mat3d& F : states) errors.push_back(automatic_error(own, taken, F));
      found.expect_small(info.name + ", " + kind + ": psi, P and H", max_abs(errors), 1e-12, reason);
    }
  }
}

// Documented values where there is no derivative to compare.
void check_edges(const Subject& subject, Findings& found) {
  for (const MaterialInfo& info : materials()) {
    const Law &own = law(info.name), &taken = law(subject.replacement(info.name));
    for (const auto& [name, F] : kEdges) {
      const auto is_here = [&name = name](const NamedState& state) { return state.name == name; };
      if (std::any_of(own.states.begin(), own.states.end(), is_here)) continue;
      const double psi = taken.psi(F);
      const bool is_finite = std::isfinite(psi + max_abs(taken.pk1(F).a) + max_abs(taken.hessian(F).a));
      if (info.barrier)
        found.expect(info.name + ", " + name + ": refused with psi = +inf" + (determinant(F) > 0 ? " or finite" : ""),
                     {(std::isinf(psi) && psi > 0) || (determinant(F) > 0 && is_finite) ? 1.0 : 0.0, 1, 0},
                     "yes or no; the value of the formula, or overflow");
      else
        found.expect(info.name + ", " + name + ": psi, P and H are finite", {is_finite ? 1.0 : 0.0, 1, 0},
                     "yes or no; the closest rotation jumps there, so there is no derivative");
    }
  }
}

// psi(F + F S) as a function of S, so that steps are small compared with every stretch; psi(S) at F = 0. The
// derivatives are those of `taken`.
Differentiable around(const Law& own, const Law& taken, const Mat3d& F) {
  const Mat3d A = squared_norm(F) > 0 ? F : identity3<double>();
  const auto matrix = [](std::span<const double> s) {
    Mat3d S;
    std::copy(s.begin(), s.end(), S.a);
    return S;
  };
  const auto at = [=](std::span<const double> s) { return F + A * matrix(s); };
  return {[=, &own](std::span<const double> s) { return own.psi(at(s)); },
          [=, &taken](std::span<const double> s, std::span<double> g) {
            const Mat3d P = transpose(A) * taken.pk1(at(s));
            std::copy(P.a, P.a + 9, g.begin());
          },
          [=, &taken](std::span<const double> s, std::span<const double> d, std::span<double> Hd) {
            const Mat3d dF = A * matrix(d);
            const Mat9d H = taken.hessian(at(s));
            Mat3d dP{};
            for (int c = 0; c < 9; ++c)
              for (int r = 0; r < 9; ++r) dP.a[r] += H(r, c) * dF.a[c];
            dP = transpose(A) * dP;
            std::copy(dP.a, dP.a + 9, Hd.begin());
          }};
}

void check_slopes(const Subject& subject, Findings& found) {
  const std::vector<double> here(9, 0.0);
  Findings orders;  // appended after the errors
  for (const MaterialInfo& info : materials()) {
    const Law &own = law(info.name), &taken = law(subject.replacement(info.name));
    for (const auto& [kind, states] : by_kind(own.states)) {
      double order = NAN, smallest = 0;  // lowest order; largest of the smallest errors
      for (const Mat3d& F : states) {
        const DerivativeReport report = check_derivatives(around(own, taken, F), here, {.length = 0.1});
        for (const DerivativeCheck* check : {&report.gradient, &report.hessian}) {
          smallest = std::fmax(smallest, check->smallest_error);
          order = std::fmin(order, check->order);
        }
      }
      found.expect_small(info.name + ", " + kind + ": smallest error of a difference", smallest, 1e-5,
                         "where the error h^2 of the difference meets its round-off, 1e-16 / h of psi, which is 1e5 of "
                         "what it changes by where |F| = 2e-3");
      if (!std::isnan(order))
        orders.expect(info.name + ", " + kind + ": lowest order", {order, 2, 0.2},
                      "a line fitted over the decades before round-off");
    }
  }
  found.rows.insert(found.rows.end(), orders.rows.begin(), orders.rows.end());
}

}  // namespace

void add_point_checks(std::vector<Check>& checks) {
  const std::string states =
      "Every material at F = I, at random F, with equal singular values, at J = 1e-8, at J < 0, at F = 0 and at "
      "|F| = 1e6, rotated.";
  checks.push_back({"derivatives", "automatic", "Stress and Hessian against automatic differentiation", states,
                    "The energy density, differentiated by forward automatic differentiation of its source",
                    check_automatic});
  checks.push_back({"derivatives",
                    "taylor",
                    "Stress and Hessian against central differences at a point",
                    states + " Steps are relative to F.",
                    "Taylor's theorem",
                    check_slopes,
                    {},
                    {R"tex(\frac{f(x + h) - f(x - h)}{2 h} = \frac{df}{dx} + O(h^2))tex"}});
  checks.push_back({"derivatives", "edges", "Where a material has no derivative",
                    "Barriers refuse inverted and collapsed tets; elsewhere everything stays finite.",
                    "The documentation of each material", check_edges});
}

}  // namespace aspic::verify
