#include "aspic/summary.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <system_error>

#include "aspic/progress.h"
#include "base/hash.h"
#include "base/printable.h"
#include "dynamics/explanation_places.h"

namespace aspic::cli {
namespace {

struct Viewer {
  std::string folder, extension, advice;
};
const std::array<Viewer, 4> kViewers = {{
    {"", ".pvd", "ParaView: open {}"},
    {"", ".usda", "USD viewers: open {}"},
    {"skins", ".pc2",
     "Blender: a Mesh Cache modifier with {}, on the .obj beside it or on your mesh if it has its vertices"},
    {"", ".csv", "spreadsheet: {}"},
}};

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Returns the files of a folder with the extension, sorted by name.
std::set<std::filesystem::path> files(const std::filesystem::path& folder, const std::string& extension) {
  std::error_code error;  // error if the folder does not exist
  std::set<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == extension) found.insert(entry.path());
  }
  return found;
}

std::string step_duration_text(double seconds) {
  return seconds < 1 ? fmt::format("{:.3g} ms", 1000 * seconds) : duration_text(seconds);
}

void print_results(std::FILE* stream, const std::filesystem::path& directory) {
  fmt::print(stream, "results    {}\n", printable(directory.string()));
  for (const Viewer& viewer : kViewers) {
    for (const auto& file : files(directory / viewer.folder, viewer.extension)) {
      fmt::print(stream, "           {}\n", fmt::format(fmt::runtime(viewer.advice), printable(file.string())));
    }
  }
}

// Larger is worse: failures before budgets before successes, then the residual over its threshold.
std::pair<int, double> badness(const StepReport& report) {
  const int kind = is_success(report.status) ? 0 : report.status == Status::budget ? 1 : 2;
  return {kind, report.residual_threshold > 0 ? report.residual / report.residual_threshold : report.residual};
}

