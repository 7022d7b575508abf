// Models with contact for the checks.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "contact/barrier.h"
#include "reference/models.h"
#include "verification/check.h"

namespace aspic::verify {

inline constexpr double kGravity = 9.81;  // [m/s^2]

struct TouchingBody {
  TetMesh mesh;
  double young = 1e6, density = 1000;  // [Pa], [kg/m^3]
  // Boundary triangles whose corners all satisfy it can touch; empty: all.
  std::function<bool(const Vec3d&)> touches = {};
};

// A plane with a free side, which moves at constant velocity.
struct Wall {
  Vec3d origin, normal, velocity;  // [m], [1], [m/s]
};

struct TouchingModel {
  std::vector<TouchingBody> bodies;
  bool has_floor = false;  // the plane y = 0
  std::vector<Wall> walls = {};
  std::string material = "neo_hookean_log";
  double poisson = 0.3;
  double friction = 0, creep = 0;  // creep [m/s]; 0: the default
  ContactOptions contact = {};
  Vec3d gravity = {};  // [m/s^2]
};

// The bodies follow one another in one mesh with one mass matrix and one elastic term.
Model make_touching(const TouchingModel& given);

// Returns [first, end) of the vertices of a body of `given`.
std::pair<int, int> vertices_of(const TouchingModel& given, size_t body);

// Mean of values per vertex, such as positions or velocities, with the masses of the vertices first to end - 1.
Vec3d mass_mean(const Model& model, std::span<const double> values, int first, int end);
Vec3d mass_mean(const Model& model, std::span<const double> values);

// Resultant of all contact forces on the model [N].
Vec3d contact_force(const Simulation& simulation);

// Expects contacts, positive gaps, and by exact predicates no intersections.
void expect_contact(const std::string& name, const Simulation& simulation, Findings& found);

// The gap at which the barrier exerts the pressure p: kappa |b'(gap)| = p.
double gap_of_pressure(const ContactLaw& law, double p);

}  // namespace aspic::verify
