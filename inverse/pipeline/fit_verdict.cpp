#include "pipeline/fit_verdict.h"

#include <algorithm>
#include <cmath>

#include "base/formatted.h"
#include "data/stated_errors.h"
#include "model/gauge.h"
#include "model/limits.h"

namespace aspic {
namespace {

// Compares the readings of a group with the predictions.
class GroupMisfit {
 public:
  explicit GroupMisfit(std::string name) : name_(std::move(name)) {}

  void add(const LoadCase& load, const CaseOutcome& outcome) {
    for (size_t k = 0; k < load.positions.size(); ++k)
      add(outcome.markers[k] - load.positions[k].position, outcome.marker_sigma[k], 3, positions_);
    if (load.force)
      add_answer(to_gauge(load.gauge, *load.force), to_gauge(load.gauge, outcome.wrench.force),
                 gauge_sigma(load.gauge, outcome.force_sigma), forces_);
    if (load.torque)
      add_answer(to_gauge(load.torque_gauge, *load.torque), to_gauge(load.torque_gauge, outcome.wrench.torque),
                 gauge_sigma(load.torque_gauge, outcome.torque_sigma), torques_);
  }

  const std::string& name() const { return name_; }
  // Reading type with the largest error, in standard deviations.
  std::pair<std::string, double> missed_most() const {
    std::pair<std::string, double> worst = {"positions", positions_.rms()};
    if (forces_.rms() > worst.second) worst = {"forces", forces_.rms()};
    if (torques_.rms() > worst.second) worst = {"torques", torques_.rms()};
    return worst;
  }
  // Stiffness implied by forces and torques, relative to the fitted one, and its standard deviation; 0: unknown.
  double stiffness() const { return squares_ > 0 ? product_ / squares_ : 0; }
  double stiffness_sigma() const { return squares_ > 0 ? 1 / std::sqrt(squares_) : 0; }

 private:
  struct Sum {
    double squares = 0;
    int count = 0;
    double rms() const { return count > 0 ? std::sqrt(squares / count) : 0; }
  };
  // A vector counts as `numbers` readings: its length in standard deviations, or each coordinate.
  static void add(const Vec3d& error, const Vec3d& sigma, int numbers, Sum& sum) {
    for (int i = 0; i < 3; ++i) sum.squares += error[i] * error[i] / (sigma[i] * sigma[i]);
    sum.count += numbers;
  }
  void add_answer(const Vec3d& measured, const Vec3d& shown, const Vec3d& sigma, Sum& sum) {
    add(shown - measured, sigma, 1, sum);
    for (int i = 0; i < 3; ++i) {
      const double precision = 1 / (sigma[i] * sigma[i]);
      product_ += precision * shown[i] * measured[i];
      squares_ += precision * shown[i] * shown[i];
    }
  }

  std::string name_;
  Sum positions_, forces_, torques_;
  double product_ = 0, squares_ = 0;
};

std::vector<GroupMisfit> fitted_groups(const DataSet& data, const FitOutcome& outcome) {
  std::vector<GroupMisfit> groups;
  for (size_t c = 0; c < outcome.cases.size(); ++c) {
    const LoadCase& load = data.experiment.cases[c];
    if (!outcome.cases[c].ok || outcome.cases[c].left_out) continue;
    auto own = std::find_if(groups.begin(), groups.end(), [&](const GroupMisfit& g) { return g.name() == load.group; });
    if (own == groups.end()) own = groups.insert(groups.end(), GroupMisfit(load.group));
    own->add(load, outcome.cases[c]);
  }
  return groups;
}

double root_mean_square(const std::vector<PredictionErrors>& groups, double PredictionErrors::*error) {
  double squares = 0, count = 0;
  for (const PredictionErrors& group : groups)
    if (group.*error >= 0) squares += group.*error * (group.*error), ++count;
  return count > 0 ? std::sqrt(squares / count) : -1;
}

double beyond_noise(const ReadingErrors& e, double largest) {
  constexpr double kLeastPeak = 10;  // standard deviations; the limit of 10 % of a smaller peak is below the noise
  if (!(e.peak > 0)) return -1;
  return std::sqrt(std::max(e.error * e.error - e.noise * e.noise, 0.0)) /
         std::max({largest, e.peak, kLeastPeak * e.noise});
}

std::string percents(const PredictionErrors& errors) {
  std::string text;
  for (const ReadingKind& kind : kReadingKinds) {
    const double error = errors.*kind.beyond_noise;
    if (error < 0) continue;
    text += (text.empty() ? "" : ", ") + three_digits(100 * error) + " % (" + kind.name + "s)";
  }
  return text.empty() ? "-" : text;
}

// How well a good fit explains the readings.
std::string explained(const FitOutcome& outcome) {
  const double count = std::max(outcome.residuals, 1), squares = 2 * outcome.report.misfit / count;
  const bool is_within = squares <= 1 + 3 * std::sqrt(2 / count);  // the scatter of chi^2
  return "the fit explains the readings within " + (is_within ? "" : three_digits(std::sqrt(squares)) + " times ") +
         "their standard deviations";
}

class Reasons {
 public:
  Reasons(const DataSet& data, const FitOutcome& outcome) : data_(data), outcome_(outcome) {}

