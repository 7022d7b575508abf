// `aspic fit`: fits a material to measurements, with progress, and resumes interrupted fits. `aspic fit-jobs`: the same
// fit in many processes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "aspic/interrupt.h"
#include "aspic/job_list.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/printable.h"
#include "commands/commands.h"
#include "commands/fit_figures.h"
#include "commands/fit_options.h"
#include "commands/fit_progress.h"
#include "commands/fit_report.h"
#include "commands/fit_summary.h"
#include "commands/law_table.h"
#include "commands/relaxation_results.h"
#include "data/histories.h"
#include "io/atomic_file.h"
#include "material/registry.h"
#include "model/quantity.h"
#include "pipeline/fit_folder.h"
#include "pipeline/fit_run.h"
#include "pipeline/fit_verdict.h"
#include "pipeline/law_choice.h"
#include "scene/value.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

struct FitArguments {
  fs::path data, out = "material.vtu", options;
  std::string registers;  // "rigid", "similarity"; empty: none
  std::string model = FitPlan().model;
  std::vector<std::string> parameters, known;
  int threads = 0;  // 0: not given
  bool force = false, resume = false, quiet = false, verbose = false, allow_unconverged = false;
  bool lists_jobs = false;
  std::string job, program = "aspic";  // job: the single one to compute

  JobMode mode() const { return lists_jobs ? JobMode::list : job.empty() ? JobMode::all : JobMode::single; }
};

std::optional<RegistrationKind> registration_kind(const FitArguments& arguments) {
  if (arguments.registers.empty()) return std::nullopt;
  return arguments.registers == "rigid" ? RegistrationKind::rigid : RegistrationKind::similarity;
}

FitPlan plan_of(const FitArguments& arguments) {
  FitPlan plan;
  plan.model = arguments.model == kAutoLaw ? kAutoLaw : material_info(arguments.model).name;
  for (const std::string& text : arguments.parameters) plan.parameters.push_back(parse_parameter(text));
  for (const std::string& text : arguments.known) plan.known.push_back(parse_known(text));
  return plan;
}

// Comments for options.toml: where each option comes from.
std::string origins_of(const FitArguments& arguments, const fs::path& options_file) {
  std::string text = "\n# Origins of the options\n";
  const auto add = [&](const std::string& option, const std::string& origin) {
    text += "# " + option + ": " + origin + "\n";
  };
  const std::string given = "command line", fallback = "default";
  add("model", arguments.model == FitPlan().model ? fallback : given);
  const std::string law = arguments.model == kAutoLaw ? FitPlan().model : arguments.model;  // with E and nu
  std::vector<std::string> quantities;
  for (const Quantity& quantity : material_quantities(law)) quantities.push_back(quantity.name);
  if (fibre_components(law)) quantities.emplace_back(kFibreDirection);
  for (const std::string& quantity : quantities) {
    const auto names = [&](const std::string& option) { return option.starts_with(quantity + "="); };
    const bool is_given = std::any_of(arguments.parameters.begin(), arguments.parameters.end(), names) ||
                          std::any_of(arguments.known.begin(), arguments.known.end(), names);
    add(quantity, is_given ? given : fallback);
  }
  for (const OptionOrigin& origin : fit_option_origins(options_file)) add(origin.option, origin.place);
  return text;
}

ExistingFit existing(const FitArguments& arguments) {
  if (arguments.resume) return ExistingFit::resume;
  if (!arguments.job.empty()) return ExistingFit::share;
  if (arguments.lists_jobs) return ExistingFit::proceed;
  return arguments.force ? ExistingFit::overwrite : ExistingFit::refuse;
}

std::string describe(const DataFinding& finding) {
  return finding.where + ": " + finding.what + (finding.remedy.empty() ? "" : "; ") + finding.remedy;
}

