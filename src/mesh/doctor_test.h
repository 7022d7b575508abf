// Helpers for the tests of the mesh doctor.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "mesh/doctor.h"

namespace aspic {

inline std::vector<std::string> names(const std::vector<Finding>& findings) {
  std::vector<std::string> list;
  for (const Finding& finding : findings) list.push_back(finding.name);
  return list;
}

template <class Mesh>
Finding found(const Mesh& mesh, const std::string& name) {
  for (const Finding& finding : diagnose(mesh))
    if (finding.name == name) return finding;
  ADD_FAILURE() << name << " was not found among " << testing::PrintToString(names(diagnose(mesh)));
  return {};
}

// Rotates about (1, 2, 3), so that no face stays aligned with the axes.
inline Vec3d turned(const Vec3d& x) {
  const Vec3d axis = (1 / std::sqrt(14.0)) * Vec3d{{1, 2, 3}};
  const double c = std::cos(0.7), s = std::sin(0.7);
  return c * x + s * cross(axis, x) + ((1 - c) * dot(axis, x)) * axis;
}

}  // namespace aspic
