#include "capture/fit_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "base/error.h"
#include "capture/fitted_values.h"
#include "capture/surface_projection.h"
#include "fit/common_errors.h"
#include "fit/fit_run.h"
#include "fit/parts.h"
#include "fit/refined_experiment.h"
#include "scene/value.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr int kTooFine = 60'000;  // tets, for a mesh of eight times as many
constexpr int kPasses = 8;
constexpr double kSettled = 1e-3;       // relative change of a value
constexpr double kSettledField = 0.03;  // where there are more than kFewValues, which noise leaves open far more
constexpr int kFewValues = 50;
// Guesses that are tried when the first one is so soft that the loads crush the body.
constexpr double kStiffer[] = {1, 10, 100, 0.1};
constexpr double kSoftest = 1e-2, kStiffest = 1e13;  // Young's moduli that a body can have [Pa]
constexpr double kUnexplained = 4;                   // |r|^2 per reading: twice the standard deviations

std::vector<Unknown> as_single_values(std::vector<Unknown> unknowns) {
  for (Unknown& u : unknowns) u.spread = Spread::uniform, u.handles = 0;
  return unknowns;
}

bool are_single_values(const std::vector<Unknown>& unknowns) {
  return std::all_of(unknowns.begin(), unknowns.end(), [](const Unknown& u) { return u.spread == Spread::uniform; });
}

bool is_over(const FitReport& report) { return is_success(report.status) || report.status == Status::iteration_limit; }

// A model with its unknowns, its prior and its memory: what one fit takes.
struct Stage {
  Stage(const Experiment& data, const Experiment& simulated, const FitPlan& plan, std::vector<Unknown> unknowns,
        const FitMemory& memory, const std::string& name, const std::string& fingerprint)
      : map(data.mesh, plan.model, known_parameters(plan, data), std::move(unknowns)),
        prior(make_regularizer(data.mesh, map, plan.belief)),
        misfit(simulated, map, plan.equilibrium) {
    if (!memory.folder.empty()) {
      const ModelState state{[this] { return misfit.state(); },
                             [this](std::span<const double> x) { misfit.set_state(x); }};
      journal.emplace(misfit, state, memory.folder / name, fingerprint, memory.start);
    }
    with_layers.emplace(recorded());
  }

  LeastSquares& model() { return *with_layers; }
  LeastSquares& recorded() { return journal ? static_cast<LeastSquares&>(*journal) : misfit; }

  ParameterMap map;
  std::unique_ptr<Regularizer> prior;
  Misfit misfit;
  std::optional<Journal> journal;
  std::optional<WithUncertainLayers> with_layers;
};

class MaterialFit {
 public:
  MaterialFit(const DataSet& data, const FitPlan& plan, const FitMemory& memory, const FitWitness& witness)
      : data_(data),
        plan_(completed(plan, data.experiment)),
        memory_(memory),
        witness_(witness),
        simulated_(refined(data.experiment, plan_.refine)),
        experiment_(simulated_),
        fitted_(without_groups(simulated_, plan_.left_out)) {
    if (!memory.folder.empty()) fingerprint_ = fingerprint_of(data.experiment) + "\n" + text_of(plan_);
    outcome_.plan = plan_;
    outcome_.simulated_tets = simulated_.mesh.tet_count();
  }

  FitOutcome run() {
    const bool is_field = !are_single_values(plan_.unknowns);
    if (is_field || plan_.mesh_errors) {
      if (!fit_single_values("uniform")) return std::move(outcome_);
      if (plan_.mesh_errors && take_off_mesh_errors() && !fit_single_values("uniform_corrected"))
        return std::move(outcome_);
      if (!is_field) outcome_.uniform.reset();
    }
    fit_fields();
    return std::move(outcome_);
  }

 private:
  // One value per quantity explains most of the data, and is where the fields begin. False: nothing comes after it.
  bool fit_single_values(const std::string& name) {
    begin(FitStage::uniform, "one value for the whole body");
    FitOptions options = plan_.fit;
    options.method = options.weight_rule = "auto";
    options.weight = -1;
    for (const double factor : kStiffer) {
      std::vector<Unknown> unknowns = as_single_values(plan_.unknowns);
      for (Unknown& u : unknowns)
        if (u.quantity == "young") u.guess *= factor;
      Stage stage(data_.experiment, fitted_, plan_, std::move(unknowns), memory_, name + suffix(factor), fingerprint_);
      const FitReport report = fit_stage(FitStage::uniform, stage, options);
      outcome_.uniform = outcome_.report = report;
      if (report.p.empty() || report.status == Status::undefined) {
        outcome_.failure = words_of_failure(report, stage.misfit);
        continue;
      }
      outcome_.failure.clear();
      for (size_t u = 0; u < plan_.unknowns.size(); ++u)
        plan_.unknowns[u].guess = stage.map.values(static_cast<int>(u), report.p).front();
      material_ = stage.map.parameters(report.p);
      outcome_.failure = words_of_runaway(material_.front());
      if (!outcome_.failure.empty()) return false;
      if (report.status != Status::interrupted) return true;
      describe(stage, report.p);
      return false;
    }
    return false;
  }

