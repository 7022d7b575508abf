#include "viewer/fit_state.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fit/quantity.h"
#include "viewer/scene_json.h"
#include "viewer/settings.h"

namespace aspic::viewer {
namespace {

// Mean of a true quantity over the volume of the body.
double mean_of(const FittedMaterial& truth, const std::string& quantity) {
  const std::vector<double>& values = *truth.find(quantity);
  double sum = 0, volumes = 0;
  for (int t = 0; t < truth.mesh.tet_count(); ++t) {
    const double v = volume(truth.mesh, t);
    sum += v * values[t], volumes += v;
  }
  return sum / volumes;
}

// Fits Young's modulus of every tet; all other quantities are known. On a coarser mesh the plan estimates the
// discretization error.
FitPlan plan_for(const Bench& bench) {
  FitPlan plan{.model = bench.truth().model};
  plan.parameters = {{.quantity = "young", .parameterization = Parameterization::tets, .handles = 0, .guess = 0}};
  for (const std::string& quantity : quantities_of(plan.model))
    if (!is_stiffness(quantity)) plan.known.emplace_back(quantity, mean_of(bench.truth(), quantity));
  plan.cross_validation = false;
  plan.mesh_errors = !bench.is_same_mesh();
  return plan;
}

Json iteration_json(const FitIteration& i, int residuals) {
  return {{"index", i.index},
          {"misfit", i.misfit},
          {"roughness", i.roughness},
          {"weight", i.weight},
          {"chi", residuals > 0 ? std::sqrt(2 * i.misfit / residuals) : 0}};
}

int residuals_of(const Experiment& e) {
  size_t count = 0;
  for (const LoadCase& c : e.cases) count += 3 * (c.positions.size() + (c.force ? 1 : 0) + (c.torque ? 1 : 0));
  return static_cast<int>(count);
}

constexpr const char* kMaterialFile = "material.vtu";

std::string setting_of(const std::filesystem::path& material) { return "material.file=\"" + material.string() + "\""; }

// The material of such a comparison is lost with the session.
bool is_of_temporary(const std::optional<Recording::Comparison>& comparison, const TemporaryFolder* folder) {
  if (!comparison || !folder) return false;
  const std::string path = folder->path().string();
  const std::vector<std::string>& overrides = comparison->overrides;
  return std::any_of(overrides.begin(), overrides.end(),
                     [&](const std::string& text) { return text.find(path) != std::string::npos; });
}

// Root mean square of log(fitted / true) over the volume.
double error_of(const Bench& bench, const std::vector<double>& young) {
  const std::vector<double> truth = bench.true_young();
  const TetMesh& mesh = bench.data().experiment.mesh;
  double sum = 0, volumes = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const double e = std::log(young[t] / truth[t]), v = volume(mesh, t);
    sum += v * e * e, volumes += v;
  }
  return std::sqrt(sum / volumes);
}

}  // namespace

void FitState::start(const Bench* bench) {
  if (is_running_) throw InvalidInput("a fit is running; stop it first");
  if (!bench || bench->data().experiment.cases.empty())
    throw InvalidInput("no case is recorded yet; record one first, or poke the whole body");
  FitTask task{++task_, bench->data(), plan_for(*bench)};
  task.plan = completed(std::move(task.plan), task.data.experiment);
  drop();
  bench_ = bench;
  wanted_ = std::move(task);
  is_running_ = true;
  known_.phase = "beginning";
}

void FitState::stop() {
  is_running_ = false;
  wanted_.reset();
}

void FitState::drop(std::string summary) {
  stop();
  bench_ = nullptr;
  known_ = {};
  known_.summary = std::move(summary);
  show();
}

bool FitState::add(const FitNews& news) {
  if (news.task != task_ || !bench_) return false;
  if (!news.stage.empty()) known_.phase = news.stage;
  if (news.is_new_stage) known_.history.clear();
  known_.history.insert(known_.history.end(), news.iterations.begin(), news.iterations.end());
  if (!news.young.empty()) known_.young = news.young;
  if (!news.failure.empty()) known_.failure = news.failure;
  if (news.outcome) {
    known_.outcome = news.outcome;
    known_.file.clear();
    known_.failure = news.outcome->failure;
    known_.summary = news.outcome->report.message;
    for (const FittedQuantity& quantity : news.outcome->quantities)
      if (is_stiffness(quantity.name)) known_.sigma = quantity.sigma;
  }
  if (news.has_ended) is_running_ = false, known_.phase.clear();
  show();
  return true;
}

