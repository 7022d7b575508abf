// What a fit leaves beside its material: material.fit/ with the options it was begun with, a row per iteration, what it
// needs to continue after a kill, and its report.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "capture/fit_run.h"
#include "scene/run_lock.h"

namespace aspic {

enum class ExistingFit { refuse, overwrite, resume };

class FitFolder {
 public:
  // Of the file that the material goes to. `options` belong to the fit: text_of(plan) and what the data are. Throws
  // InvalidInput when something is there that may not be replaced, that was begun with other options, or that another
  // process is writing.
  static FitFolder open(const std::filesystem::path& material, const std::string& options, ExistingFit existing);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path report() const { return path_ / "report.html"; }
  FitMemory memory() const { return {path_, start_}; }
  bool is_resumed() const { return start_ == JournalStart::resume; }
  int iterations_before() const { return rows_on_disk_; }  // of a fit that is resumed

  // A row of history.csv. A resumed fit repeats its first rows, which are there already.
  void add(FitStage stage, const FitIteration& iteration);
  // weights.csv: the weights of the regularizer that were tried.
  void add_weights(const FitReport& report);
  void finish();  // nothing remains to be resumed

 private:
  std::filesystem::path path_;
  std::shared_ptr<const RunLock> lock_;
  JournalStart start_ = JournalStart::anew;
  std::string history_;
  int rows_ = 0, rows_on_disk_ = 0;
};

const char* to_string(FitStage stage);  // "uniform", "field", ...

}  // namespace aspic
