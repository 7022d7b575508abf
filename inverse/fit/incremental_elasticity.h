// Incremental loading with moduli that follow the strain [Bickel 2009]: f += K(E(e)) du. Each tet carries a stress in
// its co-rotated frame, and in an increment from x_0 to x
//   stress = stress_0 + C(E(e_0), nu(e_0)) (e - e_0),   forces = -volume R stress b,   e = R'F - I
// or, with StressRule::total, stress = C(E(e_0), nu(e_0)) e: the moduli are those of the whole way from rest.
// NOT the gradient of an energy: what the stress is depends on the path, a closed loop leaves work and stress behind,
// and there is no value to minimize (docs/bickel.md).
#pragma once
#include <span>
#include <vector>

#include "energy/energy.h"
#include "fit/strain_space.h"

namespace aspic {

enum class StressRule { incremental, total };

class IncrementalElasticity {
 public:
  // Refers to both. At rest, without stress.
  IncrementalElasticity(const TetMesh& mesh, const StrainSpaceModuli& moduli,
                        StressRule rule = StressRule::incremental);

  void add_gradient(std::span<const double> x,
                    std::span<double> g) const;  // of the present increment; minus the forces
  void add_couplings(Couplings& couplings) const;
  void add_stiffness(std::span<const double> x, BlockSparse& H) const;  // warped: R C R', without dR and the stress
  // Ends the increment at x; the next one begins there with the moduli of its strains.
  void accept(std::span<const double> x);
  double work() const { return work_; }  // done on the tets in all increments that were accepted [J]
  const Mat3d& stress(int tet) const { return tets_[tet].stress; }  // in the co-rotated frame [Pa]

 private:
  struct State {
    Mat3d rest_inverse;
    double volume;
    Lame moduli;
    Mat3d strain{}, stress{};  // where the increment began
  };
  Mat3d stress_at(const State& tet, const Mat3d& strain) const;

  const TetMesh& mesh_;
  const StrainSpaceModuli& moduli_;
  StressRule rule_;
  std::vector<State> tets_;
  double work_ = 0;
};

}  // namespace aspic
