// Misfit of histories as a function of the logarithms of a factor of the stiffness and of the ratios and relaxation
// times of Maxwell branches: p = (log scale, log ratio_1, log time_1, ...). The Jacobian is dense, by differences.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "model/least_squares.h"
#include "model/load_history.h"
#include "model/regularizer.h"

namespace aspic {

class HistoryMisfit : public LeastSquares {
 public:
  // Stores references to body, histories and options.
  HistoryMisfit(const Experiment& body, const std::vector<LoadHistory>& histories, ViscoelasticMaterial material,
                int branches, const EquilibriumOptions& options);

  int parameter_count() const override { return 1 + 2 * branches_; }
  int residual_count() const override { return residuals_; }
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override;
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;

  const std::vector<HistoryPrediction>& predictions() const { return predictions_; }  // of the last evaluate()
  const std::string& failure() const { return failure_; }
  ViscoelasticMaterial material_of(std::span<const double> p) const;
  void keep_scale() { is_scale_known_ = true; }  // p[0] has no effect
  // Parameters of every tet at p[0]; empty: p[0] multiplies all stiffnesses. Called in parallel.
  void set_material(std::function<std::vector<MaterialParameters>(double)> at) { material_at_ = std::move(at); }

 private:
  std::vector<HistoryPrediction> predicted(std::span<const double> p) const;
  bool residuals(const std::vector<HistoryPrediction>& predictions, std::span<double> r);

  const Experiment& body_;
  const std::vector<LoadHistory>& histories_;
  ViscoelasticMaterial material_;
  std::function<std::vector<MaterialParameters>(double)> material_at_;
  int branches_, residuals_ = 0;
  bool is_scale_known_ = false;
  const EquilibriumOptions& options_;
  std::vector<double> p_, r_;                 // of the last successful evaluation
  std::vector<std::vector<double>> columns_;  // of J
  std::vector<HistoryPrediction> predictions_;
  std::string failure_;
};

// Independent normal priors.
class IndependentPriors : public Regularizer {
 public:
  IndependentPriors(std::vector<double> means, std::vector<double> sigmas)
      : means_(std::move(means)), sigmas_(std::move(sigmas)) {}

  double value(std::span<const double> p) const override;
  void add_gradient(std::span<const double> p, double scale, std::span<double> g) const override;
  void add_hessian_product(std::span<const double> p, std::span<const double> v, double scale,
                           std::span<double> y) const override;
  void solve(std::span<const double> p, std::span<const double> v, double shift, std::span<double> z) override;
  void add_noise(std::span<const double> p, std::mt19937_64& random, std::span<double> g) const override;

 private:
  double precision(size_t i) const { return 1 / (sigmas_[i] * sigmas_[i]); }

  std::vector<double> means_, sigmas_;
};

}  // namespace aspic
