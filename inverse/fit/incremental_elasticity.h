// Incremental loading with moduli that depend on strain [Bickel 2009]: f += K(E(e)) du. Each tet has a stress in its
// corotated frame. In an increment from x_0 to x
//   stress = stress_0 + C(E(e_0), nu(e_0)) (e - e_0),   forces = -volume R stress b,   e = R'F - I
// or, with StressRule::total, stress = C(E(e_0), nu(e_0)) e: secant moduli from rest. NOT the gradient of an energy:
// the stress depends on the path, a closed loop leaves work and stress, and there is no objective to minimize
// (bench/results/strain_space.md).
#pragma once
#include <span>
#include <string>
#include <vector>

#include "energy/energy.h"
#include "material/lame.h"
#include "math/small.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Corotated strain e: symmetric, 0 at rest and for every rotation.
Mat3d corotated_strain(const Mat3d& F);
Mat3d deformation_gradient(const TetMesh& mesh, const Mat3d& rest_inverse, int tet, std::span<const double> x);

struct StrainExample {
  std::string name;
  std::vector<double> young, poisson;  // per tet: linear material fitted to the example [Pa], [1]
  std::vector<double> x;               // the deformed body, 3 per vertex [m]
};

// Moduli interpolated in strain space, as [Bickel 2009] represents a nonlinear material. Examples are deformed bodies
// with fitted E and nu per tet: points in the six-dimensional space of corotated Cauchy strains e = R'F - I of each
// tet. Between them log E and nu are interpolated by radial basis functions.
//   log E(e) = c + sum_i w_i |e - e_i|,  sum_i w_i = 0,  and the same for nu(e)
// Beyond the examples the values are limited to their range, slightly widened.
class StrainSpaceModuli {
 public:
  // Throws InvalidInput without examples, or for one of another mesh.
  StrainSpaceModuli(const TetMesh& mesh, std::span<const StrainExample> examples);

  Lame at(int tet, const Mat3d& strain) const;
  int tet_count() const { return static_cast<int>(tets_.size()); }

 private:
  struct Sample {
    Mat3d strain;
    double log_young_weight, poisson_weight;
  };
  struct Tet {
    std::vector<Sample> samples;
    double log_young, poisson;  // c
    double least_log_young, largest_log_young, least_poisson, largest_poisson;
  };
  std::vector<Tet> tets_;
};

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
