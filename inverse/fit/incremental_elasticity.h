// Incremental loading with moduli that depend on strain [Bickel 2009]: f += K(E(e)) du. Each tet has a stress in its
// corotated frame. In an increment from x_0 to x
//   stress = stress_0 + C(E(e_0), nu(e_0)) (e - e_0),   forces = -volume R stress b,   e = R'F - I
// or, with StressRule::total, stress = C(E(e_0), nu(e_0)) e: secant moduli from rest. NOT the gradient of an energy:
// the stress depends on the path, a closed loop leaves work and stress, and there is no objective to minimize
// (docs/bickel.md).
#pragma once
#include <span>
#include <vector>

#include "energy/energy.h"
#include "fit/strain_space.h"

namespace aspic {

enum class StressRule { incremental, total };

class IncrementalElasticity {
 public:
  // Stores references to both. Starts at rest, without stress.
  IncrementalElasticity(const TetMesh& mesh, const StrainSpaceModuli& moduli,
                        StressRule rule = StressRule::incremental);

  void add_gradient(std::span<const double> x,
                    std::span<double> g) const;  // in the current increment; the negative forces
  void add_couplings(Couplings& couplings) const;
  void add_stiffness(std::span<const double> x, BlockSparse& H) const;  // warped: R C R', without dR and the stress
  // Ends the increment at x; the next one uses the moduli of its strains.
  void accept(std::span<const double> x);
  double work() const { return work_; }  // accumulated work on the tets in accepted increments [J]
  const Mat3d& stress(int tet) const { return tets_[tet].stress; }  // in the corotated frame [Pa]

 private:
  struct State {
    Mat3d rest_inverse;
    double volume;
    Lame moduli;
    Mat3d strain{}, stress{};  // at the start of the increment
  };
  Mat3d stress_at(const State& tet, const Mat3d& strain) const;

  const TetMesh& mesh_;
  const StrainSpaceModuli& moduli_;
  StressRule rule_;
  std::vector<State> tets_;
  double work_ = 0;
};

}  // namespace aspic
