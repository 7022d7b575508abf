#include "viewer/fit_job.h"

#include "fit/quantity.h"

#include <utility>

namespace aspic::viewer {
namespace {

// In the order of FitStage.
constexpr const char* kFitStageTexts[] = {"one value for the whole body", "discretization error, by a finer mesh",
                                          "a value for every tet",        "uncertainty",
                                          "segmentation into parts",      "leave-one-out cross-validation"};

const char* name_of(FitStage stage) { return kFitStageTexts[static_cast<size_t>(stage)]; }

// The parameterization of a stage. The first stage has one value per quantity.
std::vector<FitParameter> parameters_of(const FitPlan& plan, FitStage stage) {
  std::vector<FitParameter> parameters = plan.parameters;
  if (stage == FitStage::uniform)
    for (FitParameter& u : parameters) u.parameterization = Parameterization::uniform, u.handles = 0;
  return parameters;
}

class Listener {
 public:
  Listener(const FitTask& task, const std::function<void(FitNews)>& report, const StopToken& stop)
      : task_(task), report_(report), stop_(stop), plan_(completed(task.plan, task.data.experiment)) {}

  FitOutcome run() {
    const FitCallbacks callbacks{
        .begin = [this](FitStage stage, const std::string&) { report_(beginning(stage)); },
        .iterate = [this](FitStage stage, const FitIteration& i, std::span<const double> p) { hear(stage, i, p); },
        .stop = stop_};
    return fit_material(task_.data, task_.plan, {}, callbacks);
  }

 private:
  FitNews beginning(FitStage stage) {
    stage_ = stage;
    FitNews news{.stage = name_of(stage)};
    if (stage == FitStage::uniform || stage == FitStage::field) {
      news.is_new_stage = true;
      map_.emplace(task_.data.experiment.mesh, plan_.model, known_parameters(plan_, task_.data.experiment),
                   parameters_of(plan_, stage));
    }
    return news;
  }

  // Stages alternate: the discretization error is recomputed for each fitted material.
  void hear(FitStage stage, const FitIteration& iteration, std::span<const double> p) {
    FitNews news = stage == stage_ ? FitNews{} : beginning(stage);
    if (stage == FitStage::uniform || stage == FitStage::field) {
      news.iterations.push_back(iteration);
      for (size_t u = 0; u < plan_.parameters.size(); ++u)
        if (is_stiffness(plan_.parameters[u].quantity)) news.young = map_->values(static_cast<int>(u), p);
    }
    report_(std::move(news));
  }

  const FitTask& task_;
  const std::function<void(FitNews)>& report_;
  const StopToken& stop_;
  FitPlan plan_;
  FitStage stage_ = FitStage::uniform;
  std::optional<ParameterMap> map_;  // parameters of the current stage
};

void append(FitNews& to, FitNews more) {
  if (!more.stage.empty()) to.stage = std::move(more.stage);
  if (more.is_new_stage) to.is_new_stage = true, to.iterations.clear();
  to.iterations.insert(to.iterations.end(), more.iterations.begin(), more.iterations.end());
  if (!more.young.empty()) to.young = std::move(more.young);
  if (more.outcome) to.outcome = std::move(more.outcome);
  if (!more.failure.empty()) to.failure = std::move(more.failure);
  to.has_ended = to.has_ended || more.has_ended;
}

}  // namespace

void run_fit(const FitTask& task, const std::function<void(FitNews)>& report, const StopToken& stop) {
  FitNews last{.has_ended = true};
  try {
    last.outcome = Listener(task, report, stop).run();
    for (const FittedQuantity& quantity : last.outcome->quantities)
      if (is_stiffness(quantity.name)) last.young = quantity.values;
  } catch (const std::exception& e) {
    last.failure = e.what();
  }
  report(std::move(last));
}

FitJob::FitJob(FitTask task, std::function<void()> wake) : wake_(std::move(wake)) {
  thread_ = std::thread([this, task = std::move(task)] {
    const auto report = [&](FitNews news) {
      news.task = task.number;
      add(std::move(news));
    };
    run_fit(task, report, StopToken([this] { return stopping_.load(); }));
  });
}

FitJob::~FitJob() {
  stop();
  thread_.join();
}

void FitJob::add(FitNews news) {
  if (news.stage.empty() && news.iterations.empty() && !news.has_ended) return;
  const bool ends = news.has_ended;
  {
    const std::lock_guard lock(mutex_);
    if (pending_) {
      append(*pending_, std::move(news));
    } else {
      pending_ = std::move(news);
    }
  }
  if (ends) has_ended_ = true;
  if (wake_) wake_();
}

std::optional<FitNews> FitJob::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(pending_, std::nullopt);
}

}  // namespace aspic::viewer
