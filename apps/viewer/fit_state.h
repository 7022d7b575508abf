// The fit of recorded cases: its task, its progress and result, the fields that show it, and the simulation with the
// fitted material.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/external_program.h"
#include "viewer/bench.h"
#include "viewer/fit_job.h"
#include "viewer/playback.h"

namespace aspic::viewer {

class FitState {
 public:
  explicit FitState(Stage& stage) : stage_(stage) {}

  void start(const Bench* bench);       // must outlive the fit, until drop(); throws InvalidInput without cases
  void stop();                          // ends the fit after the current iteration; the result remains
  void drop(std::string summary = {});  // drops the task and its result
  bool add(const FitNews& news);        // false: the news is of an earlier task
  std::optional<FitTask> take_task() { return std::exchange(wanted_, std::nullopt); }
  bool is_running() const { return is_running_; }
  const std::string& summary() const { return known_.summary; }
  Json json() const;  // null: no fit

  void show();                        // colors the bodies that have the measured tets
  void simulate(Playback& playback);  // compares the true and the fitted material; throws InvalidInput without one
  void save_material(const std::filesystem::path& folder);
  void require_saved_material() const;  // if side b has it; throws InvalidInput

 private:
  bool has_material() const { return known_.outcome && known_.outcome->has_material(); }
  std::vector<TetField> fields() const;

  struct Known {  // state of the latest task
    std::string phase, summary, failure;
    std::vector<FitIteration> history;  // iterations of the phase
    std::vector<double> young;          // E of each tet of the data set [Pa]; empty: unknown
    std::vector<double> sigma;          // standard deviation of log(young); empty: unknown
    std::optional<FitOutcome> outcome;
    std::filesystem::path file;  // file of the fitted material; empty: not saved
  };

  Stage& stage_;
  const Bench* bench_ = nullptr;  // bench of the latest task
  std::optional<FitTask> wanted_;
  bool is_running_ = false;
  Known known_;
  long task_ = 0;                            // number of the latest task
  long simulated_ = 0;                       // number of the task whose material side b has
  std::unique_ptr<TemporaryFolder> folder_;  // folder of that material until it is saved
};

}  // namespace aspic::viewer
