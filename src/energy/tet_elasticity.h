// V(x) = sum over tets of volume * psi(F), F = Ds Dm^-1: linear tetrahedra of any registered material.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "energy/damping.h"
#include "energy/energy.h"
#include "material/registry.h"
#include "mesh/tet_mesh.h"

namespace aspic {

// Fields per tet, in the order of the mesh.
struct TetFields {
  std::vector<double> energy_density;  // psi [J/m^3]
  std::vector<double> det_F;           // J [1]
  std::vector<double> cauchy;          // 6 per tet: xx yy zz xy yz zx [Pa]
  std::vector<double> von_mises;       // [Pa]
};

class TetElasticity : public SteadyEnergy {
 public:
  virtual double min_det_F(Positions x) const = 0;                  // minimum det F over all tets [1]
  virtual bool excludes_inversion() const { return false; }         // infinite at some points where det F <= 0
  virtual void evaluate(Positions x, TetFields& fields) const = 0;  // writes the entries of this term's tets

  // Returns the energy of the same tets of another mesh, such as one of quadratic tets; null: there is none.
  virtual std::unique_ptr<TetElasticity> on(const TetMesh&) const { return nullptr; }

  // The parameters theta: for each tet of this term, mu, lambda and the entries of MaterialInfo::extra, tet by tet.
  virtual int parameter_count() const = 0;                                          // per tet
  virtual std::vector<MaterialParameters> parameters() const = 0;                   // one per tet
  virtual void set_parameters(std::span<const MaterialParameters> parameters) = 0;  // one per tet
};

// Returns the elastic energy of tets [first, first + parameters.size()) of the mesh, which need not outlive it. Throws
// InvalidInput for an unknown material.
std::unique_ptr<TetElasticity> make_tet_elasticity(std::string_view material, const TetMesh& mesh, int first,
                                                   std::span<const MaterialParameters> parameters);

// Factory for a material that is not identified by name.
using ElasticityMaker = std::function<std::unique_ptr<TetElasticity>(const TetMesh& mesh, int first,
                                                                     std::span<const MaterialParameters> parameters)>;

// Kelvin-Voigt damping, rotation invariant: D(x) = h sum volume eta/2 |Edot|^2 with Edot = (E - E_start) / h and E =
// (F'F - I) / 2. `viscosity`: eta of each tet [Pa s], the coefficients of the term.
std::unique_ptr<Damping> make_strain_rate_damping(const TetMesh& mesh, int first, std::span<const double> viscosity);

}  // namespace aspic
