// Maps the parameters p of a fit to the material of every tet.
//   p -> z = W p: each fitted quantity in each tet on its fitted scale (log E, ...), see quantity_scale.h
//     -> E, nu, extra -> mu, lambda, extra
// Two tilts per value turn the direction of fibres, see tangent_frame.h; the reference direction of a tet is its known
// one.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "material/registry.h"
#include "mesh/tet_mesh.h"
#include "model/field_basis.h"

namespace aspic {

enum class Parameterization {
  uniform,
  regions,
  handles,
  tets
};  // uniform; per region; radial basis functions; per tet

// A fitted quantity: "young", "poisson", one of the material's own (MaterialInfo::extra), or a tilt. Positive ones are
// fitted as logarithms, bounded ones by a smooth map of the line to their range.
struct FitParameter {
  std::string quantity = "young";
  Parameterization parameterization = Parameterization::tets;
  int handles = 0;         // number of radial basis functions, for Parameterization::handles
  double guess = 1e5;      // initial guess [SI]
  double prior_sigma = 0;  // of values that are uniform or per region, on the fitted scale; 0: that of the regularizer
};

class ParameterMap {
 public:
  // `known`: parameters of every tet before fitting. Throws InvalidInput.
  ParameterMap(const TetMesh& mesh, std::string material, std::vector<MaterialParameters> known,
               std::vector<FitParameter> parameters);
  ~ParameterMap();
  ParameterMap(ParameterMap&&) noexcept;

  int size() const;  // number of entries of p
  int tet_count() const;
  int parameters_per_tet() const;  // mu, lambda and the material's own
  const std::vector<FitParameter>& fitted_parameters() const;
  const std::string& material() const;
  std::span<const double> guess() const;           // size() numbers
  std::pair<int, int> range(int parameter) const;  // its entries in p: first, count
  const FieldBasis& basis(int parameter) const;

  std::vector<MaterialParameters> parameters(std::span<const double> p) const;  // one per tet
  // Computes dtheta = dtheta/dp dp at p, parameters_per_tet() values per tet, and pbar += (dtheta/dp)' thetabar.
  void multiply(std::span<const double> p, std::span<const double> dp, std::span<double> dtheta) const;
  void add_transposed(std::span<const double> p, std::span<const double> thetabar, std::span<double> pbar) const;

  // The values in each tet of one parameter, as it is fitted (log E) and in SI units (E).
  std::vector<double> fitted_values(int parameter, std::span<const double> p) const;
  std::vector<double> values(int parameter, std::span<const double> p) const;
  double value(int parameter, double fitted) const;           // in SI units; increases with `fitted`
  double place_in_range(int parameter, double fitted) const;  // -1 to 1 between its ends; 0: unbounded
  // Derivatives of fitted_values, which is linear in p, and its sparse rows tet by tet, for uncertainty.
  void multiply_fitted(int parameter, std::span<const double> dp, std::span<double> values) const;
  void add_fitted_transposed(int parameter, std::span<const double> values, std::span<double> pbar) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The parameters of a fit and where they apply. `mesh` is that of the map.
struct FittedField {
  const ParameterMap& map;
  const TetMesh& mesh;
  std::span<const double> p;
};

}  // namespace aspic
