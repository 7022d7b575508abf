// An implicit step of a scene laid open: E of the step that would come next, and where it starts.
#pragma once
#include <functional>
#include <vector>

#include "dynamics/incremental_potential.h"
#include "scene/scene.h"

namespace aspic::cli::lecture {

using Vector = std::vector<double>;

struct OpenStep {
  // The step of backward Euler from where the scene stands.
  explicit OpenStep(Scene opened);
  OpenStep(const OpenStep&) = delete;
  OpenStep& operator=(const OpenStep&) = delete;

  const Model& model() const { return scene.simulation.model(); }
  int vertex_count() const { return model().mesh.vertex_count(); }

  // M (q - q~) + h^2 dV/dq, zero at pinned vertices: what an implicit step makes zero.
  Vector residual(std::span<const double> q) const;
  // A lower bound of the smallest eigenvalue of the consistent mass matrix [kg]: the element matrices have
  // rho V / 20 as their smallest one, of which a vertex collects a fifth of its mass.
  double smallest_mass() const;

  Scene scene;
  double h;                            // [s]
  Vector q_t, qdot, predicted, start;  // start: q_t with the pins where they must be at the end
  Pins pins;
  IncrementalPotential E;
};

Vector gradient_of_potential(const Model& model, std::span<const double> q);  // dV/dq, of pinned vertices too
double potential(const Model& model, std::span<const double> q);              // V(q)
Vector mass_times(const Model& model, std::span<const double> a);             // M a

double norm(std::span<const double> v);
double largest(std::span<const double> v);                                         // absolute value of an entry
Vector plus(std::span<const double> a, double factor, std::span<const double> b);  // a + factor b
Vector scaled(std::span<const double> a, double factor);
double inner(std::span<const double> a, std::span<const double> b);
// A fixed smooth displacement of the free vertices [1], of the size 1.
Vector smooth_direction(const OpenStep& step);

std::vector<char> fixed_entries(const OpenStep& step);  // marks the entries of q that belong to pinned vertices

// The exponent p of error ~ step^p: the slope between the first and the last entry, of the table.
double observed_order(const Vector& step, const Vector& error);

// The boundary where the vertices stand, for pictures.
TriMesh surface_at(const Model& model, std::span<const double> q);

}  // namespace aspic::cli::lecture
