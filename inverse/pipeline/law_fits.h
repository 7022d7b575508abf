// Fits of every law of a comparison, as jobs.
#pragma once
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "pipeline/compared_laws.h"
#include "pipeline/fit_model.h"

namespace aspic {

// A law with its best parameters so far.
struct FittedLaw {
  const Law& law;
  FitPlan plan;
  std::vector<double> p;  // empty: none yet
  double objective = std::numeric_limits<double>::infinity();
  std::vector<MaterialParameters> material;
  std::string failure;
};

class LawFits {
 public:
  // `plan`: see simplified(). Stores references to all arguments.
  LawFits(const DataSet& data, const FitPlan& plan, FitJobs& jobs, const FitCallbacks& callbacks);

  bool run();  // false: stopped, or results of jobs are missing
  const std::vector<FittedLaw>& laws() const { return laws_; }
  const SimulatedData& simulated() const { return simulated_; }
  FitModel model_of(const FittedLaw& law, std::vector<FitParameter> parameters) const;

 private:
  // Changes the law by `action` or by the stored result of an earlier one, with the same iterations.
  void run_job(FittedLaw& law, const std::string& stage, JobKind kind, const std::function<void()>& action);
  void restore(const JobResult& result, FittedLaw& law);
  void find_reference();  // moduli at small strains, the initial guess of all laws
  std::vector<std::vector<double>> starts_of(const FittedLaw& law) const;
  void fit(FittedLaw& law, const std::string& how);
  // Keeps the result if it is better than the last one.
  bool minimize(FittedLaw& law, FitModel& model, std::span<const double> start);
  void subtract_mesh_errors(const FittedLaw& law);
  bool is_stopped() const { return callbacks_.stop.stopped(); }

  const DataSet& data_;
  const FitPlan& plan_;
  FitJobs& jobs_;
  const FitCallbacks& callbacks_;
  SimulatedData simulated_;
  std::vector<FittedLaw> laws_;
  std::vector<double> reference_;         // parameters of the first law, from which the others start
  std::vector<FitIteration> iterations_;  // of the job that is being computed
};

}  // namespace aspic
