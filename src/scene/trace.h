// What every minimisation of a run did, trial by trial: tables, JSON lines, and landscapes of E where they are asked
// for. The files are described in docs/formats.md.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/csv.h"
#include "optimize/minimize.h"

namespace aspic {

// An iteration whose surroundings are to be sampled. Steps count from 1, iterations from 0.
struct LandscapeAt {
  int step = 1, iteration = 0;
};
LandscapeAt parse_landscape(const std::string& text);  // "12" or "12:3". Throws InvalidInput.

struct TraceOptions {
  std::vector<LandscapeAt> landscapes;
  double sufficient_decrease = LineSearchOptions().sufficient_decrease;  // c, for the bounds of the curves
};

class Trace {
 public:
  // Writes into `folder`, which is created. Throws InvalidInput when that cannot be done.
  explicit Trace(std::filesystem::path folder, TraceOptions options = {});

  // To be called by the observer of the minimisation.
  void on_iteration(int step, const LiveIteration& iteration);
  void close();  // everything is on the disk afterwards

  const std::filesystem::path& folder() const { return folder_; }
  // The landscapes that were asked for and not met, such as iterations that a step did not need.
  std::vector<LandscapeAt> missed() const;

 private:
  void add_rows(int step, const LiveIteration& iteration);
  void write_landscape(const LandscapeAt& at, const LiveIteration& iteration);

  std::filesystem::path folder_;
  TraceOptions options_;
  std::vector<char> met_;  // one per landscape
  CsvFile iterations_, trials_, timings_;
  OutputFile json_;
  int step_ = 0, solve_ = 0;  // a step of several stages is several minimisations
};

}  // namespace aspic
