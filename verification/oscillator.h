// Four harmonic oscillators: vertices of a tet without stiffness, 1 kg each, attached by springs to rest positions.
#pragma once
#include <complex>
#include <functional>
#include <span>

#include "verification/models.h"

namespace aspic::verify {

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

}  // namespace aspic::verify
