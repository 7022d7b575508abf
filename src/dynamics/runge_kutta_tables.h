// Runge-Kutta schemes. A new scheme is one table here and one line in integrator.cpp.
#pragma once
#include <numbers>

#include "dynamics/runge_kutta.h"

namespace aspic {

// Implicit midpoint: conserves momenta and, for linear forces, energy.
inline constexpr Tableau kMidpoint = {
    .facts =
        {.name = "midpoint",
         .tex =
             R"tex(\begin{gathered} v_{i+1} = v_i + h\, a\!\left(\tfrac12 (q_i + q_{i+1})\right) \\ q_{i+1} = q_i + \tfrac{h}{2} (v_i + v_{i+1}) \end{gathered})tex",
         .order = 2,
         .ends_beyond_minimum = true},
    .stages = 1,
    .A = {{0.5}},
    .b = {1}};

// Trapezoidal rule, Newmark's method with beta = 1/4 and gamma = 1/2 [Newmark 1959].
inline constexpr Tableau kTrapezoid = {
    .facts =
        {.name = "trapezoid",
         .tex =
             R"tex(\begin{gathered} v_{i+1} = v_i + \tfrac{h}{2} (a_i + a_{i+1}) \\ q_{i+1} = q_i + \tfrac{h}{2} (v_i + v_{i+1}) \end{gathered})tex",
         .order = 2,
         .ends_beyond_minimum = true},
    .stages = 2,
    .A = {{0}, {0.5, 0.5}},
    .b = {0.5, 0.5}};

// Trapezoidal rule to t + gamma h, then BDF2 to t + h, with gamma chosen such that both stages have the same beta [Bank
// 1985; Hosea 1996].
inline constexpr double kGamma = 2 - std::numbers::sqrt2, kD = kGamma / 2, kW = std::numbers::sqrt2 / 4;
inline constexpr Tableau kTrBdf2 = {
    .facts =
        {.name = "tr_bdf2",
         .tex =
             R"tex(\begin{gathered} y_\gamma = y_i + \tfrac{\gamma h}{2} (\dot y_i + \dot y_\gamma) \\ y_{i+1} = y_i + w h (\dot y_i + \dot y_\gamma) + \tfrac{\gamma h}{2} \dot y_{i+1} \\ y = (q, v), \quad \gamma = 2 - \sqrt2, \quad w = \tfrac{\sqrt2}{4} \end{gathered})tex",
         .order = 2,
         .minimizes_twice = true,
         .ends_beyond_minimum = true},
    .stages = 3,
    .A = {{0}, {kD, kD}, {kW, kW, kD}},
    .b = {kW, kW, kD}};

// Classical fourth-order scheme.
inline constexpr Tableau kRk4 = {
    .facts =
        {.name = "rk4",
         .tex =
             R"tex(\begin{gathered} y_{i+1} = y_i + \tfrac{h}{6} (k_1 + 2 k_2 + 2 k_3 + k_4) \\ k_1 = f(y_i), \quad k_2 = f(y_i + \tfrac{h}{2} k_1) \\ k_3 = f(y_i + \tfrac{h}{2} k_2), \quad k_4 = f(y_i + h k_3) \\ y = (q, v), \quad f(y) = (v, a) \end{gathered})tex",
         .order = 4,
         .is_implicit = false,
         .stability = StabilityLimit::rk4},
    .stages = 4,
    .A = {{0}, {0.5}, {0, 0.5}, {0, 0, 1}},
    .b = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}};

}  // namespace aspic