  // Readings that no stiffness makes smaller or larger, such as forces of a body that they do not belong to.
  std::string words_of_runaway(const MaterialParameters& material) const {
    const double young = young_modulus(material.lame);
    if (young >= kSoftest && young <= kStiffest) return "";
    const std::vector<LoadCase>& cases = data_.experiment.cases;
    const bool has_positions =
        std::any_of(cases.begin(), cases.end(), [](const LoadCase& c) { return !c.positions.empty(); });
    return "the readings do not determine the stiffness: it ran to " + number_text(young) + " Pa; check the units of " +
           (has_positions ? "lengths and forces" : "lengths and forces, and state the positions of some markers") +
           ", and that loads and readings belong to the same body";
  }

  // With the row of the first case that could not be solved.
  std::string words_of_failure(const FitReport& report, const Misfit& misfit) const {
    const std::string& why = misfit.failure();
    const auto is_named = [&](const LoadCase& c) {
      return why.starts_with(c.name + ",") || why.starts_with(c.name + ":");
    };
    const std::vector<LoadCase>& cases = data_.experiment.cases;
    const auto found = std::find_if(cases.begin(), cases.end(), is_named);
    if (found == cases.end())
      return report.words + (why.empty() ? "" : " (" + why + ")") + "; aspic fit --check tells which rows are odd";
    return report.words + "\n" + data_.source.load_case(static_cast<int>(found - cases.begin())) + ": " +
           why.substr(0, why.find("; ")) + "; check its load and its pose, or take the row out";
  }

  // Which row is explained worst, when that is far more than noise.
  void warn_of_misfit(const Misfit& misfit, std::span<const double> r) {
    const double count = static_cast<double>(r.size()), usual = inner_product(r, r) / count;
    if (!(usual > std::max(kUnexplained, 1 + 5 * std::sqrt(2 / count)))) return;
    double worst = 0;
    int worst_case = 0, fitted = 0;
    for (size_t c = 0; c < data_.experiment.cases.size(); ++c) {
      if (is_left_out(data_.experiment.cases[c])) continue;
      const auto [first, number] = misfit.residuals_of(fitted++);
      const std::span<const double> own = r.subspan(first, number);
      const double mean = number > 0 ? inner_product(own, own) / number : 0;
      if (mean > worst) worst = mean, worst_case = static_cast<int>(c);
    }
    outcome_.warnings.push_back(data_.source.load_case(worst_case) + " ('" + data_.experiment.cases[worst_case].name +
                                "') is explained worst: its readings are missed by " +
                                std::to_string(std::lround(std::sqrt(worst))) +
                                " standard deviations; check this row, or state deviations that cover the errors of "
                                "mesh and model");
  }

  // False: they are not known, and the data remain as they are.
  bool take_off_mesh_errors() {
    if (!may_go_on()) return false;
    if (simulated_.mesh.tet_count() > kTooFine) {
      outcome_.warnings.push_back("--mesh-errors was NOT done: the mesh that is simulated has " +
                                  std::to_string(simulated_.mesh.tet_count()) + " tets, and " +
                                  std::to_string(kTooFine) +
                                  " are the most; the material explains what the mesh gets wrong (a coarser mesh, or a "
                                  "smaller --refine)");
      return plan_.mesh_errors = false;
    }
    begin(FitStage::mesh_errors, "what the mesh gets wrong, by one of eight times as many tets");
    MeshErrors errors = mesh_errors(simulated_, plan_.model, material_, plan_.equilibrium);
    if (errors.cases.empty()) {
      outcome_.warnings.push_back("--mesh-errors was NOT done: on the finer mesh " + errors.failure);
      return plan_.mesh_errors = false;
    }
    errors_ = std::move(errors.cases);
    experiment_ = without_mesh_errors(simulated_, {errors_, {}});
    fitted_ = without_groups(experiment_, plan_.left_out);
    outcome_.mesh_error = relative_size(simulated_, errors_);
    return true;
  }

