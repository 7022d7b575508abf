// Jobs: independent fits within a fit, such as that to all groups but one. Their results are stored in files, so that a
// resumed fit does not repeat them and other processes can compute them.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "estimate/cross_validation.h"
#include "pipeline/fit_plan.h"
#include "scene/scene_files.h"

namespace aspic {

struct JobResult {
  std::vector<double> numbers;
  std::string text;
};

enum class JobMode {
  all,     // computes every job
  list,    // lists the jobs without a result instead of computing them
  single,  // computes one job and leaves the others out
};

enum class JobKind {
  independent,
  common,  // other jobs need its result: computed in every mode
};

class FitJobs {
 public:
  FitJobs() = default;  // computes everything and stores nothing
  // `folder`: of the results. `name`: of the single job.
  FitJobs(std::filesystem::path folder, JobMode mode, std::string name);

  // Computes a result; empty: it was stopped.
  using Compute = std::function<std::optional<JobResult>()>;
  // Returns the stored or computed result of a job; empty: it was stopped, or is left to another process. `question`
  // has all that the result depends on.
  std::optional<JobResult> result(const std::string& job, const Fingerprint& question, JobKind kind,
                                  const Compute& compute);

  JobMode mode() const { return mode_; }
  bool is_distributed() const { return mode_ != JobMode::all; }
  bool is_waiting() const { return is_waiting_; }      // a result is left to another process, or the single job is done
  bool has_computed() const { return has_computed_; }  // the single job
  const std::vector<std::string>& missing() const { return missing_; }  // names of the listed jobs

  static bool is_done(const std::filesystem::path& folder, const std::string& name);

 private:
  std::filesystem::path folder_;  // empty: nothing is stored
  JobMode mode_ = JobMode::all;
  std::string name_;
  std::vector<std::string> missing_;
  bool is_waiting_ = false, has_computed_ = false;
};

// Held-out groups as jobs "NAME_1", "NAME_2", ...
struct HeldOutJobs {
  FitJobs& jobs;
  std::string name;
  const FitPlan& plan;
  std::function<bool()> is_stopped;

  HeldOutStore store(const Corrected& experiment, const FitReport& fitted) const;
};

}  // namespace aspic
