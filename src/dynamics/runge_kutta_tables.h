// Runge-Kutta schemes. A new scheme is one table here and one line in integrator.cpp.
#pragma once
#include <numbers>

#include "dynamics/runge_kutta.h"

namespace aspic {

// Implicit midpoint: conserves momenta and, for linear forces, energy.
inline constexpr Tableau kMidpoint = {
    .facts = {.name = "midpoint", .order = 2, .ends_beyond_minimum = true}, .stages = 1, .A = {{0.5}}, .b = {1}};

// Trapezoidal rule, Newmark's method with beta = 1/4 and gamma = 1/2 [Newmark 1959].
inline constexpr Tableau kTrapezoid = {.facts = {.name = "trapezoid", .order = 2, .ends_beyond_minimum = true},
                                       .stages = 2,
                                       .A = {{0}, {0.5, 0.5}},
                                       .b = {0.5, 0.5}};

// Trapezoidal rule to t + gamma h, then BDF2 to t + h, with gamma chosen such that both stages have the same beta [Bank
// 1985; Hosea 1996].
inline constexpr double kGamma = 2 - std::numbers::sqrt2, kD = kGamma / 2, kW = std::numbers::sqrt2 / 4;
inline constexpr Tableau kTrBdf2 = {.facts = {.name = "tr_bdf2", .order = 2, .ends_beyond_minimum = true},
                                    .stages = 3,
                                    .A = {{0}, {kD, kD}, {kW, kW, kD}},
                                    .b = {kW, kW, kD}};

// Classical fourth-order scheme.
inline constexpr Tableau kRk4 = {
    .facts = {.name = "rk4", .order = 4, .is_implicit = false, .stability = StabilityLimit::rk4},
    .stages = 4,
    .A = {{0}, {0.5}, {0, 0.5}, {0, 0, 1}},
    .b = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}};

}  // namespace aspic
