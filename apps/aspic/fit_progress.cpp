#include "aspic/fit_progress.h"

#include <fmt/format.h>

#include <algorithm>

namespace aspic::cli {
namespace {

// In the order of FitStage.
constexpr const char* kStageTexts[] = {"one value", "the mesh",  "fit", "uncertainty", "parts",
                                       "held out",  "next poke", "law", "relaxing"};

const char* stage_text(FitStage stage) { return kStageTexts[static_cast<size_t>(stage)]; }

// In first iterations, which solve all cases from rest. Measured with fits of blocks and layers.
constexpr double kFirstFit = 3, kLaws = 1, kFinerMesh = 6, kFields = 10, kHeldOutGroup = 0.5;

}  // namespace

double expected_duration(const FitPlan& plan, const Experiment& experiment) {
  const bool is_field = std::any_of(plan.parameters.begin(), plan.parameters.end(), [](const FitParameter& u) {
    return u.parameterization == Parameterization::tets || u.parameterization == Parameterization::handles;
  });
  const auto groups = static_cast<double>(groups_of(experiment).size());
  double duration = kFirstFit + (plan.law_errors ? kLaws : 0) + (plan.mesh_errors ? kFinerMesh : 0);
  if (plan.cross_validation && groups > 1) duration += kHeldOutGroup * groups;
  return is_field ? kFields * duration : duration;
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

void FitProgress::show_expected(double factor) {
  message(fmt::format("expected   about {} in all, from the first iteration", duration_text(factor * seconds())));
}

void FitProgress::finish() {
  erase();
  std::fflush(stream_);
}

}  // namespace aspic::cli