  static double relative_size(const Experiment& e, const std::vector<MeshError>& errors) {
    double sum = 0, largest = 0;
    int count = 0;
    for (size_t c = 0; c < errors.size(); ++c)
      for (size_t k = 0; k < errors[c].markers.size(); ++k, ++count) {
        const MarkerReading& reading = e.cases[c].positions[k];
        const Vec3d motion = reading.position - position(e.markers[reading.marker], e.mesh.rest);
        sum += dot(errors[c].markers[k], errors[c].markers[k]);
        largest = std::max(largest, dot(motion, motion));
      }
    return largest > 0 ? std::sqrt(sum / count / largest) : -1;
  }

  // As a finer mesh would have it.
  void set_prediction(size_t c, const CasePrediction& on_mesh, std::vector<Vec3d>& markers, Wrench& wrench) const {
    markers = on_mesh.markers;
    wrench = on_mesh.wrench;
    if (errors_.empty()) return;
    for (size_t k = 0; k < markers.size(); ++k) markers[k] = markers[k] + errors_[c].markers[k];
    wrench.force = wrench.force + errors_[c].wrench.force;
    wrench.torque = wrench.torque + errors_[c].wrench.torque;
  }

  static std::string suffix(double factor) {
    if (factor == 1) return "";
    return factor > 1 ? "_stiffer" + std::to_string(std::lround(factor)) : "_softer";
  }

  void fit_fields() {
    begin(FitStage::field, "");
    std::optional<Stage> last;
    std::vector<double> start;
    FitOptions options = plan_.fit;
    for (int pass = 0;; ++pass) {
      const std::string name = pass == 0 ? "fit" : "fit_corrected" + std::to_string(pass);
      last.emplace(data_.experiment, fitted_, plan_, plan_.unknowns, memory_, name, fingerprint_);
      outcome_.report = fit_stage(FitStage::field, *last, options, start);
      const std::vector<double>& p = outcome_.report.p;
      if (!plan_.mesh_errors || !is_success(outcome_.report.status)) break;
      double change = 0;
      for (size_t i = 0; i < start.size(); ++i) change = std::max(change, std::abs(p[i] - start[i]));
      if (pass > 0 && change < (last->map.size() > kFewValues ? kSettledField : kSettled)) break;
      if (pass == kPasses) {
        outcome_.warnings.push_back("what the mesh gets wrong and the material do not settle: after " +
                                    std::to_string(kPasses) + " rounds it still changes by " + std::to_string(change) +
                                    " (of log E); a finer mesh (--refine) makes both smaller");
        break;
      }
      options.weight = outcome_.report.weight;
      start = p;
      material_ = last->map.parameters(p);
      last.reset();
      take_off_mesh_errors();  // else the last ones stay
    }
    Stage& stage = *last;
    const FitReport& report = outcome_.report;
    if (report.p.empty() || report.status == Status::undefined || report.status == Status::no_descent) {
      outcome_.failure = words_of_failure(report, stage.misfit);
      return;
    }
    outcome_.failure = words_of_runaway(stage.map.parameters(report.p).front());
    if (!outcome_.failure.empty()) return;
    if (!is_over(report)) return describe(stage, report.p);
    learn_uncertainty(stage);
    const std::vector<double> p = divided(stage);
    describe(stage, p);
    predict_left_out(stage.map, p);
    if (!outcome_.interrupted) cross_validate_groups(stage);
    if (!outcome_.interrupted) find_next_poke(stage);
  }

  FitReport fit_stage(FitStage which, Stage& stage, const FitOptions& options, const std::vector<double>& start = {}) {
    outcome_.unknowns = stage.map.size();
    outcome_.residuals = stage.misfit.residual_count();
    const auto observe = [&](const FitIteration& iteration, std::span<const double> p) {
      if (!witness_.iterate || witness_.iterate(which, iteration, p)) return true;
      outcome_.interrupted = true;
      if (stage.journal) stage.journal->stop_writing();
      return false;
    };
    FitReport report = fit(stage.model(), *stage.prior, start.empty() ? stage.map.guess() : start, options, observe);
    outcome_.counts = stage.misfit.counts();
    return report;
  }