  void add_against_field() {
    if (!outcome_.mesh_errors_settle)
      add("mesh_not_settled",
          "the corrections of the data for mesh, systematic errors or outliers and the material do not converge: "
          "refine the mesh (option refine)");
    for (const std::string& where : outcome_.at_bound)
      add("at_bound", where + " is at its bound: the readings do not determine it");
    add_missed_groups();
    add_worse_than_one_value();
  }

  void add_others() {
    for (size_t c = 0; c < outcome_.cases.size(); ++c)
      if (outcome_.cases[c].relative_mesh_error > kLinearRange) {
        add("mesh_too_coarse",
            "'" + data_.experiment.cases[c].name + "': the mesh changes the force by a factor of " +
                three_digits(1 + outcome_.cases[c].relative_mesh_error) +
                "; refine it around the indenter (option refine) or use a wider one",
            1 + outcome_.cases[c].relative_mesh_error, 1 + kLinearRange);
        break;
      }
    add_linear_tets();
    add_disagreement();
    for (const EstimatedError& e : outcome_.errors)
      if (e.stated && e.unit.empty() && e.coefficient() > kLargestFriction)
        add("at_bound", "the " + e.name + " is " + three_digits(e.coefficient()) + ", and no dry contact exceeds " +
                            three_digits(kLargestFriction) +
                            ": the tip sticks (contact = \"bonded\"), or the readings do not determine it");
    for (const FoundFibres& f : outcome_.fibres)
      if (f.cone >= 90)
        add("fibres_undetermined",
            "the readings do not determine the direction of the fibres " +
                (f.where == "everywhere" ? f.where : "in " + f.where) +
                ": fibres act in tension only, so stretch the body along several axes",
            f.cone, 90);
    const double squares = outcome_.residuals > 0 ? 2 * outcome_.report.misfit / outcome_.residuals : 0;
    if (squares > kTooManySquares)
      add("unexplained",
          "|r|^2 is " + three_digits(squares) +
              " per reading: the model is too simple, or the standard deviations are too small",
          squares, kTooManySquares);
    for (const FoundCommonError& error : outcome_.common_errors)
      if (std::abs(error.sigmas) > kManySigmas)
        add("unexplained",
            "the readings need " + three_digits(std::abs(error.sigmas)) + " standard deviations of the error of " +
                error.cause + ": the model is wrong, or the readings",
            std::abs(error.sigmas), kManySigmas);
    add_poor_predictions();
  }

  void add_about_relaxation(const RelaxationFit& fit) {
    if (!fit.is_ok()) return add("relaxation_failed", fit.failure);
    if (!fit.undetermined.empty()) add("relaxation_undetermined", fit.undetermined);
    if (fit.squares > kTooManySquares * fit.residuals)
      add("relaxation_unexplained", "|r|^2 of the histories is " + three_digits(fit.squares / fit.residuals) +
                                        " per reading: the branches do not explain them");
  }

  void add_about_laws(const LawChoice& choice) {
    if (!choice.has_supported())
      add("no_good_law",
          "none of the compared laws has a good verdict: more readings, larger standard deviations, or "
          "fewer values");
  }

  std::vector<FitReason> take() { return std::move(reasons_); }
  void add(std::string name, std::string text, std::optional<double> value = {}, std::optional<double> limit = {}) {
    reasons_.push_back({std::move(name), std::move(text), value, limit});
  }

