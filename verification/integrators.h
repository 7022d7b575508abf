// Theoretical and measured properties of each integrator.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "verification/models.h"

namespace aspic::verify {

std::vector<std::string> integrators_in_time();  // all integrators except the static one

// Properties for a harmonic oscillator with w h = 0.1.
struct Oscillation {
  double energy_left;      // energy after one period, relative to its start
  double frequency_ratio;  // ratio to the exact frequency
};
const std::map<std::string, Oscillation>& expected_oscillations();  // by integrator
// Measures after the first steps, when the effects of a different first step have decayed.
Oscillation measured_oscillation(const std::string& integrator);

// Fall of a free body after n steps, over g h^2.
double expected_fall(const std::string& integrator, int n);
inline constexpr int kFallSteps = 10;
// Largest deviation of a vertex of a soft box from this fall after kFallSteps steps of 0.01 s [m].
double free_fall_error(const std::string& integrator, double expected);

// Affine motion x = X + s(t) B X, which linear tets represent exactly, driven by the nodal forces M x'' + dV/dx(x).
// Consistent mass and exact loads make the error purely temporal.
enum class Held { nowhere, on_one_face, on_the_boundary };
double affine_motion_error(const std::string& integrator, double h, Held held);  // maximum until 0.4 s [m]

// Error of position and velocity after 1 s of a damped oscillator with forcing such that x = cos 3t.
double driven_oscillator_error(const std::string& integrator, double h);

}  // namespace aspic::verify
