#include "aspic/step_loop.h"

#include <fmt/format.h>

#include <utility>

namespace aspic::cli {
namespace {

constexpr int kWarningsShown = 5;

std::string explanation_text(const Explanation& why) {
  std::string text = fmt::format("\n  cause:  {}", why.cause);
  if (!why.place.empty()) text += fmt::format("\n  where:  {}", why.place);
  return text + fmt::format("\n  remedy: {}", why.remedy);
}

}  // namespace

StepLoop::StepLoop(SteppedRun& run, LoopOptions options) : run_(run), options_(std::move(options)) {
  if (options_.progress) progress_.emplace(options_.progress, run.simulation().steps_taken(), options_.last_step);
}

void StepLoop::run() {
  const Simulation& simulation = run_.simulation();
  while (simulation.steps_taken() < options_.last_step && advance()) {
  }
  if (progress_) progress_->finish();
  if (has_blown_up_ && options_.warns)
    fmt::print(stderr, "stopped after step {} of {}: the explicit scheme blew up and left no finite state\n",
               simulation.steps_taken(), options_.last_step);
}

bool StepLoop::advance() {
  if (run_.signal()) return false;
  has_run_out_ = options_.stop.expired();
  if (has_run_out_) return false;
  iterations_.clear();
  const int step = run_.simulation().steps_taken() + 1;
  const auto observe = [&](const LiveIteration& iteration) {
    iterations_.push_back(iteration);
    if (progress_) progress_->show(step, iteration);
  };
  const StepReport report = run_.step(observe, options_.stop);
  if (report.status == Status::interrupted) {
    has_run_out_ = !run_.signal();
    return false;
  }
  record(report);
  // The state is unchanged, so an explicit scheme, which has no fallback, would fail again.
  has_blown_up_ = report.status == Status::undefined && !run_.simulation().integrator().is_implicit;
  return !has_blown_up_;
}

void StepLoop::record(const StepReport& report) {
  const Explanation why = run_.record(report, iterations_);
  totals_.add(report);
  if (!is_success(report.status) && report.status != Status::budget) warn(report, why);
  if (is_success(report.status) && report.lost_accuracy > 0 && !has_warned_of_round_off_) {
    has_warned_of_round_off_ = true;
    print(fmt::format("warning: step {}: {}", report.step, explanation_text(why)));
  }
  if (progress_) progress_->show(report);
}

void StepLoop::warn(const StepReport& report, const Explanation& why) {
  const int count = totals_.unconverged;
  if (count > kWarningsShown) return;
  std::string line = fmt::format("warning: step {} did not converge: {}", report.step, to_string(report.status));
  if (report.residual_threshold > 0)
    line += fmt::format(" after {} iterations; residual {:.3g} N, tolerance {:.3g} N", report.iterations,
                        report.residual, report.residual_threshold);
  if (why.cause != last_cause_) line += explanation_text(why);
  last_cause_ = why.cause;
  if (count == kWarningsShown) line += " (further failures are only counted)";
  print(line);
}

void StepLoop::print(const std::string& line) {
  if (progress_) {
    progress_->message(line);
  } else if (options_.warns) {
    fmt::print(stderr, "{}\n", line);
  }
}

}  // namespace aspic::cli