std::vector<TetField> FitState::fields() const {
  if (!bench_ || known_.young.empty()) return {};
  std::vector<double> log_error = known_.young;
  const std::vector<double> truth = bench_->true_young();
  for (size_t t = 0; t < truth.size(); ++t) log_error[t] = std::log(known_.young[t] / truth[t]);
  const Field young{.name = "fitted_young", .label = "fitted Young's modulus", .unit = "Pa", .is_log = true};
  std::vector<TetField> fields = {
      {young, bench_->on_scene(known_.young)},
      {{"fit_error", "log of fitted / true modulus", "", true, 0}, bench_->on_scene(log_error)}};
  if (!known_.sigma.empty())
    fields.push_back(
        {{"young_deviation", "standard deviation of log E (0.1: 10 %)", ""}, bench_->on_scene(known_.sigma)});
  return fields;
}

void FitState::show() {
  ShownSide& a = stage_.a();
  const std::vector<TetField> fitted = fields();
  const bool is_first = !fitted.empty() && !a.has_field("fitted_young");
  for (ShownSide& shown : stage_.sides()) {
    const size_t before = shown.fields().size();
    const bool fits = !fitted.empty() && shown.side.model().mesh.tets.size() == fitted.front().values.size();
    shown.further = fits ? fitted : std::vector<TetField>{};
    if (&shown == &a && !a.has_field(stage_.field())) stage_.set_field({});
    if (&shown == &a && is_first) stage_.set_field("fitted_young");
    if (shown.fields().size() != before) stage_.send_scene(shown);
  }
  stage_.mark_changed();
}

void FitState::simulate(Playback& playback) {
  if (!has_material()) throw InvalidInput("there is no fitted material yet; fit one first");
  std::unique_ptr<TemporaryFolder> temporary;
  std::filesystem::path file = known_.file;
  if (file.empty()) {
    temporary = std::make_unique<TemporaryFolder>();
    file = temporary->path() / kMaterialFile;
    write_material(file, known_.outcome->material);
  }
  const SteeredScene& steered = stage_.a().side.steered();
  const std::vector<std::string> fitted = {setting_of(file), "material.frame=\"placed\""};
  std::vector<std::string> overrides;
  for (const std::string& text : steered.overrides)
    if (!key_of(text).starts_with("material.") || key_of(text) == "material.model") overrides.push_back(text);
  overrides.insert(overrides.end(), fitted.begin(), fitted.end());
  playback.install(stage_.loaded(steered.path, steered.overrides, overrides),
                   Recording::Comparison{fitted, "fitted material"});
  folder_ = std::move(temporary);
  simulated_ = task_;
  stage_.a().label = "true material";
  stage_.set_field("young");
  for (const ShownSide& shown : stage_.sides()) stage_.send_scene(shown);
  stage_.mark_changed();
}

// Later recordings of the comparison refer to the saved file.
void FitState::save_material(const std::filesystem::path& folder) {
  if (!has_material()) return;
  known_.file = std::filesystem::absolute(folder) / kMaterialFile;
  write_material(known_.file, known_.outcome->material);
  if (simulated_ != task_ || !is_of_temporary(stage_.comparison(), folder_.get())) return;
  std::vector<std::string>& overrides = stage_.comparison()->overrides;
  std::replace(overrides.begin(), overrides.end(), setting_of(folder_->path() / kMaterialFile),
               setting_of(known_.file));
}

void FitState::require_saved_material() const {
  if (is_of_temporary(stage_.comparison(), folder_.get()))
    throw InvalidInput("the fitted material of side B is not saved; save the data set, which includes it");
}

Json FitState::json() const {
  if (!is_running_ && known_.history.empty() && known_.failure.empty()) return nullptr;
  const int residuals = bench_ ? residuals_of(bench_->data().experiment) : 0;
  Json history = Json::array();
  for (const FitIteration& i : known_.history) history.push_back(iteration_json(i, residuals));
  Json fit = {{"running", is_running_},
              {"stage", known_.phase},
              {"words", known_.summary},
              {"failure", known_.failure},
              {"iterations", std::move(history)},
              {"residuals", residuals},
              {"error", nullptr},
              {"softest", nullptr},
              {"stiffest", nullptr},
              {"has_material", has_material()},
              {"warnings", known_.outcome ? known_.outcome->warnings : std::vector<std::string>{}},
              {"next", nullptr}};
  if (bench_ && !known_.young.empty()) {
    const auto [least, most] = std::minmax_element(known_.young.begin(), known_.young.end());
    fit["softest"] = *least, fit["stiffest"] = *most;
    fit["error"] = error_of(*bench_, known_.young);
  }
  return fit;
}

}  // namespace aspic::viewer
