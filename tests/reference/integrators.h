// Theoretical and measured properties of each integrator.
#pragma once
#include <complex>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "reference/models.h"

namespace aspic::verify {

// Four harmonic oscillators: vertices of a tet without stiffness, 1 kg each, attached by springs to rest positions.
struct OscillatorOptions {
  double stiffness = 100;                                             // [N/m]
  double damping = 0;                                                 // per mass [1/s]
  std::function<double(double)> offset = [](double) { return 0.0; };  // x displacement of the targets over time [m]
};

Model oscillator_model(const OscillatorOptions& options = {});
// Released 1 m from its rest position.
Simulation oscillator(SimulationOptions options, const OscillatorOptions& physics = {});

inline double oscillator_position(const Simulation& s) { return s.state().q[0]; }  // position of the first vertex [m]
inline double oscillator_velocity(const Simulation& s) { return s.state().qdot[0]; }  // [m/s]
double oscillator_energy(const Simulation& s);  // v^2 / 2 + 100 x^2 / 2 of the first vertex with default options [J]

// Factor r of a solution x_n = Re(c r^n), from four positions: x_(n+1) = 2 Re(r) x_n - |r|^2 x_(n-1), twice.
std::complex<double> factor_per_step(std::span<const double> x);

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