std::string status_text(const RunTotals& totals) {
  std::string text;
  for (int i = 0; i < kStatusCount; ++i)
    if (totals.by_status[i] > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", totals.by_status[i], to_string(static_cast<Status>(i)));
  return text;
}

// Smaller relative losses are round-off.
constexpr double kRoundOff = 1e-9;

double largest_energy(const StepReport& report) {
  double largest = std::max(report.kinetic, std::abs(report.pin_work));
  for (const double V : report.potential) largest = std::max(largest, std::abs(V));
  return largest;
}

void print_certificate(std::FILE* stream, const RunTotals& totals) {
  const StepReport& worst = *totals.worst;
  fmt::print(stream, "status     {}; worst: step {}, {}, residual {:.3g} N", status_text(totals), worst.step,
             to_string(worst.status), worst.residual);
  if (worst.residual_threshold > 0) fmt::print(stream, " (tolerance {:.3g} N)", worst.residual_threshold);
  fmt::print(stream, "\n");
  if (totals.bounds_held + totals.bounds_broken > 0)
    fmt::print(stream, "energy     the bound of backward Euler holds in {} of {} steps that have it\n",
               totals.bounds_held, totals.bounds_held + totals.bounds_broken);
  if (totals.grew > 0)
    fmt::print(stream, "           kinetic + potential grew by more than the work in {}, at most by {:.3g} J\n",
               totals.grew, totals.most_grown);
}

constexpr double kSignificantLoss = 0.05;  // relative to the energy of motion

double energy_of_motion(const RunTotals& totals) { return std::max(totals.most_kinetic, totals.most_changed); }

void print_loss(std::FILE* stream, const RunTotals& totals, const std::string& better_scheme) {
  const double share = totals.numerical_loss / energy_of_motion(totals);
  if (!(share > kSignificantLoss)) return;
  if (totals.most_kinetic == 0) {
    if (!(totals.driven_work > totals.numerical_loss)) return;  // a load began suddenly
    fmt::print(
        stream,
        "statics    numerical_loss, {:.3g} J, is no loss: pin_work and obstacle_work take the forces at the end of "
        "each step, so they exceed the stored energy in proportion to the step\n",
        totals.numerical_loss);
    return;
  }
  const std::string part = share < 1 ? fmt::format("{:.0f} % of the energy of motion", 100 * share)
                                     : fmt::format("in motions of at most {:.3g} J", energy_of_motion(totals));
  const std::string remedy = better_scheme.empty() ? "" : better_scheme + " and ";
  fmt::print(stream, "loss       numerical loss {:.3g} J, {}; {}shorter steps lose less\n", totals.numerical_loss, part,
             remedy);
}

void print_contact(std::FILE* stream, const RunTotals& totals, const RunEnd& end) {
  if (!end.start_warning.empty()) fmt::print(stream, "start      {}\n", end.start_warning);
  if (!end.untouched.empty())
    fmt::print(stream, "contact    {} touched nothing\n", printable(fmt::format("{}", fmt::join(end.untouched, ", "))));
  if (totals.gap_error == 0) return;
  fmt::print(stream, "contact    gaps of at most {:.3g} m remain between surfaces in contact", totals.gap_error);
  if (totals.contact_force_error > 0)
    fmt::print(stream, "; where pins and obstacles press, they make forces too large by up to {:.2g} % (estimate)",
               100 * totals.contact_force_error);
  fmt::print(stream, "\n");
}

void print_inverted(std::FILE* stream, const RunTotals& totals, const std::optional<InvertedTets>& end) {
  if (totals.with_inverted_tets == 0 && (!end || end->count == 0)) return;
  fmt::print(stream, "inverted   ");
  if (end && end->count > 0) {
    fmt::print(stream, "{} tets at the end, the smallest det F is {:.3g} in {}; ", end->count, end->least_det,
               end->worst);
  } else if (end) {
    fmt::print(stream, "no tet at the end; ");
  }
  fmt::print(stream, "some tet in {} of {} steps, first in step {}, with det F down to {:.3g} ({})\n",
             totals.with_inverted_tets, totals.steps, totals.first_inverted, totals.least_det_F,
             end && end->are_quadratic ? "quadratic tets are checked everywhere: a finer mesh helps"
                                       : "material.model = \"neo_hookean_log\" keeps every tet from inverting");
}

constexpr size_t kMaxReactions = 6;

void print_reactions(std::FILE* stream, const RunTotals& totals, const RunEnd& end) {
  const auto vector = [](const Vec3d& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v[0], v[1], v[2]); };
  size_t printed = 0, more = 0;
  for (size_t i = 0; i < std::min(totals.reactions.size(), end.pins.size()); ++i) {
    if (end.pins[i].empty()) continue;
    if (printed == kMaxReactions) {
      ++more;
      continue;
    }
    fmt::print(stream, "{}  {} exerts {} N, {} N m about the origin in the last step\n",
               printed++ == 0 ? "reactions" : "         ", end.pins[i], vector(totals.reactions[i].force),
               vector(totals.reactions[i].moment));
  }
  if (more > 0) fmt::print(stream, "           {} more pins: steps.csv\n", more);
}

}  // namespace

void RunTotals::add(const StepReport& report) {
  ++steps;
  ++by_status[static_cast<size_t>(report.status)];
  bounds_held += report.energy_bound == EnergyBound::holds;
  bounds_broken += report.energy_bound == EnergyBound::broken;
  if (report.energy_bound != EnergyBound::none && -report.numerical_loss > kRoundOff * largest_energy(report)) {
    ++grew;
    most_grown = std::max(most_grown, -report.numerical_loss);
  }
  if (steps == 1) first_potential = report.potential_total;
  if (report.kinetic > 0)  // else a static scheme
    most_kinetic = std::max(most_kinetic, report.kinetic + std::max(report.numerical_loss, 0.0));
  most_changed = std::max(most_changed, std::abs(report.potential_total - first_potential));
  numerical_loss += report.numerical_loss;
  driven_work += report.pin_work + report.obstacle_work;
  if (!worst || badness(report) > badness(*worst)) worst = report;
  if (report.status == Status::budget) {
    ++out_of_time;
  } else if (!is_success(report.status)) {
    ++unconverged;
  }
  iterations += report.iterations;
  values += report.values;
  gradients += report.gradients;
  hessians += report.hessians;
  factorizations += report.factorizations;
  products += report.products;
  cycles += report.cycles;
  most_iterations = std::max(most_iterations, report.iterations);
  substeps += report.substeps;
  rejected += report.rejected;
  if (!(report.min_det_F > 0) && with_inverted_tets++ == 0) first_inverted = report.step;
  gap_error = std::max(gap_error, report.gap_error);
  contact_force_error = std::max(contact_force_error, report.contact_force_error);
  least_det_F = std::min(least_det_F, report.min_det_F);
  seconds += report.seconds;
  time = report.time;
  reactions = report.resultants.pins;
  if (!report.mesh_error.empty()) mesh_error = report.mesh_error;
}

