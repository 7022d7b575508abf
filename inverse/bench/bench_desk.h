// Commands and questions of the bench.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bench/fit_process.h"
#include "bench/indenter_tool.h"
#include "model/misfit.h"
#include "viewer/stage.h"

namespace aspic::bench {

using viewer::Arguments, viewer::Stage;

// A kept reading: what the gauge showed, and the case of the data set.
struct Reading {
  LoadCase load;
  double depth = 0, force = 0;  // [m, N], along the axis of the indenter
};

class BenchDesk : public viewer::Desk {
 public:
  // Adds the commands touch, press, lift, keep, forget, fit and stop_fit, and the questions fit_state and fit_report.
  BenchDesk(const viewer::SessionOptions& options, Stage& stage, viewer::Playback& playback, viewer::Commands& commands,
            viewer::Questions& questions);

  void check_body() override;  // drops the readings of another body than that of side a
  void send() const override;

 private:
  void touch(Arguments& arguments);
  void press(Arguments& arguments);
  void lift();
  void keep();
  void forget(Arguments& arguments);
  void fit();
  const IndenterTool& tool() const;          // of side a
  const IndenterTool& resting_tool() const;  // throws InvalidInput if the gauge shows no state of rest

  const viewer::SessionOptions& options_;
  Stage& stage_;
  viewer::Playback& playback_;
  std::vector<Reading> readings_;                  // group by group, each from the smallest depth on
  std::string body_;                               // measured body, see body_text()
  std::shared_ptr<const FirstContact> last_site_;  // of the latest reading
  int sites_ = 0;                                  // groups so far
  std::unique_ptr<FitProcess> fit_;                // null: none yet
};

}  // namespace aspic::bench
