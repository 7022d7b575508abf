#include "results/run_directory_tables.h"

#include <utility>

#include "base/error.h"
#include "dynamics/step_fields.h"
#include "energy/cavity.h"
#include "results/run_directory_layout.h"

namespace aspic {
namespace {

void add_vector_columns(const std::string& name, std::vector<std::string>& columns) {
  for (const char* axis : {"_x", "_y", "_z"}) columns.push_back(name + axis);
}

// In the order of add(StepReport).
void add_resultant_columns(const Model& model, std::vector<std::string>& columns) {
  const auto add = [&](const std::string& kind, const std::string& name) {
    add_vector_columns(kind + "_" + name, columns);
    add_vector_columns(kind + "_moment_" + name, columns);
  };
  for (const Pin& pin : model.pins) add("reaction", pin.name);
  for (const auto& load : model.loads) add("load", std::string(load->name()));
  for (const BodyRange& body : model.bodies) add("body", body.name);
  for (const auto& load : model.loads)
    if (dynamic_cast<const Cavity*>(load.get()))
      for (const char* kind : {"volume_", "pressure_"}) columns.push_back(kind + std::string(load->name()));
}

void add(const StepReport& report, CsvRow& row) {
  const Resultants& resultants = report.resultants;
  for (const auto* all : {&resultants.pins, &resultants.loads, &resultants.bodies})
    for (const Resultant& sum : *all)
      for (const Vec3d* v : {&sum.force, &sum.moment})
        for (int r = 0; r < 3; ++r) row.add((*v)[r]);
  for (const CavityState& cavity : report.cavities) row.add(cavity.volume).add(cavity.pressure);
}

std::vector<std::string> step_columns(const Simulation& simulation) {
  std::vector<std::string> columns;
  for (const StepField& field : step_fields()) {
    if (!field.is_in(StepOutput::table)) continue;
    if (field.type == StepFieldType::potentials) {
      for (const std::string& name : simulation.potential_names()) columns.push_back("potential_" + name);
    } else if (field.type == StepFieldType::resultants) {
      add_resultant_columns(simulation.model(), columns);
    } else {
      columns.emplace_back(field.name);
    }
  }
  return columns;
}

CsvRow step_row(const StepReport& report) {
  CsvRow row;
  for (const StepField& field : step_fields()) {
    if (!field.is_in(StepOutput::table)) continue;
    if (field.type == StepFieldType::potentials) {
      for (const double energy : report.potential) row.add(energy);
    } else if (field.type == StepFieldType::resultants) {
      add(report, row);
    } else {
      std::visit([&](const auto& value) { row.add(value); }, field.get(report));
    }
  }
  return row;
}

const std::vector<std::string> kIterationColumns = {"step",
                                                    "iteration",
                                                    "value",
                                                    "gradient_norm",
                                                    "decrement",
                                                    "alpha",
                                                    "trials",
                                                    "gradients",
                                                    "hessians",
                                                    "projected",
                                                    "projected_elements",
                                                    "factorizations",
                                                    "linear_iterations",
                                                    "products",
                                                    "cycles"};
// In checkpoints: the size of iterations.csv, and the checksums of the tables.
constexpr char kIterationBytes[] = "iteration_bytes", kIterationChecksum[] = "iteration_checksum",
               kStepChecksum[] = "step_checksum";
const std::vector<std::string> kTimingColumns = {"step",           "seconds",       "cpu_seconds",    "hessian",
                                                 "factorize",      "solve_linear",  "line_search",    "gradient",
                                                 "contact_search", "contact_bound", "contact_forces", "distances"};

}  // namespace

RunTables RunTables::create(const RunLayout& layout, const Simulation& simulation) {
  RunTables tables;
  tables.steps_ = CsvFile::create(layout.steps(), step_columns(simulation));
  tables.iterations_ = CsvFile::create(layout.iterations(), kIterationColumns);
  tables.timings_ = CsvFile::create(layout.timings(), kTimingColumns);
  return tables;
}

RunTables RunTables::resume(const RunLayout& layout, const Simulation& simulation) {
  const int last_step = simulation.steps_taken();
  RunTables tables;
  tables.steps_ = CsvFile::resume(layout.steps(), step_columns(simulation), last_step, CsvFile::Rows::every_step);
  tables.iterations_ = CsvFile::resume(layout.iterations(), kIterationColumns, last_step, CsvFile::Rows::optional);
  tables.timings_ = CsvFile::resume(layout.timings(), kTimingColumns, last_step, CsvFile::Rows::every_step);
  return tables;
}

void RunTables::add_start(const StepReport& report) { steps_.append(step_row(report)); }

void RunTables::add(const StepReport& report) {
  steps_.append(step_row(report));
  CsvRow times;
  times.add(report.step).add(report.seconds).add(report.cpu_seconds);
  for (double& stage : stages_) times.add(std::exchange(stage, 0.0));
  const ContactCost& contact = report.contact_cost;
  times.add(contact.search).add(contact.bound).add(contact.forces);
  timings_.append(times.add(static_cast<double>(contact.distances)));
}

void RunTables::add(int step, const Iteration& iteration) {
  const DirectionReport& direction = iteration.direction;
  const double seconds[] = {direction.hessian_seconds, direction.factorize_seconds, direction.solve_seconds,
                            iteration.line_search_seconds, iteration.gradient_seconds};
  for (size_t k = 0; k < stages_.size(); ++k) stages_[k] += seconds[k];
  CsvRow row;
  row.add(step).add(iteration.index).add(iteration.value).add(iteration.gradient_norm).add(iteration.decrement);
  row.add(iteration.alpha).add(iteration.trials).add(iteration.gradients).add(direction.hessians);
  row.add(direction.projected ? 1 : 0).add(direction.projected_elements).add(direction.factorizations);
  row.add(direction.linear_iterations);
  row.add(direction.products).add(direction.cycles);
  iterations_.append(row);
}

void RunTables::add_sizes(Checkpoint& checkpoint) const {
  checkpoint.integers.emplace_back(kIterationBytes, static_cast<int64_t>(iterations_.size()));
  checkpoint.integers.emplace_back(kIterationChecksum, iterations_.checksum());
  checkpoint.integers.emplace_back(kStepChecksum, steps_.checksum());
}

void RunTables::require_unchanged(const Checkpoint& checkpoint) const {
  for (const auto& [name, value] : checkpoint.integers) {
    if (name == kIterationBytes && static_cast<int64_t>(iterations_.size()) != value)
      throw InvalidInput(iterations_.path().string() + ": has " + std::to_string(iterations_.size()) +
                         " bytes up to the checkpoint, and " + std::to_string(value) +
                         " were written; restore the whole file, or restart the run with --force");
    if (name == kIterationChecksum)
      aspic::require_unchanged(iterations_.path(), static_cast<double>(value), iterations_.checksum());
    if (name == kStepChecksum) aspic::require_unchanged(steps_.path(), static_cast<double>(value), steps_.checksum());
  }
}

void RunTables::sync() {
  steps_.sync();
  iterations_.sync();
  timings_.sync();
}

void RunTables::close() {
  steps_.close();
  iterations_.close();
  timings_.close();
}

}  // namespace aspic