// Rejects data sets with errors and prints the first warnings of others, but not for each job.
void check_findings(const DataSet& data, const FitArguments& arguments) {
  constexpr int kMaxPrinted = 3;
  const fs::path& path = arguments.data;
  std::vector<std::string> errors, warnings;
  for (const DataFinding& finding : diagnose(data)) {
    if (finding.severity == Severity::error) errors.push_back(describe(finding));
    if (finding.severity == Severity::warning) warnings.push_back(describe(finding));
  }
  if (!errors.empty()) {
    errors.push_back(fmt::format("(aspic check {} prints details)", path.string()));
    throw InvalidInput(errors);
  }
  const int count = arguments.job.empty() ? static_cast<int>(warnings.size()) : 0;
  for (int i = 0; i < std::min(count, kMaxPrinted); ++i) fmt::print(stderr, "warning: {}\n", warnings[i]);
  if (count > kMaxPrinted)
    fmt::print(stderr, "warning: and {} more: aspic check {}\n", count - kMaxPrinted, printable(path.string()));
}

// Runs one fit and notifies its observers.
class Fitter {
 public:
  Fitter(const FitArguments& arguments, const DataSet& data, const FitPlan& plan, FitFolder& folder)
      : data_(data),
        plan_(plan),
        folder_(folder),
        jobs_(folder.jobs(), arguments.mode(), arguments.job),
        residuals_(residual_count(data, plan)) {
    if (!arguments.quiet) progress_.emplace(stdout, arguments.verbose);
  }

  FitOutcome run() {
    const FitCallbacks callbacks{.begin = [this](FitStage stage, const std::string& what) { begin(stage, what); },
                                 .iterate = [this](FitStage stage, const FitIteration& iteration,
                                                   std::span<const double>) { iterate(stage, iteration); },
                                 .stop = StopToken([this] { return is_interrupted(); })};
    FitMemory memory = folder_.memory();
    memory.jobs = &jobs_;
    FitOutcome outcome = fit_material(data_, plan_, memory, callbacks);
    if (progress_) progress_->finish();
    return outcome;
  }

  const std::vector<FitIteration>& history() const { return history_; }
  const FitJobs& jobs() const { return jobs_; }

 private:
  static int residual_count(const DataSet& data, const FitPlan& plan) {
    size_t count = 0;
    for (const LoadCase& c : data.experiment.cases) {
      if (is_left_out(plan.left_out, c)) continue;
      count += 3 * (c.positions.size() + (c.force ? 1 : 0) + (c.torque ? 1 : 0));
    }
    return static_cast<int>(count);
  }

  void begin(FitStage stage, const std::string& what) {
    if (stage == FitStage::law) history_.clear();  // that of another law
    if (progress_) progress_->begin(stage, what);
  }

  void iterate(FitStage stage, const FitIteration& iteration) {
    if (jobs_.mode() != JobMode::single) folder_.add(stage, iteration);
    if (stage == FitStage::field) history_.push_back(iteration);
    if (!progress_) return;
    if (is_first_ && !folder_.is_resumed() && jobs_.mode() == JobMode::all)
      progress_->show_expected(plan_, data_.experiment);
    is_first_ = false;
    progress_->show(stage, iteration, residuals_);
  }

  bool is_interrupted() {
    if (!interrupt_signal()) return false;
    if (progress_ && !announced_) progress_->message("stopping; Ctrl-C again ends immediately");
    return announced_ = true;
  }

  const DataSet& data_;
  const FitPlan& plan_;
  FitFolder& folder_;
  FitJobs jobs_;
  int residuals_;
  bool announced_ = false, is_first_ = true;
  std::optional<FitProgress> progress_;
  std::vector<FitIteration> history_;
};

void print_start(const FitArguments& arguments, const DataSet& data, const FitPlan& plan, const FitFolder& folder) {
  for (const std::string& note : data.notes) fmt::print("note: {}\n", note);
  const Experiment& e = data.experiment;
  fmt::print("{}: {}, {} markers, {} cases in {} groups; {} threads; into {}\n", data.name, mesh_text(e.mesh),
             e.markers.size(), e.cases.size(), groups_of(e).size(), thread_count(), arguments.out.string());
  std::string parameters;
  for (const FitParameter& u : plan.parameters) parameters += (parameters.empty() ? "" : ", ") + text_of(u);
  fmt::print("{}: {}\n", plan.model, parameters.empty() ? "no parameters to fit" : parameters);
  if (plan.refine > 0)
    fmt::print("simulated on {:.0f} tets, each of the mesh in {:.0f} (refine = {})\n",
               e.mesh.tet_count() * std::pow(8, plan.refine), std::pow(8, plan.refine), plan.refine);
  if (folder.is_resumed()) fmt::print("resuming after {} iterations\n", folder.iterations_before());
  std::fflush(stdout);
}

