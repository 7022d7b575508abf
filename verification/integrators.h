// What theory says of each integrator, and what it does.
#pragma once
#include <complex>
#include <map>
#include <string>
#include <vector>

#include "verification/models.h"

namespace aspic::verify {

std::vector<std::string> integrators_in_time();  // all but the static one

// Of a harmonic oscillator with w h = 0.1.
struct Oscillation {
  double energy_left;      // after one period, relative to that before
  double frequency_ratio;  // to the exact one
};
const std::map<std::string, Oscillation>& expected_oscillations();  // by integrator
// After its first steps: those of a scheme that begins otherwise have died away.
Oscillation measured_oscillation(const std::string& integrator);

// The fall of a free body after n steps, over g h^2.
double expected_fall(const std::string& integrator, int n);
inline constexpr int kFallSteps = 10;
// The largest difference to it of any vertex of a soft box after kFallSteps steps of 0.01 s [m].
double free_fall_error(const std::string& integrator, double expected);

// The affine motion x = X + s(t) B X, which linear tets represent exactly, kept going by the nodal forces
// M x'' + dV/dx(x): consistent mass and exact load, so all error is that of time.
enum class Held { nowhere, on_one_face, on_the_boundary };
double affine_motion_error(const std::string& integrator, double h, Held held);  // largest, after 0.4 s [m]

// A damped oscillator that is driven such that x = cos 3t: the error of position and velocity after 1 s.
double driven_oscillator_error(const std::string& integrator, double h);

}  // namespace aspic::verify