  void learn_uncertainty(Stage& stage) {
    if (!plan_.uncertainty || !may_go_on()) return;
    begin(FitStage::uncertainty, "what the data do not say");
    WithUncertainLayers about_fit(stage.recorded());
    outcome_.posterior =
        posterior(about_fit, *stage.prior, outcome_.report.weight, stage.map, mesh(), outcome_.report.p);
    add_warnings(outcome_.posterior->warnings);
  }

  // The material in parts, where it is wanted and the data allow it; else that of the field.
  std::vector<double> divided(Stage& stage) {
    const FitReport& report = outcome_.report;
    const auto young = std::find_if(plan_.unknowns.begin(), plan_.unknowns.end(),
                                    [](const Unknown& u) { return u.quantity == "young" && u.spread == Spread::tets; });
    if (plan_.parts == 0 || young == plan_.unknowns.end() || !may_go_on()) return report.p;
    const int unknown = static_cast<int>(young - plan_.unknowns.begin());
    FoundParts& found = outcome_.parts.emplace();
    const int fewest = plan_.parts > 0 ? plan_.parts : 2, most = plan_.parts > 0 ? plan_.parts : kMostParts;
    for (int count = fewest; count <= most && !found.are_kept && may_go_on(); ++count, ++found.tried) {
      begin(FitStage::parts, std::to_string(count) + " parts");
      const Parts parts = find_parts(stage.model(), stage.map, mesh(), report.p, unknown, count);
      found.squares = parts.squares;
      found.are_kept = are_as_good(parts, 2 * report.misfit, outcome_.residuals);
      if (!found.are_kept) continue;
      outcome_.report.misfit = parts.squares / 2;
      return keep(parts, stage.map, unknown, found);
    }
    return report.p;
  }

  std::vector<double> keep(const Parts& parts, const ParameterMap& map, int unknown, FoundParts& found) {
    const PartsEstimate& e = parts.estimate;
    for (size_t k = 0; k < e.levels.size(); ++k) {
      found.values.push_back(map.value(unknown, e.levels[k]));
      double part = 0, all = 0;
      for (int t = 0; t < mesh().tet_count(); ++t) all += volume(mesh(), t), part += volume(mesh(), t) * e.share[k][t];
      found.volume.push_back(part / all);
    }
    if (outcome_.posterior && outcome_.posterior->ok) {
      Posterior& belief = *outcome_.posterior;
      for (size_t t = 0; t < e.deviation.size(); ++t) {  // what was believed of single tets remains
        double& deviation = belief.deviation[unknown][t];
        double& reduction = belief.reduction[unknown][t];
        const double before = deviation * deviation / std::max(1 - reduction, 1e-12);
        deviation = e.deviation[t];
        reduction = std::clamp(1 - deviation * deviation / before, 0.0, 1.0);
      }
    }
    return parts.p;
  }

  // The material of p, its values for people, and what it predicts for the cases that were fitted.
  void describe(Stage& stage, std::span<const double> p) {
    const Posterior* belief = outcome_.posterior && outcome_.posterior->ok ? &*outcome_.posterior : nullptr;
    outcome_.quantities = fitted_quantities(stage.map, mesh(), p, belief);
    outcome_.material = fitted_material(data_, stage.map, p, outcome_.quantities);
    outcome_.counts = stage.misfit.counts();
    outcome_.cases.resize(data_.experiment.cases.size());
    std::vector<double> r(static_cast<size_t>(stage.misfit.residual_count()));
    if (stage.journal) stage.journal->catch_up();
    const bool ok = stage.misfit.evaluate(p, r);
    stage.with_layers->errors().apply(r);
    if (ok) warn_of_misfit(stage.misfit, r);
    int fitted = 0;
    for (size_t c = 0; c < outcome_.cases.size(); ++c) {
      CaseOutcome& outcome = outcome_.cases[c];
      outcome.left_out = is_left_out(data_.experiment.cases[c]);
      if (outcome.left_out) continue;
      const CasePrediction& prediction = stage.misfit.prediction(fitted++);
      if (ok) outcome.ok = true, set_prediction(c, prediction, outcome.markers, outcome.wrench);
    }
  }

  bool is_left_out(const LoadCase& c) const {
    return std::find(plan_.left_out.begin(), plan_.left_out.end(), c.group) != plan_.left_out.end();
  }