// Prints how to use the material in a scene.
void print_use(const FitArguments& arguments, const FitOutcome& outcome, const fs::path& folder) {
  if (arguments.quiet) return;
  fmt::print("material   {0}; in a scene: material = {{ file = {1} }}\n", arguments.out.string(),
             toml_string(arguments.out.string()));
  if (outcome.relaxation && outcome.relaxation->is_ok())
    fmt::print("           with the sections of {}, because this is the long-term stiffness\n",
               (folder / "viscoelastic.toml").string());
  if (outcome.interrupted)
    fmt::print("           current estimate; the same command with --resume continues bit-reproducibly\n");
}

int exit_code(const FitArguments& arguments, bool is_good) {
  if (interrupt_signal()) return exit_signal + interrupt_signal();
  return is_good || arguments.allow_unconverged ? exit_done : exit_unconverged;
}

void print_verdict(const FitVerdict& verdict, bool is_quiet) {
  if (verdict.is_good()) {
    if (!is_quiet) fmt::print("verdict    good: {}\n", verdict.text);
    return;
  }
  for (const FitReason& reason : verdict.reasons)
    fmt::print(stderr, "warning: not reliable ({}): {}\n", reason.name, reason.text);
}

// Synthetic data include the truth.
fs::path truth_beside(const fs::path& data) {
  return (fs::is_directory(data) ? data : data.parent_path()) / "truth.vtu";
}

// Command of one job. Threads are those of the process that lists it, if given.
std::string job_line(const FitArguments& arguments, const std::string& job) {
  std::string line = fmt::format("{} fit-jobs {}", arguments.program, shell_word(arguments.data));
  const auto add = [&](const char* option, const std::string& value) {
    line += fmt::format(" {} {}", option, shell_word(value));
  };
  line += " -o " + shell_word(arguments.out);
  if (arguments.model != FitPlan().model) add("--model", arguments.model);
  for (const std::string& text : arguments.parameters) add("--unknown", text);
  for (const std::string& text : arguments.known) add("--known", text);
  if (!arguments.registers.empty()) add("--register", arguments.registers);
  if (!arguments.options.empty()) line += " --options " + shell_word(arguments.options);
  return fmt::format("{} --threads {} --quiet --job {}\n", line, std::max(arguments.threads, 1), job);
}

int list_jobs(const FitArguments& arguments, const FitFolder& folder, const std::vector<std::string>& missing) {
  JobList jobs{folder.path(), arguments.out.stem().string(), "", std::max(arguments.threads, 1)};
  for (const std::string& job : missing) jobs.lines += job_line(arguments, job);
  write_jobs(jobs);
  if (!arguments.quiet) {
    fmt::print("jobs       {} in {}\n", missing.size(), (folder.path() / "jobs.txt").string());
    print_how_to_run(jobs);
    fmt::print("then       the same command again\n");
  }
  return exit_time_limit;
}

int end_of_job(const FitArguments& arguments, const FitJobs& jobs) {
  if (jobs.has_computed()) return exit_done;
  if (interrupt_signal()) return exit_signal + interrupt_signal();
  throw InvalidInput(fmt::format("--job {}: this fit has no such job, or not yet; the command without --job lists them",
                                 printable(arguments.job)));
}

// Ends a repeated command whose work is done.
int end_of_complete(const FitArguments& arguments) {
  const fs::path figures = fs::path(arguments.out).replace_extension(".fit") / "figures.json";
  const bool is_good = nlohmann::json::parse(read_file(figures)).at("verdict").at("good").get<bool>();
  if (!arguments.quiet) fmt::print("complete   {}; --force repeats the fit\n", arguments.out.string());
  return is_good || arguments.allow_unconverged || !arguments.job.empty() ? exit_done : exit_unconverged;
}

