// Folder material.fit/ of a fit: its options, a row per iteration, the state for resumption, and the report.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "pipeline/fit_run.h"
#include "results/run_lock.h"

namespace aspic {

enum class ExistingFit {
  refuse,
  overwrite,
  resume,
  proceed,  // begins, or resumes
  share,    // reads the state of a fit that another process may continue; changes no file
};

class FitFolder {
 public:
  // Opens the folder of the given material file. `options` identify the fit: text_of(plan) and the data. Throws
  // InvalidInput if the folder must not be replaced, belongs to other options, or another process is writing to it.
  static FitFolder open(const std::filesystem::path& material, const std::string& options, ExistingFit existing);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path report() const { return path_ / "report.html"; }
  // Whether the fit of this material file has ended. Throws InvalidInput if it had other options.
  static bool is_complete(const std::filesystem::path& material, const std::string& options);

  FitMemory memory() const { return {path_, start_}; }
  bool is_resumed() const { return start_ == JournalStart::resume; }
  std::filesystem::path jobs() const { return path_ / "jobs"; }  // results of jobs, see FitJobs
  int iterations_before() const { return rows_on_disk_; }        // rows before the resumption

  // Adds a row of history.csv. A resumed fit repeats its first rows, which exist already.
  void add(FitStage stage, const FitIteration& iteration);
  // Writes weights.csv with the tried weights of the regularizer.
  void add_weights(const FitReport& report);
  void finish();  // removes the state for resumption

 private:
  void require_same(const std::string& options) const;

  std::filesystem::path path_;
  std::shared_ptr<const RunLock> lock_;
  JournalStart start_ = JournalStart::anew;
  std::string history_;
  int rows_ = 0, rows_on_disk_ = 0;
};

const char* to_string(FitStage stage);  // "uniform", "field", ...

}  // namespace aspic