 private:
  void add_linear_tets() {
    const std::optional<LinearTetError> error = linear_tet_error(data_, outcome_);
    if (!error) return;
    const std::string what =
        "linear tets were simulated, because the mesh has more than " + std::to_string(kMaxQuadratic) + " tets, and ";
    const std::string remedy = ": use order = 2 in capture.toml, or a coarser mesh";
    if (error->of_stiffness < 0)
      add("linear_tets", what + "their error is unknown" + remedy);
    else if (error->of_stiffness > kNegligible)
      add("linear_tets",
          what + "may leave an error of " + three_digits(100 * error->of_stiffness) +
              " % in the stiffness, as much as the correction for the mesh" + remedy,
          error->of_stiffness, kNegligible);
  }

  void add_poor_predictions() {
    const std::vector<PredictionErrors> groups = beyond_noise(data_, predicted_groups(data_, outcome_));
    const PredictionErrors all = held_out_errors(data_, outcome_);
    const std::string remedy = " beyond the noise: fit fewer values, measure more, or trust it only near pokes";
    if (all.is_poor(1)) {
      add_excess("predicts_badly", "held-out groups are predicted with errors of " + percents(all) + remedy, all, 1);
    } else {
      for (const PredictionErrors& group : groups)
        if (group.is_poor(kSingle))
          return add_excess("predicts_badly",
                            "'" + group.group + "' is predicted with errors of " + percents(group) + remedy, group,
                            kSingle);
    }
  }

  // Adds the error that exceeds its limit most.
  void add_excess(const std::string& name, const std::string& text, const PredictionErrors& errors, double factor) {
    const ReadingKind& worst = errors.worst();
    add(name, text, errors.*worst.beyond_noise, factor * worst.limit);
  }

  void add_missed_groups() {
    for (const GroupError& e : group_errors(data_, outcome_))
      if (e.sigmas > kManySigmas)
        add("group_missed",
            "the " + e.readings + " of '" + e.group + "' are missed by " + three_digits(e.sigmas) +
                " standard deviations",
            e.sigmas, kManySigmas);
  }

  void add_worse_than_one_value() {
    if (!outcome_.held_out || !outcome_.held_out_of_one_value) return;
    const CrossValidation &field = *outcome_.held_out, &one = *outcome_.held_out_of_one_value;
    const auto error = [](const CrossValidation& v) {
      return std::hypot(std::max(v.position_error, 0.0), std::max(v.force_error, 0.0), std::max(v.torque_error, 0.0));
    };
    if (error(field) > kNoiseRatio * error(one))
      add("held_out_worse",
          "held-out groups are predicted with errors, including the noise, of " +
              percents({"", field.position_error, field.force_error, field.torque_error}) +
              " of their peaks, by one value with " +
              percents({"", one.position_error, one.force_error, one.torque_error}),
          error(field), kNoiseRatio * error(one));
  }

  void add_disagreement() {
    const std::vector<GroupMisfit> all = fitted_groups(data_, outcome_);
    const GroupMisfit *softest = nullptr, *stiffest = nullptr;
    for (const GroupMisfit& g : all) {
      if (!(g.stiffness() > 0)) continue;
      if (!softest || g.stiffness() < softest->stiffness()) softest = &g;
      if (!stiffest || g.stiffness() > stiffest->stiffness()) stiffest = &g;
    }
    if (!softest) return;
    const double ratio = stiffest->stiffness() / softest->stiffness();
    const double sigma = std::hypot(stiffest->stiffness_sigma() / stiffest->stiffness(),
                                    softest->stiffness_sigma() / softest->stiffness());
    if (ratio > kClearRatio && std::log(ratio) > kManySigmas * sigma)
      add("groups_disagree",
          "the forces of '" + stiffest->name() + "' imply a body " + three_digits(ratio) +
              " times as stiff as those of '" + softest->name() +
              "': one of them is wrong, or the model does not fit the body",
          ratio, kClearRatio);
  }

