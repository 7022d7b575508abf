// Velocities and accelerations of pinned vertices within a step. Motions provide positions only, so these are
// derivatives of the polynomial through positions at equally spaced times, including both ends.
#pragma once
#include <span>
#include <vector>

#include "dynamics/pins.h"

namespace aspic {

class PinPath {
 public:
  // With p points, velocities are accurate to h^(p-1) and accelerations to h^(p-2). Requires 3 to 8 points.
  void sample(const Pins& pins, double time, double end_time, int points);

  // Write the pinned components of each vertex, for a time within the step, and keep the others.
  void place_velocity(double time, std::span<double> v) const { differentiate(time, 1, v); }      // [m/s]
  void place_acceleration(double time, std::span<double> a) const { differentiate(time, 2, a); }  // [m/s^2]

 private:
  void differentiate(double time, int derivative, std::span<double> out) const;

  const Pins* pins_ = nullptr;
  double time_ = 0, h_ = 0;             // start and length of the step [s]
  int points_ = 0;                      // 0: no pin moves
  std::vector<std::vector<double>> x_;  // positions of the pinned vertices at each point [m]
};

}  // namespace aspic
