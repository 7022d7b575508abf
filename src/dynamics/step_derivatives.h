// Whether everything that the next step minimizes has the derivatives it claims: each term of V and of the damping, the
// inertia, and their sum E.
#pragma once
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "optimize/derivative_check.h"

namespace aspic {

// Refers to both; V must have been bound to the pattern.
Differentiable differentiable(const ActiveTerm& V, const BlockPattern& pattern);

struct TermDerivatives {
  std::string term;   // a name of Simulation::potential_names(), of a damping term, "inertia", or "E"
  std::string state;  // where: "start", "rest" or "deformed"
  DerivativeReport report;
};

// At three states: the present one; near rest, every vertex moved by a hundredth of an edge; stretched, sheared and
// crumpled as far as the materials allow, up to 15 %. The steps are relative to the mean length of an edge. E is that
// of a step of backward Euler, or of statics, from the present state; its pinned vertices are no variables.
std::vector<TermDerivatives> check_step_derivatives(const Simulation& simulation, double tolerance = 1e-6);

// An entry of q in words: "vertex 12, y".
std::string entry_name(int entry);
// A tet that holds both vertices, which an entry of a Hessian couples; -1 when there is none.
int tet_with(const TetMesh& mesh, int vertex, int other);

}  // namespace aspic
