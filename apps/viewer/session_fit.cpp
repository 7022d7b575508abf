// The commands of the fit: begun, watched as colors on the body, and simulated.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "viewer/session_impl.h"

namespace aspic::viewer {
namespace {

// The mean over the body of one quantity of the truth: what is not fitted is known.
double mean_of(const FittedMaterial& truth, const std::string& quantity) {
  const std::vector<double>& values = *truth.find(quantity);
  double sum = 0, volumes = 0;
  for (int t = 0; t < truth.mesh.tet_count(); ++t) {
    const double v = volume(truth.mesh, t);
    sum += v * values[t], volumes += v;
  }
  return sum / volumes;
}

// Young's modulus of every tet is fitted; all else is known. What a coarser mesh gets wrong is taken off.
FitPlan plan_for(const Bench& bench) {
  FitPlan plan{.model = bench.truth().model};
  plan.unknowns = {{.quantity = "young", .spread = Spread::tets, .handles = 0, .guess = 0}};
  for (const std::string& quantity : quantities_of(plan.model))
    if (quantity != "young") plan.known.emplace_back(quantity, mean_of(bench.truth(), quantity));
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

// That comparison's material would be gone when it is repeated.
bool is_of_temporary(const std::optional<Recording::Comparison>& comparison, const TemporaryFolder* folder) {
  if (!comparison || !folder) return false;
  const std::string path = folder->path().string();
  return std::ranges::any_of(comparison->overrides,
                             [&](const std::string& text) { return text.find(path) != std::string::npos; });
}

// log(fitted / true), its root mean square over the volume.
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

void Session::Impl::fit(Arguments& arguments) {
  arguments.finish();
  if (capture.is_fitting) throw InvalidInput("a fit is under way; stop it first");
  if (!capture.bench || capture.bench->data().experiment.cases.empty())
    throw InvalidInput("nothing is recorded yet: poke the body and record, or let it be poked all over");
  FitTask task{++capture.task, capture.bench->data(), plan_for(*capture.bench)};
  task.plan = completed(std::move(task.plan), task.data.experiment);
  forget_fit();
  capture.wanted = std::move(task);
  capture.is_fitting = true;
  capture.stage = "beginning";
  tell_capture();
}

void Session::Impl::stop_fit(Arguments& arguments) {
  arguments.finish();
  capture.is_fitting = false;
  capture.wanted.reset();
  tell_capture();
}

void Session::Impl::forget_fit() {
  capture.is_fitting = false;
  capture.wanted.reset();
  capture.stage = capture.words = capture.failure = "";
  capture.history.clear();
  capture.young.clear();
  capture.deviation.clear();
  capture.outcome.reset();
  capture.saved.clear();
  show_fit();
}

void Session::Impl::note_fit(const FitNews& update) {
  if (update.task != capture.task || !capture.bench) return;
  if (!update.stage.empty()) capture.stage = update.stage;
  if (update.is_new_stage) capture.history.clear();
  capture.history.insert(capture.history.end(), update.iterations.begin(), update.iterations.end());
  if (!update.young.empty()) capture.young = update.young;
  if (!update.failure.empty()) capture.failure = update.failure;
  if (update.outcome) {
    capture.outcome = update.outcome;
    capture.saved.clear();
    capture.failure = update.outcome->failure;
    capture.words = update.outcome->report.words;
    for (const FittedQuantity& quantity : update.outcome->quantities)
      if (quantity.name == "young") capture.deviation = quantity.deviation;
  }
  if (update.has_ended) capture.is_fitting = false, capture.stage.clear();
  show_fit();
  tell_capture();
}

// On every side whose body has the tets that were measured.
void Session::Impl::show_fit() {
  const bool is_first = !capture.young.empty() && !a->side.has_field("fitted_young");
  std::vector<TetField> shown;
  if (capture.bench && !capture.young.empty()) {
    std::vector<double> log_error = capture.young;
    const std::vector<double> truth = capture.bench->true_young();
    for (size_t t = 0; t < truth.size(); ++t) log_error[t] = std::log(capture.young[t] / truth[t]);
    const Field young{.name = "fitted_young", .label = "fitted Young's modulus", .unit = "Pa", .is_log = true};
    shown.push_back({young, capture.bench->on_scene(capture.young)});
    shown.push_back({{"fit_error", "log of fitted / true modulus", "", true, 0}, capture.bench->on_scene(log_error)});
    if (!capture.deviation.empty())
      shown.push_back({{"young_deviation", "deviation of log E (0.1: known to 10 %)", ""},
                       capture.bench->on_scene(capture.deviation)});
  }
  for (ShownSide* side : {a.get(), b.get()}) {
    if (!side) continue;
    const size_t before = side->side.fields().size();
    const bool fits = !shown.empty() && side->side.model().mesh.tets.size() == shown.front().values.size();
    side->side.show_further(fits ? shown : std::vector<TetField>{});
    if (side == a.get() && !side->side.has_field(field)) field.clear();
    if (is_first && side == a.get()) field = "fitted_young";
    if (side->side.fields().size() != before) tell(scene_message(*side, field));
  }
  ++version;
}

// Beside the true one, under the same mouse and probe.
void Session::Impl::simulate_fit(Arguments& arguments) {
  arguments.finish();
  if (!capture.outcome || !capture.outcome->has_material())
    throw InvalidInput("there is no fitted material yet; fit one first");
  std::unique_ptr<TemporaryFolder> temporary;
  std::filesystem::path file = capture.saved;
  if (file.empty()) {
    temporary = std::make_unique<TemporaryFolder>();
    file = temporary->path() / kMaterialFile;
    write_material(file, capture.outcome->material);
  }
  const SteeredScene& steered = a->side.steered();
  const std::vector<std::string> fitted = {setting_of(file), "material.frame=\"placed\""};
  std::vector<std::string> overrides;
  for (const std::string& text : steered.overrides)
    if (!key_of(text).starts_with("material.") || key_of(text) == "material.model") overrides.push_back(text);
  overrides.insert(overrides.end(), fitted.begin(), fitted.end());
  const std::string shown = field;
  auto second = loaded("b", steered.path, overrides);
  install(loaded("a", steered.path, steered.overrides), std::move(second),
          Recording::Comparison{fitted, "fitted material"});
  capture.folder = std::move(temporary);
  capture.simulated = capture.task;
  a->label = "true material";
  field = "young";
  for (const ShownSide* side : {a.get(), b.get()}) tell(scene_message(*side, field));
  ++version;
}

// Beside its data set. If it is simulated already, a recording names that file from now on.
void Session::Impl::save_material(const std::filesystem::path& folder) {
  if (!capture.outcome || !capture.outcome->has_material()) return;
  capture.saved = std::filesystem::absolute(folder) / kMaterialFile;
  write_material(capture.saved, capture.outcome->material);
  if (capture.simulated != capture.task || !is_of_temporary(comparison, capture.folder.get())) return;
  std::vector<std::string>& overrides = comparison->overrides;
  std::replace(overrides.begin(), overrides.end(), setting_of(capture.folder->path() / kMaterialFile),
               setting_of(capture.saved));
}

void Session::Impl::require_saved_material() const {
  if (is_of_temporary(comparison, capture.folder.get()))
    throw InvalidInput(
        "side B has the fitted material, which no file keeps: save the data set, and the material with it");
}

Json Session::Impl::fit_json() const {
  if (!capture.is_fitting && capture.history.empty() && capture.failure.empty()) return nullptr;
  const int residuals = capture.bench ? residuals_of(capture.bench->data().experiment) : 0;
  Json history = Json::array();
  for (const FitIteration& i : capture.history) history.push_back(iteration_json(i, residuals));
  Json fit = {{"running", capture.is_fitting},
              {"stage", capture.stage},
              {"words", capture.words},
              {"failure", capture.failure},
              {"iterations", std::move(history)},
              {"residuals", residuals},
              {"error", nullptr},
              {"softest", nullptr},
              {"stiffest", nullptr},
              {"has_material", capture.outcome && capture.outcome->has_material()},
              {"warnings", capture.outcome ? capture.outcome->warnings : std::vector<std::string>{}},
              {"next", nullptr}};
  if (capture.bench && !capture.young.empty()) {
    const auto [least, most] = std::minmax_element(capture.young.begin(), capture.young.end());
    fit["softest"] = *least, fit["stiffest"] = *most;
    fit["error"] = error_of(*capture.bench, capture.young);
  }
  if (capture.outcome && capture.outcome->next_poke) {
    const PokeCandidate& next = *capture.outcome->next_poke;
    fit["next"] = {{"site", {next.site[0], next.site[1], next.site[2]}}, {"words", next.words}};
  }
  return fit;
}

}  // namespace aspic::viewer
