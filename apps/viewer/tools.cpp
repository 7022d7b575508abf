#include "viewer/tools.h"

namespace aspic::viewer {

void Hand::grab(const TetPoint& point, const Vec3d& target, Positions x) {
  held_ = {.vertices = point.vertices, .weights = point.weights, .stiffness = stiffness_};
  held_.from = held_.to = held_.point(x);
  move(target);
}

void Hand::set_stiffness(double stiffness) {
  stiffness_ = stiffness;
  if (is_grabbing()) held_.stiffness = stiffness;
}

}  // namespace aspic::viewer
