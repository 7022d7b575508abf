#include "bench/indenter_place.h"

#include <algorithm>
#include <cmath>

#include "data/unstated_values.h"
#include "math/polar3.h"
#include "mesh/elements.h"
#include "mesh/tet_shape.h"
#include "viewer/default_stiffness.h"
#include "viewer/fields.h"

namespace aspic::bench {
namespace {

constexpr double kEdges = 0.8;  // minimum of radius / mean edge: an indenter between vertices would touch one tet only
constexpr double kLayer = 100;  // stiffness times radius over E: gives way by 1 / 130 of the depth of a flat punch

Vec3d unit(const Vec3d& v) { return (1 / norm(v)) * v; }

}  // namespace

double default_radius(const Surface& cage) {
  double edges = 0;
  for (const auto& [a, b] : cage.edges) edges += norm(cage.rest[a] - cage.rest[b]);
  const double edge = edges / std::max<double>(1, static_cast<double>(cage.edges.size()));
  return std::max(kUsualRadius * viewer::size_of(cage), kEdges * edge);
}

double default_layer(const Model& model, double radius) {
  return kLayer * viewer::mean_young(model).value_or(1e5) / radius;
}

Vec3d rotation_vector(const Mat3d& R) {
  const Vec3d twice_sine = {{R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)}};
  const double sine = norm(twice_sine) / 2, cosine = (trace(R) - 1) / 2;
  const double angle = std::atan2(sine, cosine);
  if (cosine > -0.9) return (sine > 1e-9 ? angle / (2 * sine) : 0.5) * twice_sine;
  // Near a rotation by pi: (R + R') / 2 - cos I = (1 - cos) a a'.
  const Mat3d A = 0.5 * (R + transpose(R)) - cosine * identity3<double>();
  int best = 0;
  for (int c = 1; c < 3; ++c)
    if (A(c, c) > A(best, best)) best = c;
  const Vec3d a = unit({{A(0, best), A(1, best), A(2, best)}});
  return (dot(a, twice_sine) < 0 ? -angle : angle) * a;
}

IndenterPose pressed(const FirstContact& touch, double depth) {
  IndenterPose pose = touch.begun;
  pose.center = pose.center + depth * pose.axis;
  return pose;
}

FirstContact touch_at(const Model& model, const Surface& cage, const SurfacePoint& point, const Indenter& indenter,
                      std::span<const double> x) {
  const Triangle& corners = cage.triangles[point.triangle];
  const Vec3d &A = cage.rest[corners[0]], &B = cage.rest[corners[1]], &C = cage.rest[corners[2]];
  const Vec3d inward = -1.0 * unit(cross(B - A, C - A));
  const Mat3d R = closest_rotation(deformation_gradient(model.mesh, cage.tet[point.triangle], x));
  Vec3d rest{}, here{};
  for (int c = 0; c < 3; ++c) {
    rest = rest + point.weights[c] * cage.rest[corners[c]];
    here = here + point.weights[c] * cage.position(corners[c], x);
  }
  const double back = indenter.shape == IndenterShape::sphere ? indenter.radius : 0;
  const Vec3d rotation = rotation_vector(R), axis = PlacedIndenter({.rotation = rotation}).turn * inward;
  return {indenter, {.center = rest - back * inward, .axis = inward}, {here - back * axis, axis, rotation}};
}

}  // namespace aspic::bench
