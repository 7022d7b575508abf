// Parameters theta of all elastic terms of a model, term by term: TetElasticity::parameter_count() values per tet.
#pragma once
#include <span>
#include <vector>

#include "derivatives/parameter_derivatives.h"
#include "dynamics/model.h"

namespace aspic {

// u . H w
struct HessianProduct {
  std::span<const double> u, w;
  Definiteness definiteness = Definiteness::exact;
};

class ElasticParameters {
 public:
  explicit ElasticParameters(const Model& model);  // stores references to its elastic terms

  int size() const { return start_.back(); }  // size of theta
  int tets() const { return tet_start_.back(); }
  int of_term(int k) const { return start_[k]; }             // start of its values in theta
  std::vector<MaterialParameters> get() const;               // one per tet
  void set(std::span<const MaterialParameters> parameters);  // one per tet
  // g += scale d(dV/dx)/dtheta change, and gradient += scale d(w . dV/dx)/dtheta.
  void add_force(Positions x, std::span<const double> change, double scale, std::span<double> g) const;
  void add_gradient(Positions x, std::span<const double> w, double scale, std::span<double> gradient) const;
  // Adds scale times the derivatives of u . H w with respect to x and theta, H: the Hessian of one term in the model.
  void add_hessian_derivatives(const TetElasticity& term, Positions x, const HessianProduct& product,
                               const HessianDerivatives& out) const;

 private:
  std::vector<TetElasticity*> terms_;
  std::vector<std::unique_ptr<ParameterDerivatives>> derivatives_;  // of each term
  std::vector<int> start_, tet_start_;                              // one entry per term, and the end
};

}  // namespace aspic
