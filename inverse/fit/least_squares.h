// Residuals r(p) of any model, with products of their Jacobian: what fits and their uncertainty need to know of it.
#pragma once
#include <span>
#include <utility>
#include <vector>

namespace aspic {

class LeastSquares {
 public:
  virtual ~LeastSquares() = default;
  virtual int unknowns() const = 0;
  virtual int residual_count() const = 0;
  // r(p); false where it is not defined (an equilibrium was not found): another p must be tried.
  virtual bool evaluate(std::span<const double> p, std::span<double> r) = 0;
  // Makes the Jacobian J = dr/dp at the p of the last successful evaluate(); false: it does not exist there.
  virtual bool linearize() = 0;
  virtual void multiply(std::span<const double> dp, std::span<double> dr) = 0;              // dr = J dp
  virtual void multiply_transposed(std::span<const double> w, std::span<double> pbar) = 0;  // pbar = J' w

  // Ways in which r changes with what the model assumes for convenience, say how stiff a contact is: what the residuals
  // say along those does not determine p (WithUncertainLayers). Valid as J is.
  virtual int nuisance_count() const { return 0; }
  virtual void nuisance(int /*k*/, std::span<double> /*dr*/) {}
  // First residual and number of each part where what is assumed may be wrong by itself; empty: it is so everywhere.
  virtual std::vector<std::pair<int, int>> residuals_by_case() const { return {}; }
};

}  // namespace aspic