  const DataSet& data_;
  const FitOutcome& outcome_;
  std::vector<FitReason> reasons_;
};

HeldOut left_out_group(const DataSet& data, const FitOutcome& outcome, const std::string& name) {
  const Measured group = subset(data.experiment, [&](const LoadCase& c) { return c.group == name; });
  std::vector<CasePrediction> predictions;
  for (size_t c = 0; c < outcome.cases.size(); ++c) {
    if (data.experiment.cases[c].group != name) continue;
    if (!outcome.cases[c].ok) return {.group = name, .failure = "could not be predicted"};
    CasePrediction& prediction = predictions.emplace_back();
    prediction.markers = outcome.cases[c].markers;
    prediction.wrench = outcome.cases[c].wrench;
  }
  if (predictions.empty() || predictions.size() != group.cases.size())
    return {.group = name, .failure = "was not predicted"};
  return compare(group, predictions);
}

}  // namespace

bool PredictionErrors::is_poor(double factor) const {
  return std::any_of(std::begin(kReadingKinds), std::end(kReadingKinds),
                     [&](const ReadingKind& kind) { return this->*kind.beyond_noise > factor * kind.limit; });
}

const ReadingKind& PredictionErrors::worst() const {
  return *std::max_element(std::begin(kReadingKinds), std::end(kReadingKinds),
                           [&](const ReadingKind& a, const ReadingKind& b) {
                             return this->*a.beyond_noise / a.limit < this->*b.beyond_noise / b.limit;
                           });
}

std::vector<GroupError> group_errors(const DataSet& data, const FitOutcome& outcome) {
  std::vector<GroupError> errors;
  for (const GroupMisfit& g : fitted_groups(data, outcome)) {
    const auto [readings, sigmas] = g.missed_most();
    errors.push_back({g.name(), readings, sigmas});
  }
  return errors;
}

std::vector<HeldOut> predicted_groups(const DataSet& data, const FitOutcome& outcome) {
  std::vector<HeldOut> groups;
  if (outcome.held_out) groups = outcome.held_out->groups;
  for (const std::string& name : outcome.plan.left_out) groups.push_back(left_out_group(data, outcome, name));
  return groups;
}

HeldOut largest_readings(const DataSet& data) {
  std::vector<CasePrediction> measured;
  for (const LoadCase& c : data.experiment.cases) {
    CasePrediction& own = measured.emplace_back();
    for (const MarkerReading& reading : c.positions) own.markers.push_back(reading.position);
    own.wrench = {c.force.value_or(Vec3d{}), c.torque.value_or(Vec3d{})};
  }
  return compare(data.experiment, measured);
}

std::vector<PredictionErrors> beyond_noise(const DataSet& data, const std::vector<HeldOut>& groups) {
  const HeldOut all = largest_readings(data);
  std::vector<PredictionErrors> errors;
  for (const HeldOut& group : groups)
    if (group.ok) errors.push_back({.group = group.group});
  for (const ReadingKind& kind : kReadingKinds) {
    auto of_group = errors.begin();
    for (const HeldOut& group : groups)
      if (group.ok) (*of_group++).*kind.beyond_noise = beyond_noise(group.*kind.errors, (all.*kind.errors).peak);
  }
  return errors;
}

PredictionErrors all_groups(const std::vector<PredictionErrors>& groups) {
  PredictionErrors all;
  for (const ReadingKind& kind : kReadingKinds) all.*kind.beyond_noise = root_mean_square(groups, kind.beyond_noise);
  return all;
}

PredictionErrors held_out_errors(const DataSet& data, const FitOutcome& outcome) {
  return all_groups(beyond_noise(data, predicted_groups(data, outcome)));
}

std::optional<LinearTetError> linear_tet_error(const DataSet& data, const FitOutcome& outcome) {
  if (!data.is_order_reduced || !outcome.plan.mesh_errors) return {};
  if (!outcome.has_mesh_errors) return LinearTetError{};
  LinearTetError error{std::max(outcome.mesh_error, 0.0)};
  for (const CaseOutcome& c : outcome.cases) error.of_stiffness = std::max(error.of_stiffness, c.relative_mesh_error);
  return error;
}

std::vector<FitReason> reasons_against_field(const DataSet& data, const FitOutcome& outcome) {
  Reasons reasons(data, outcome);
  reasons.add_against_field();
  return reasons.take();
}

FitVerdict verdict(const DataSet& data, const FitOutcome& outcome) {
  FitVerdict result;
  if (outcome.interrupted) {
    result.reasons = {{"interrupted", "the same command with --resume continues the fit"}};
    result.text = "Interrupted: this is the current estimate.";
    return result;
  }
  Reasons reasons(data, outcome);
  if (!is_success(outcome.report.status)) reasons.add("not_converged", outcome.report.message);
  for (const FitReason& reason : outcome.against_field)
    reasons.add("field_rejected", "one value replaces the field: " + reason.text, reason.value, reason.limit);
  reasons.add_against_field();
  reasons.add_others();
  if (outcome.relaxation) reasons.add_about_relaxation(*outcome.relaxation);
  if (outcome.law_choice) reasons.add_about_laws(*outcome.law_choice);
  result.reasons = reasons.take();
  result.text = result.is_good() ? "Converged; " + explained(outcome) + "."
                                 : "Do not rely on this material: " + result.reasons.front().text + ".";
  return result;
}

}  // namespace aspic
