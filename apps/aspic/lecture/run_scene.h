// Runs a scene to its end and collects its step reports.
#pragma once
#include <functional>
#include <limits>
#include <vector>

#include "aspic/mesh_picture.h"
#include "dynamics/incremental_potential.h"
#include "dynamics/step_report.h"
#include "math/vectors.h"
#include "scene/scene.h"

namespace aspic::cli::lecture {

using Vector = std::vector<double>;

// Access to an implicit step of a scene: the objective E of the next step and its initial guess.
struct OpenStep {
  // Prepares a step of backward Euler from the state of the scene.
  explicit OpenStep(Scene opened);
  OpenStep(const OpenStep&) = delete;
  OpenStep& operator=(const OpenStep&) = delete;

  const Model& model() const { return scene.simulation.model(); }
  int vertex_count() const { return model().mesh.vertex_count(); }

  // M (q - q~) + h^2 dV/dq, zero at pinned vertices: the residual of an implicit step.
  Vector residual(std::span<const double> q) const;
  // Returns a lower bound of the smallest eigenvalue of the consistent mass matrix [kg]: element matrices have the
  // smallest eigenvalue rho V / 20, of which a vertex collects a fifth of its mass.
  double smallest_mass() const;

  Scene scene;
  double h;                            // [s]
  Vector q_t, qdot, predicted, start;  // start: q_t with the pins at their final positions
  Pins pins;
  IncrementalPotential E;
};

Vector gradient_of_potential(const Model& model, std::span<const double> q);  // dV/dq, including pinned vertices
double potential(const Model& model, std::span<const double> q);              // V(q)
Vector mass_times(const Model& model, std::span<const double> a);             // M a

Vector plus(std::span<const double> a, double factor, std::span<const double> b);  // a + factor b
Vector scaled(std::span<const double> a, double factor);
// Fixed smooth displacement of the free vertices with amplitude 1.
Vector smooth_direction(const OpenStep& step);

std::vector<char> fixed_entries(const OpenStep& step);  // marks the entries of pinned vertices in q

// Exponent p of error ~ step^p: slope between the first and the last entry.
double observed_order(const Vector& step, const Vector& error);

// Boundary at the given positions, for pictures.
TriMesh surface_at(const Model& model, std::span<const double> q);

// Bodies and obstacles as one surface, and the speed of each vertex; NaN for obstacles.
ShadedSurface all_surfaces(const Simulation& simulation);

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();  // for bounds of round-off

struct Run {
  std::vector<StepReport> reports;
  int unconverged = 0, iterations = 0;
  double largest_energy = 0;        // kinetic + potential [J]; +inf if it is not finite in a step
  double largest_ledger_error = 0;  // relative to the largest energy flow of the step
};

using AfterStep = std::function<void(const StepReport&)>;

// Simulates `steps` steps; stops after an undefined one.
Run run(Simulation& simulation, int steps, const AfterStep& after = {}, const IterationObserver& observe = {});

// Returns the scene in motion, after a few steps.
Scene in_motion(Scene scene, int steps = 5);

}  // namespace aspic::cli::lecture
