#include "viewer/touch_place.h"

#include <algorithm>
#include <cmath>

#include "math/polar3.h"
#include "mesh/tet_shape.h"
#include "viewer/fields.h"

namespace aspic::viewer {
namespace {

constexpr double kShareOfBody = 0.08;  // radius / diagonal
constexpr double kEdges = 0.8;  // minimum of radius / mean edge: an indenter between vertices would touch one tet only
constexpr double kLayer = 100;

// The volume and Young's modulus of the elastic tets. The mean of log E limits the influence of a stiff core.
struct Elastic {
  int tets = 0;
  double volume = 0, logs = 0;  // [m^3], integral of log E

  double young() const { return std::exp(logs / volume); }
};

Elastic elastic_part(const Model& model) {
  Elastic part;
  const std::vector<double>* young = tet_field(model, "young");
  for (int t = 0; young && t < model.mesh.tet_count(); ++t) {
    if (!((*young)[t] > 0)) continue;
    const double v = volume(model.mesh, t);
    part.logs += v * std::log((*young)[t]);
    part.volume += v;
    ++part.tets;
  }
  return part;
}

Vec3d unit(const Vec3d& v) { return (1 / norm(v)) * v; }

}  // namespace

double default_stiffness(const Model& model) {
  const Elastic part = elastic_part(model);
  if (part.tets > 0) return part.young() * std::cbrt(6 * std::sqrt(2.0) * part.volume / part.tets);
  // Without elasticity: an oscillation of about 2 Hz.
  double mass = 0;
  for (const double m : model.mass->vertex_mass()) mass += m;
  return std::max(100 * mass, 1e-9);
}

double default_radius(const Surface& cage) {
  double edges = 0;
  for (const auto& [a, b] : cage.edges) edges += norm(cage.rest[a] - cage.rest[b]);
  const double edge = edges / std::max<double>(1, static_cast<double>(cage.edges.size()));
  return std::max(kShareOfBody * size_of(cage), kEdges * edge);
}

double default_layer(const Model& model, double radius) {
  const Elastic part = elastic_part(model);
  return kLayer * (part.tets > 0 ? part.young() : 1e5) / radius;
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

IndenterPose pressed(const FirstContact& touch, double depth, const Vec3d& shift) {
  IndenterPose pose = touch.begun;
  pose.center = pose.center + depth * pose.axis + shift;
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
  const Vec3d axis = R * inward;
  return {indenter, {.center = rest - back * inward, .axis = inward}, {here - back * axis, axis, rotation_vector(R)}};
}

}  // namespace aspic::viewer
