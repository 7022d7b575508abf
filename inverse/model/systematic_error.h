// A systematic error of the measurements: unlike noise, it is the same for a group of cases or for a session.
#pragma once
#include <string>

namespace aspic {

// Actual pose or motion, and readings, of an error e (the prior is normal with mean 0):
//   position      center of an indenter or grip + e along an axis              [m]    per group
//   rotation      rotation vector e, applied after the measured rotation       [rad]  per group
//   backlash      way since the touch (or rest) - e along its direction        [m]    per session
//   layer         stiffness of the layer of an indenter times exp(e)           [1]    per tip
//   tare          reading of force = exp(force_scale) (force + e)              [N]    per session
//   force_scale   the same, also for torques                                   [1]    per session
//   length_scale  reading of the motion of a marker = exp(e) motion            [1]    per session
//   friction      coefficient of friction of an indenter times exp(e)          [1]    per tip
//   rim           radius of the rim of a disc times exp(e)                     [1]    per tip
enum class ErrorKind { position, rotation, backlash, layer, tare, force_scale, length_scale, friction, rim };

struct SystematicError {
  static constexpr int kAlongGauge = 3;

  ErrorKind kind = ErrorKind::tare;
  int axis = 0;       // of position, rotation and tare: x, y, z, or along the axis of a gauge (tare)
  std::string scope;  // name of the group, session or tip
  double sigma = 0;   // standard deviation of the prior
  double value = 0;   // estimate for which the loads and readings of an experiment are corrected
};

}  // namespace aspic
