// Velocities and accelerations of pinned vertices within a step. A motion is known by its positions only, so they are
// derivatives of the polynomial through its positions at equally spaced times, ends included.
#pragma once
#include <span>
#include <vector>

#include "dynamics/pins.h"

namespace aspic {

class PinPath {
 public:
  // With p points velocities are right to h^(p-1), accelerations to h^(p-2). At least 3 points, at most 8.
  void sample(const Pins& pins, double time, double end_time, int points);

  // Write what the pins hold of each vertex and nothing else, for a time within the step.
  void place_velocity(double time, std::span<double> v) const { differentiate(time, 1, v); }      // [m/s]
  void place_acceleration(double time, std::span<double> a) const { differentiate(time, 2, a); }  // [m/s^2]

 private:
  void differentiate(double time, int derivative, std::span<double> out) const;

  const Pins* pins_ = nullptr;
  double time_ = 0, h_ = 0;             // of the step [s]
  int points_ = 0;                      // 0: nothing moves
  std::vector<std::vector<double>> x_;  // per point, the positions of the pinned vertices [m]
};

}  // namespace aspic
