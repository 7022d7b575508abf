// A grip holds vertices of a body and moves them as a rigid body: a clamp of a tensile, shear or torsion rig. Its force
// and torque on the body are the reactions dV/dx of these vertices.
#pragma once
#include <span>
#include <vector>

#include "indenter/probe.h"

namespace aspic {

struct Grip {
  std::vector<int> vertices;  // ascending; not held otherwise
  Vec3d center{};             // at rest [m]; torques are those about its moved position
  double radius = 0;          // largest distance of a vertex from the center [m]
  Vec3d displacement{};       // of the center [m]
  Vec3d rotation{};           // rotation vector about the center [rad]
};

// A motion of a body with a fraction of the displacement and of the rotation.
class GripMotion {
 public:
  GripMotion(const Grip& grip, double part);
  Vec3d operator()(const Vec3d& X) const;  // position of a vertex [m]

 private:
  Vec3d from_, to_;
  Mat3d turn_;
};

// Sum of the forces of a field at the vertices of the grip, 3 entries per vertex, and their moment. x: positions [m].
Wrench wrench_of(const Grip& grip, std::span<const double> x, std::span<const double> force);
// Its transpose: force += (d(wrench)/d(force))' wbar.
void add_wrench_of_transposed(const Grip& grip, std::span<const double> x, const Wrench& wbar, std::span<double> force);

}  // namespace aspic
