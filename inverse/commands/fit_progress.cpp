#include "commands/fit_progress.h"

#include <fmt/format.h>

#include <algorithm>

namespace aspic::cli {
namespace {

// In the order of FitStage.
constexpr const char* kStageTexts[] = {"one value", "the mesh", "fit", "uncertainty",
                                       "parts",     "held out", "law", "relaxing"};

const char* stage_text(FitStage stage) { return kStageTexts[static_cast<size_t>(stage)]; }

// In first iterations, which solve all cases from rest. Measured with blocks, of grips and of indenters.
constexpr double kFirstFit = 3.5, kLaws = 2, kFinerMesh = 7, kHeldOutGroup = 1.5;

}  // namespace

double least_duration(const FitPlan& plan, const Measured& experiment) {
  const auto groups = static_cast<double>(groups_of(experiment).size());
  const double held_out = plan.cross_validation && groups > 1 ? kHeldOutGroup * groups : 0;
  return kFirstFit + (plan.law_errors ? kLaws : 0) + (plan.mesh_errors ? kFinerMesh : 0) + held_out;
}

FitProgress::FitProgress(std::FILE* stream, bool every_iteration)
    : StatusLine(stream), every_iteration_(every_iteration) {}

void FitProgress::begin(FitStage stage, const std::string& what) {
  if (what.empty()) return;
  draw(fmt::format("{:<10} {}", stage_text(stage), what));
  shown_at_ = seconds();
}

// A fit agrees with the measurements within their standard deviations if |r|^2 equals the number of readings.
void FitProgress::show(FitStage stage, const FitIteration& i, int residuals) {
  const std::string line =
      fmt::format("{:<10} iteration {:>3}  |r|^2 {:.4g} per reading  weight {:.3g}  step {:.2g}  {}", stage_text(stage),
                  i.index, 2 * i.misfit / std::max(residuals, 1), i.weight, i.step, duration_text(seconds()));
  show(line);
}

void FitProgress::show(const std::string& line) {
  if (every_iteration_) return message(line);
  if (!terminal_ && seconds() - shown_at_ < kLineInterval) return;
  shown_at_ = seconds();
  draw(line);
}

void FitProgress::message(const std::string& line) {
  erase();
  fmt::print(stream_, "{}\n", line);
  std::fflush(stream_);
}

void FitProgress::show_expected(const FitPlan& plan, const Measured& experiment) {
  const bool is_longer = plan.parts != 0 || plan.model == kAutoLaw || is_field(plan);
  message(fmt::format("expected   {} {} in all, from the first iteration", is_longer ? "more than" : "about",
                      duration_text(seconds() * least_duration(plan, experiment))));
}

void FitProgress::finish() {
  erase();
  std::fflush(stream_);
}

}  // namespace aspic::cli
