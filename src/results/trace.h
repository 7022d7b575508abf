// Trace of the minimizations of a run: tables and JSON lines of all trials, and landscapes of E on request. The files
// are described in docs/formats.md.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/csv.h"
#include "optimize/landscape.h"

namespace aspic {

// An iteration around which E is sampled. Steps count from 1, iterations from 0.
struct LandscapeAt {
  int step = 1, iteration = 0;
};
LandscapeAt parse_landscape(const std::string& text);  // "12" or "12:3". Throws InvalidInput.
std::string landscape_name(const LandscapeAt& at);     // "12_3", a part of file names

// E around the iteration, and the trials that its line search made.
struct Landscape {
  LandscapeAt at;
  double value = 0, alpha = 0;  // E at the iterate; the accepted step
  std::vector<Trial> tried;
  std::vector<CurvePoint> curve;
  Slice slice;
};

struct TraceOptions {
  std::vector<LandscapeAt> landscapes;
  double sufficient_decrease = LineSearchOptions().sufficient_decrease;  // c, for the bounds of the curves
};

class Trace {
 public:
  // Creates `folder` and writes into it. Throws InvalidInput if that fails.
  explicit Trace(std::filesystem::path folder, TraceOptions options = {});

  // Called by the observer of the minimization.
  void on_iteration(int step, const LiveIteration& iteration);
  void close();  // everything is on the disk afterwards

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<Landscape>& landscapes() const { return landscapes_; }  // made so far
  // Returns the requested landscapes whose iterations did not occur.
  std::vector<LandscapeAt> missed() const;

 private:
  void add_rows(int step, const LiveIteration& iteration);
  void add_landscape(const LandscapeAt& at, const LiveIteration& iteration);

  std::filesystem::path folder_;
  TraceOptions options_;
  std::vector<char> met_;  // one per landscape
  std::vector<Landscape> landscapes_;
  CsvFile iterations_, trials_, timings_;
  OutputFile json_;
  int step_ = 0, solve_ = 0;  // a step of several stages is several minimizations
};

}  // namespace aspic