InvertedTets inverted_tets(const Simulation& simulation) {
  const std::vector<double> det_F = simulation.tet_fields().det_F;
  const Model& model = simulation.model();
  InvertedTets found{.are_quadratic = !model.mesh.mids.empty()};
  int worst = -1;
  for (int t = 0; t < model.mesh.tet_count(); ++t) {
    found.count += !(det_F[t] > 0);
    if (worst < 0 || det_F[t] < det_F[worst]) worst = t;
  }
  if (found.count == 0) return found;
  found.least_det = det_F[worst];
  found.worst =
      places::tet_name(model, worst) + " at " + places::point_text(simulation.state().q, model.mesh.tets[worst][0]);
  return found;
}

std::string precision_of(const MinimizeOptions& options) {
  if (!tests_direction(options.criterion)) return "";
  const char* unit = options.criterion == Criterion::velocity       ? " m/s"
                     : options.criterion == Criterion::acceleration ? " m/s^2"
                                                                    : " (relative decrement)";
  return fmt::format(" to {:g}{}", options.tolerance, unit);
}

void print_summary(std::FILE* stream, const RunTotals& totals, const RunEnd& end) {
  if (totals.steps == 0 && !end.interrupted && end.time_limit == 0) {
    fmt::print(stream, "nothing to do: step {} is already complete\n", end.steps_taken);
  } else {
    fmt::print(stream, "{}  {} of {} steps, to t = {:g} s\n",
               end.interrupted || end.blown_up || end.time_limit > 0 ? "stopped  " : "done     ", end.steps_taken,
               end.last_step, totals.time);
    if (end.time_limit > 0) fmt::print(stream, "limit      --time-limit of {:g} s\n", end.time_limit);
  }
  if (totals.steps > 0) {
    fmt::print(stream, "converged  {} of {}{}; iterations per step: mean {:.1f}, maximum {}\n",
               totals.steps - totals.unconverged - totals.out_of_time, totals.steps, end.precision,
               static_cast<double>(totals.iterations) / totals.steps, totals.most_iterations);
    if (totals.out_of_time > 0)
      fmt::print(stream, "budget     {} steps ended by solver.time_budget: these results depend on the clock\n",
                 totals.out_of_time);
    print_certificate(stream, totals);
    print_loss(stream, totals, end.better_scheme);
    print_contact(stream, totals, end);
    print_inverted(stream, totals, end.inverted);
    if (!totals.mesh_error.empty()) fmt::print(stream, "mesh       {}\n", printable(totals.mesh_error));
    print_reactions(stream, totals, end);
    const auto per_step = [&](long count) { return static_cast<double>(count) / totals.steps; };
    fmt::print(stream,
               "work       per step: {:.1f} values, {:.1f} gradients, {:.1f} Hessians, {:.1f} factorizations, {:.1f} "
               "matrix products",
               per_step(totals.values), per_step(totals.gradients), per_step(totals.hessians),
               per_step(totals.factorizations), per_step(totals.products));
    if (totals.cycles > 0) fmt::print(stream, ", {:.1f} multigrid cycles", per_step(totals.cycles));
    fmt::print(stream, "\n");
    if (!end.solver.empty()) fmt::print(stream, "solver     {}\n", end.solver);
    if (totals.substeps + totals.rejected != totals.steps)
      fmt::print(stream, "substeps   {} accepted, {} rejected; {:.1f} per step\n", totals.substeps, totals.rejected,
                 static_cast<double>(totals.substeps) / totals.steps);
    fmt::print(stream, "time       {} in steps, {} each; peak memory {:.0f} MB\n", duration_text(totals.seconds),
               step_duration_text(totals.seconds / totals.steps), peak_megabytes());
  }
  fmt::print(stream, "state      {} after step {}\n", hex_digits(end.state_hash), end.steps_taken);
  print_results(stream, end.directory);
  if (end.interrupted || end.time_limit > 0) {
    fmt::print(stream, "continue   {} run {} --resume\n", end.program, printable(end.directory.string()));
  }
}

}  // namespace aspic::cli
