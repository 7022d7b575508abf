// Checks the derivatives of all functions that the next step minimizes: each term of V and of the damping, the inertia,
// and their sum E.
#pragma once
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "optimize/derivative_check.h"

namespace aspic {

// The result refers to V and pattern. Requires that V is bound to the pattern.
Differentiable differentiable(const ActiveTerm& V, const BlockPattern& pattern);

struct TermDerivatives {
  std::string term;   // name in Simulation::potential_names() or of a damping term, "inertia", or "E"
  std::string state;  // "start", "rest", "deformed" or "touching"
  DerivativeReport report;
  std::string unchecked = {};  // why the term was not checked: the state is outside of its domain; empty: it was
  bool is_wrong() const { return unchecked.empty() && !report.passed(); }
};

// Checks three states: the current one; near rest, with every vertex moved by a hundredth of an edge; and stretched,
// sheared and perturbed by up to 15 % as far as the materials allow. In scenes with contact, the current state is
// perturbed by up to a hundredth of an edge, and in a fourth state a body is moved until it touches. Steps are relative
// to the mean edge length. E is that of a step of backward Euler, or of statics, from the current state. Pinned
// vertices are not variables.
std::vector<TermDerivatives> check_step_derivatives(const Simulation& simulation, double tolerance = 1e-6);

// Returns the name of an entry of q: "vertex 12, y".
std::string entry_name(int entry);
// Returns an element with both vertices, or -1.
int tet_with(const TetMesh& mesh, int vertex, int other);

}  // namespace aspic
