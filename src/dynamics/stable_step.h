// Largest stable time step of an explicit scheme.
#pragma once
#include <span>

#include "dynamics/integrator_facts.h"

namespace aspic {

class IncrementalPotential;
class Pins;
struct Model;

// Return the largest stable step of x'' + c x' + k x = 0 [s]; infinite if c = k = 0. Units: c [1/s], k [1/s^2].
double symplectic_euler_limit(double c, double k);
double rk4_limit(double c, double k);  // |R(h lambda)| <= 1, R = 1 + z + z^2/2 + z^3/6 + z^4/24 [Hairer 1996]

struct StableStep {
  double h = 0;             // the largest stable step [s]; infinite without stiffness
  int vertex = -1;          // vertex with the largest displacement in the critical motion
  double frequency = 0;     // undamped frequency of the critical motion [Hz]
  bool is_damping = false;  // damping rather than stiffness limits the step
};

// Estimates the limit for small motions about the positions x by power iteration. For symplectic Euler, it is the h at
// which the largest eigenvalue of M^-1 (h^2 K + 2 h C) is 4; the estimate is at most a few percent too large. For rk4,
// it is the smaller limit of that motion and of the fastest vibration; with damping the true limit may be lower.
// Without damping, the limits are 2 and sqrt(8) divided by the highest angular frequency.
StableStep stable_step(const IncrementalPotential& E, const Model& model, const Pins& pins, std::span<const double> x,
                       StabilityLimit limit);

}  // namespace aspic
