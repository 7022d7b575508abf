#include "model/elastic_parameters.h"

#include <algorithm>

#include "base/check.h"
#include "base/error.h"

namespace aspic {

ElasticParameters::ElasticParameters(const Model& model) : start_{0}, tet_start_{0} {
  ASPIC_CHECK(model.elasticity.size() == model.bodies.size());
  if (!model.mesh.sheet.empty() || !model.mesh.rods.empty())
    throw InvalidInput("the scene has sheets or rods; derivatives by material parameters need bodies of tets");
  for (size_t k = 0; k < model.elasticity.size(); ++k) {
    terms_.push_back(model.elasticity[k].get());
    derivatives_.push_back(derivatives_of(*terms_[k]));
    start_.push_back(start_.back() + terms_[k]->parameter_count() * model.bodies[k].tet_count);
    tet_start_.push_back(tet_start_.back() + model.bodies[k].tet_count);
  }
}

std::vector<MaterialParameters> ElasticParameters::get() const {
  std::vector<MaterialParameters> all;
  for (const TetElasticity* term : terms_) {
    const std::vector<MaterialParameters> own = term->parameters();
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

void ElasticParameters::set(std::span<const MaterialParameters> parameters) {
  ASPIC_CHECK(static_cast<int>(parameters.size()) == tets());
  for (size_t k = 0; k < terms_.size(); ++k)
    terms_[k]->set_parameters(parameters.subspan(tet_start_[k], tet_start_[k + 1] - tet_start_[k]));
}

void ElasticParameters::add_force(Positions x, std::span<const double> change, double scale,
                                  std::span<double> g) const {
  ASPIC_CHECK(static_cast<int>(change.size()) == size());
  for (size_t k = 0; k < terms_.size(); ++k)
    derivatives_[k]->add_force(x, change.subspan(start_[k], start_[k + 1] - start_[k]), scale, g);
}

void ElasticParameters::add_gradient(Positions x, std::span<const double> w, double scale,
                                     std::span<double> gradient) const {
  ASPIC_CHECK(static_cast<int>(gradient.size()) == size());
  for (size_t k = 0; k < terms_.size(); ++k)
    derivatives_[k]->add_gradient(x, w, scale, gradient.subspan(start_[k], start_[k + 1] - start_[k]));
}

void ElasticParameters::add_hessian_derivatives(const TetElasticity& term, Positions x, const HessianProduct& product,
                                                const HessianDerivatives& out) const {
  const auto k = std::find(terms_.begin(), terms_.end(), &term) - terms_.begin();
  ASPIC_CHECK(k < static_cast<std::ptrdiff_t>(terms_.size()));
  HessianDerivatives own = out;
  own.parameters = out.parameters.subspan(start_[k], start_[k + 1] - start_[k]);
  derivatives_[k]->add_hessian_derivatives(x, product.u, product.w, product.definiteness, own);
}

}  // namespace aspic
