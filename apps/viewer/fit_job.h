// A fit in a thread of its own: start, news, stop. The listener requests the news when it is woken.
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

// What has become known since the news before.
struct FitNews {
  long task = 0;                         // which
  std::string stage;                     // in words; empty: as before
  std::vector<FitIteration> iterations;  // new ones of this stage; `is_new_stage`: earlier ones are void
  bool is_new_stage = false;
  std::vector<double> young;  // of each tet of the data [Pa]; empty: as before
  std::optional<FitOutcome> outcome;
  std::string failure;  // the task could not be begun
  bool has_ended = false;
};

// Runs the task on this thread and reports its progress.
void run_fit(const FitTask& task, const std::function<void(FitNews)>& tell, const StopToken& stop = {});

class FitJob {
 public:
  FitJob(FitTask task, std::function<void()> wake);  // `wake`: called from the thread of the fit
  ~FitJob();                                         // stops it and waits for that

  void stop() { stopping_ = true; }  // ends after its iteration under way, with what was reached
  std::optional<FitNews> news();     // none: nothing is new
  bool has_ended() const { return has_ended_; }

 private:
  void add(FitNews news);

  std::function<void()> wake_;
  std::atomic<bool> stopping_ = false, has_ended_ = false;
  std::mutex mutex_;  // of what follows
  std::optional<FitNews> pending_;
  std::thread thread_;
};

}  // namespace aspic::viewer
