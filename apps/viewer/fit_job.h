// A fit in its own thread. The owner requests news after each call of `wake`.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "capture/fit_run.h"

namespace aspic::viewer {

struct FitTask {
  long number = 0;  // identifies the task
  DataSet data;
  FitPlan plan;
};

// Progress since the previous news.
struct FitNews {
  long task = 0;                         // number of the task
  std::string stage;                     // description; empty: unchanged
  std::vector<FitIteration> iterations;  // new iterations of this stage
  bool is_new_stage = false;             // earlier iterations are obsolete
  std::vector<double> young;             // E of each tet of the data set [Pa]; empty: unchanged
  std::optional<FitOutcome> outcome;
  std::string failure;  // the task could not start
  bool has_ended = false;
};

// Runs the task on this thread and reports its progress.
void run_fit(const FitTask& task, const std::function<void(FitNews)>& report, const StopToken& stop = {});

class FitJob {
 public:
  FitJob(FitTask task, std::function<void()> wake);  // `wake`: called from the thread of the fit
  ~FitJob();                                         // stops the fit and waits for its end

  void stop() { stopping_ = true; }  // ends after the current iteration and keeps its result
  std::optional<FitNews> news();     // none: no progress
  bool has_ended() const { return has_ended_; }

 private:
  void add(FitNews news);

  std::function<void()> wake_;
  std::atomic<bool> stopping_ = false, has_ended_ = false;
  std::mutex mutex_;  // guards the members below
  std::optional<FitNews> pending_;
  std::thread thread_;
};

}  // namespace aspic::viewer
