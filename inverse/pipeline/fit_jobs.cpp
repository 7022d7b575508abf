#include "pipeline/fit_jobs.h"

#include <utility>

#include "base/error.h"
#include "io/checkpoint.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

const char* const kVersion = "aspic fit job 1";

fs::path file_of(const fs::path& folder, const std::string& name) { return folder / (name + ".result"); }

// A damaged file counts as missing.
std::optional<JobResult> stored(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  try {
    const Checkpoint saved = read_checkpoint(file);
    if (saved.fingerprint != kVersion) return std::nullopt;
    JobResult result{saved.array("numbers"), {}};
    for (const double code : saved.array("text")) result.text += static_cast<char>(code);
    return result;
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

void store(const fs::path& file, const JobResult& result) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) throw InvalidInput(file.parent_path().string() + ": cannot be created: " + error.message());
  write_checkpoint(file, {.fingerprint = kVersion,
                          .arrays = {{"numbers", result.numbers}, {"text", {result.text.begin(), result.text.end()}}},
                          .integers = {}});
}

// Counts are exact in doubles.
template <class Group, class Action>
void for_each_number(Group& h, const Action& action) {
  for (auto* errors : {&h.positions, &h.forces, &h.torques}) {
    double count = errors->count;
    action(count);
    if constexpr (!std::is_const_v<Group>) errors->count = static_cast<int>(count);
    for (auto* number : {&errors->peak, &errors->error, &errors->noise}) action(*number);
  }
  action(h.largest_error);
}

JobResult result_of(const HeldOut& h) {
  JobResult result{{h.ok ? 1.0 : 0.0}, h.failure};
  for_each_number(h, [&](double number) { result.numbers.push_back(number); });
  result.numbers.insert(result.numbers.end(), h.p.begin(), h.p.end());
  return result;
}

HeldOut held_out_of(const std::string& group, const JobResult& result) {
  HeldOut h{.group = group};
  size_t at = 0;
  h.ok = result.numbers.at(at++) != 0;
  for_each_number(h, [&](double& number) { number = result.numbers.at(at++); });
  h.failure = result.text;
  h.p.assign(result.numbers.begin() + static_cast<std::ptrdiff_t>(at), result.numbers.end());
  return h;
}

}  // namespace

FitJobs::FitJobs(fs::path folder, JobMode mode, std::string name)
    : folder_(std::move(folder)), mode_(mode), name_(std::move(name)) {}

bool FitJobs::is_done(const fs::path& folder, const std::string& name) {
  return stored(file_of(folder, name)).has_value();
}

std::optional<JobResult> FitJobs::result(const std::string& job, const Fingerprint& question, JobKind kind,
                                         const Compute& compute) {
  if (folder_.empty()) return compute();
  const std::string name = job + "-" + hex_digits(question.value());
  const fs::path file = file_of(folder_, name);
  if (std::optional<JobResult> known = stored(file)) return known;
  const bool is_mine = kind == JobKind::common || mode_ == JobMode::all || (mode_ == JobMode::single && name == name_);
  if (!is_mine) {
    is_waiting_ = true;
    if (mode_ == JobMode::list) missing_.push_back(name);
    return std::nullopt;
  }
  std::optional<JobResult> computed = compute();
  if (!computed) return std::nullopt;
  store(file, *computed);
  if (kind == JobKind::independent && mode_ == JobMode::single) is_waiting_ = has_computed_ = true;
  return computed;
}

HeldOutStore HeldOutJobs::store(const Corrected& experiment, const FitReport& fitted) const {
  Fingerprint question;
  const std::string text = text_of(plan) + fingerprint_of(experiment);
  question.add(text.data(), text.size());
  question.add(fitted.p.data(), fitted.p.size() * sizeof(double));
  question.add(&fitted.weight, sizeof fitted.weight);
  return [*this, question](int group, const std::string& label, const auto& compute) -> std::optional<HeldOut> {
    Fingerprint of_group = question;
    of_group.add(label.data(), label.size());
    const auto result = jobs.result(name + "_" + std::to_string(group + 1), of_group, JobKind::independent, [&] {
      const HeldOut computed = compute();
      return is_stopped() ? std::nullopt : std::optional(result_of(computed));
    });
    if (!result) return std::nullopt;
    return held_out_of(label, *result);
  };
}

}  // namespace aspic