bool has_nothing_to_do(const FitArguments& arguments, const std::string& options) {
  if (arguments.mode() == JobMode::all) return false;
  return FitFolder::is_complete(arguments.out, options);
}

int run(const FitArguments& arguments) {
  if (arguments.data.extension() == ".csv")
    throw InvalidInput(arguments.data.string() +
                       ": a data set is a folder; to fit curves of a testing machine: python3 -m aspic.curves " +
                       arguments.data.string());
  if (arguments.threads > 0) set_thread_count(arguments.threads);
  FitPlan plan = plan_of(arguments);
  const fs::path options_file = options_of(arguments.data, arguments.options);
  read_fit_options(options_file, plan);
  if (arguments.out.extension() != ".vtu")
    throw InvalidInput(arguments.out.string() + ": a material file is a .vtu; choose such a name with -o");
  const DataSet data = read_data_set(arguments.data, registration_kind(arguments));
  check_findings(data, arguments);
  plan = completed(std::move(plan), data.experiment);
  std::string options = "# aspic fit\ndata = \"" + fingerprint_of(data.experiment) + "\"\n" + text_of(plan);
  if (!data.histories.empty()) options += "histories = \"" + fingerprint_of(data.histories) + "\"\n";
  options += origins_of(arguments, options_file);
  if (has_nothing_to_do(arguments, options)) return end_of_complete(arguments);
  FitFolder folder = FitFolder::open(arguments.out, options, existing(arguments));
  if (!arguments.job.empty() && FitJobs::is_done(folder.jobs(), arguments.job)) return exit_done;
  if (data.registration && arguments.job.empty())
    write_registration(folder.path() / "registration.toml", *data.registration);
  catch_interrupts();  // from here on there are results to keep

  if (!arguments.quiet) print_start(arguments, data, plan, folder);
  Fitter fitter(arguments, data, plan, folder);
  const FitOutcome outcome = fitter.run();
  if (!arguments.job.empty()) return end_of_job(arguments, fitter.jobs());
  if (!fitter.jobs().missing().empty()) return list_jobs(arguments, folder, fitter.jobs().missing());
  if (!outcome.has_material()) {
    fmt::print(stderr, "the fit failed: {}\n", outcome.failure);
    return interrupt_signal() ? exit_signal + interrupt_signal() : exit_unconverged;
  }
  write_material(arguments.out, outcome.material);
  folder.add_weights(outcome.report);
  const FitFigures figures = figures_of(data, outcome, truth_beside(arguments.data));
  const FitVerdict judged = verdict(data, outcome);
  const std::string json = figures_json(data, outcome, judged, figures);
  write_file(folder.path() / "figures.json", json);
  if (!arguments.quiet) print_fit(stdout, data, outcome), print_figures(stdout, data, figures);
  if (!arguments.quiet && outcome.law_choice) print_laws(stdout, *outcome.law_choice);
  if (!arguments.quiet && outcome.relaxation) print_relaxation(stdout, *outcome.relaxation);
  if (outcome.relaxation) write_relaxation(folder.path(), *outcome.relaxation);
  if (arguments.quiet)
    for (const std::string& warning : outcome.warnings) fmt::print(stderr, "warning: {}\n", warning);
  std::fflush(stdout);
  print_verdict(judged, arguments.quiet);
  print_use(arguments, outcome, folder.path());
  write_fit_report(folder.report(), {data, outcome, fitter.history(), json}, arguments.quiet ? nullptr : stdout);
  if (!outcome.interrupted) folder.finish();
  return exit_code(arguments, judged.is_good());
}

std::vector<std::string> model_names() {
  std::vector<std::string> names = {kAutoLaw};
  for (const MaterialInfo& info : materials()) names.push_back(info.name);
  return names;
}