  // The cases of a group as a material predicts them; calls use(index of a case of the data, prediction) for each.
  template <class Use>
  void predict_group(const std::string& group, const ParameterMap& map, std::span<const double> p, const Use& use) {
    const Experiment part = subset(experiment_, [&](const LoadCase& c) { return c.group == group; });
    Misfit misfit(part, map, plan_.equilibrium);
    std::vector<double> r(static_cast<size_t>(misfit.residual_count()));
    if (!misfit.evaluate(p, r)) {
      outcome_.warnings.push_back("'" + group + "' could not be predicted: " + misfit.failure());
      return;
    }
    int own = 0;
    for (size_t c = 0; c < data_.experiment.cases.size(); ++c)
      if (data_.experiment.cases[c].group == group) use(c, misfit.prediction(own++));
  }

  void predict_left_out(const ParameterMap& map, std::span<const double> p) {
    for (const std::string& group : plan_.left_out)
      predict_group(group, map, p, [&](size_t c, const CasePrediction& prediction) {
        CaseOutcome& outcome = outcome_.cases[c];
        outcome.ok = outcome.has_held_out = true;
        set_prediction(c, prediction, outcome.markers, outcome.wrench);
        outcome.held_out_markers = outcome.markers;
        outcome.held_out_wrench = outcome.wrench;
      });
  }

  void cross_validate_groups(Stage& stage) {
    if (!plan_.cross_validation || !may_go_on()) return;
    // A fit stops at its deadline: that comes when the witness wants no more.
    const WallClock clock = [&] { return may_go_on() ? 0.0 : std::numeric_limits<double>::infinity(); };
    FitOptions options = plan_.fit;
    options.deadline = Deadline(clock, 1);
    const auto observe = [&](int group, int groups, const std::string& name) {
      begin(FitStage::cross_validation,
            "'" + name + "' is left out (" + std::to_string(group + 1) + " of " + std::to_string(groups) + ")");
      return may_go_on();
    };
    CrossValidation held_out =
        cross_validate(fitted_, stage.map, *stage.prior, outcome_.report, options, plan_.equilibrium, observe);
    if (outcome_.interrupted) return;  // the last group is not to be trusted
    add_warnings(held_out.warnings);
    for (const HeldOut& group : held_out.groups)
      if (group.ok)
        predict_group(group.group, stage.map, group.p, [&](size_t c, const CasePrediction& prediction) {
          CaseOutcome& outcome = outcome_.cases[c];
          outcome.has_held_out = true;
          set_prediction(c, prediction, outcome.held_out_markers, outcome.held_out_wrench);
        });
    outcome_.held_out = std::move(held_out);
  }

  void find_next_poke(Stage& stage) {
    const bool has_tip =
        std::any_of(fitted_.cases.begin(), fitted_.cases.end(), [](const LoadCase& c) { return c.tip.has_value(); });
    if (!outcome_.posterior || !outcome_.posterior->ok || !has_tip || !may_go_on()) return;
    begin(FitStage::next_poke, "where a poke would tell most");
    NextPoke next =
        next_poke(fitted_, mesh(), stage.map, *outcome_.posterior, outcome_.report.p, {}, plan_.equilibrium);
    add_warnings(next.warnings);
    if (!next.candidates.empty() && next.candidates.front().ok) outcome_.next_poke = next.candidates.front();
  }

  void begin(FitStage stage, const std::string& what) {
    if (witness_.begin) witness_.begin(stage, what);
  }

  bool may_go_on() {
    if (witness_.go_on && !witness_.go_on()) outcome_.interrupted = true;
    return !outcome_.interrupted;
  }

  void add_warnings(const std::vector<std::string>& more) {
    outcome_.warnings.insert(outcome_.warnings.end(), more.begin(), more.end());
  }

  const TetMesh& mesh() const { return data_.experiment.mesh; }  // of the material

  const DataSet& data_;
  FitPlan plan_;
  const FitMemory& memory_;
  const FitWitness& witness_;
  Experiment simulated_;                      // on its mesh
  Experiment experiment_;                     // without what the mesh gets wrong
  Experiment fitted_;                         // and without what is left out
  std::vector<MeshError> errors_;             // of each case; empty: not known
  std::vector<MaterialParameters> material_;  // for which they are computed
  std::string fingerprint_;
  FitOutcome outcome_;
};

}  // namespace

FitOutcome fit_material(const DataSet& data, const FitPlan& plan, const FitMemory& memory, const FitWitness& witness) {
  FitOutcome outcome = MaterialFit(data, plan, memory, witness).run();
  if (outcome.posterior) outcome.posterior->belief.reset();  // refers to the prior, which is gone
  return outcome;
}

}  // namespace aspic
