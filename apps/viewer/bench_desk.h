// Bench commands: record load cases with the indenter, save them as a data set, and start fits.
#pragma once
#include <memory>
#include <string>

#include "viewer/bench.h"
#include "viewer/fit_state.h"

namespace aspic::viewer {

class BenchDesk {
 public:
  BenchDesk(const SessionOptions& options, Stage& stage, Playback& playback)
      : options_(options), stage_(stage), playback_(playback), fit_(stage) {}
  void add_to(Commands& commands);  // bench, record, poke_all, forget, save_capture, fit, stop_fit, simulate_fit

  void check_body();  // drops the bench and the fit if the body of side a is no longer the measured one
  void add(const FitNews& news);
  void send() const;  // sends the state of bench and fit
  FitState& fit() { return fit_; }

 private:
  void set_bench(Arguments& arguments);
  void record(Arguments& arguments);
  void poke_all(Arguments& arguments);
  void forget(Arguments& arguments);
  void save_capture(Arguments& arguments);
  Bench& bench();  // creates the bench at the first call
  int case_count() const { return bench_ ? static_cast<int>(bench_->data().experiment.cases.size()) : 0; }
  void require_room(size_t cases);  // throws InvalidInput

  const SessionOptions& options_;
  Stage& stage_;
  Playback& playback_;
  FitState fit_;
  BenchOptions wanted_;
  std::unique_ptr<Bench> bench_;  // null: not set up
  std::string body_;              // measured body, see body_text()
};

}  // namespace aspic::viewer