constexpr std::string_view kFooter = R"(
Examples:
  aspic check pillow                           validates the data set
  aspic fit pillow                             writes material.vtu and material.fit/report.html
  aspic fit pillow -o soft.vtu --known poisson=0.45 --options careful.toml
  aspic fit pillow --model fung --unknown young=handles:40 --unknown b=uniform
  aspic fit pillow --register rigid            moves the markers onto the mesh; material.fit/registration.toml keeps the motion
  aspic fit pillow --resume                    continues an interrupted fit, bit-reproducibly
then in a scene: material = {{ file = "material.vtu" }}

Keys of aspic.fit.toml beside capture.toml, or of the file of --options, with their defaults:
{}
Exit codes: 0 the verdict is good, 2 bad input or data with errors, 3 the fit failed, did not converge, or its
material is not reliable (unless --allow-unconverged): the reasons are printed and written to figures.json;
130 interrupted by Ctrl-C, 143 by kill: the current material is written, --resume continues.)";

constexpr std::string_view kFooterOfJobs = R"(
Begins or continues the fit of aspic fit with the same options, writes its independent fits without a result to
material.fit/jobs.txt and slurm.sh, one command each, and ends with exit code 4. When they have run, the same command
continues. Other exit codes are those of aspic fit.

Examples:
  aspic fit-jobs pillow --model auto
  tr '\n' '\0' < material.fit/jobs.txt | xargs -0 -n 1 -P 8 sh -c)";

void add_common_options(CLI::App* command, const std::shared_ptr<FitArguments>& arguments) {
  command->add_option("DATA", arguments->data, "Folder of a data set, or its capture.toml")->required();
  command->add_option("-o,--out", arguments->out, "Material file to write; material.vtu by default");
  command
      ->add_option("--model", arguments->model,
                   "Strain energy density (see aspic materials), or auto: the simplest of those that the data support; "
                   "neo_hookean by default")
      ->check(CLI::IsMember(model_names()));
  command
      ->add_option("--unknown", arguments->parameters,
                   "QUANTITY=tets|regions|handles:N|uniform to fit; by default young=tets and all others uniform; "
                   "can be repeated")
      ->allow_extra_args(false);
  command->add_option("--known", arguments->known, "QUANTITY=NUMBER to keep, such as poisson=0.45; can be repeated")
      ->allow_extra_args(false);
  command->add_option("--register", arguments->registers, "Align markers or scan with the mesh: rigid or similarity")
      ->check(CLI::IsMember({"rigid", "similarity"}));
  command->add_option("--options", arguments->options,
                      "TOML file of further options, see aspic fit --help; by default aspic.fit.toml of the data set");
  command->add_option("--threads", arguments->threads, "Threads; all cores by default; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  command->add_flag("-q,--quiet", arguments->quiet, "Print only warnings and errors");
  command->add_flag("-v,--verbose", arguments->verbose, "Print a line per iteration")->excludes("--quiet");
  command->add_flag("--allow-unconverged", arguments->allow_unconverged,
                    "Exit with 0 even if the fit did not converge or its material is not reliable");
}

}  // namespace

void add_fit(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<FitArguments>();
  CLI::App* command = app.add_subcommand("fit", "Fits a material to measurements, with its uncertainty");
  command->footer(fmt::format(kFooter, fit_options_text()));
  add_common_options(command, arguments);
  command->add_flag("--force", arguments->force, "Replace an earlier fit");
  command->add_flag("--resume", arguments->resume, "Continue an interrupted fit")->excludes("--force");
  command->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

void add_fit_jobs(CLI::App& app, Action& action) {
  const auto arguments = std::make_shared<FitArguments>();
  CLI::App* command =
      app.add_subcommand("fit-jobs", "Lists the independent fits of a fit for xargs, GNU parallel or Slurm");
  command->footer(std::string(kFooterOfJobs));
  add_common_options(command, arguments);
  command->add_option("--job", arguments->job, "Compute only this job of jobs.txt");
  command->add_option("--program", arguments->program, "Program in the commands; aspic by default");
  command->callback([arguments, &action] {
    arguments->lists_jobs = arguments->job.empty();
    action = [arguments] { return run(*arguments); };
  });
}

}  // namespace aspic::cli
