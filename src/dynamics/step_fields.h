// Values and names of a StepReport, described once. The description defines the columns of steps.csv, the field data of
// frames, the lines of `aspic run --json`, the messages of the viewer with their TypeScript interface, and the reader
// of run directories.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "dynamics/step_report.h"

namespace aspic {

enum class StepOutput : unsigned {
  table = 1,   // steps.csv
  frame = 2,   // field data of VTU files
  json = 4,    // aspic run --json
  viewer = 8,  // messages of the viewer and recordings; these fields are read from steps.csv
};

// potentials and resultants are groups of values: potential energies by name, and resultant forces
enum class StepFieldType { flag, count, real, name, hash, potentials, resultants };

using StepValue = std::variant<bool, int, double, std::string>;

struct StepField {
  std::string_view name, unit, help;
  StepFieldType type;
  unsigned outputs;  // sum of StepOutput
  StepValue (*get)(const StepReport& report) = nullptr;
  // Returns false for an unknown name. Null: derived from other fields, not read.
  bool (*set)(StepReport& report, const StepValue& value) = nullptr;
  // Values in field data: the index of a name, the halves of a hash.
  std::vector<double> (*numbers)(const StepReport& report) = nullptr;
  bool is_optional = false;  // may be missing in tables of earlier versions

  bool is_in(StepOutput output) const { return (outputs & static_cast<unsigned>(output)) != 0; }
};

// Returns all fields, in the order of the columns of steps.csv.
std::span<const StepField> step_fields();

// Adds a field to the description during the lifetime of the object. Not thread-safe.
class AdditionalStepField {
 public:
  explicit AdditionalStepField(const StepField& field);
  ~AdditionalStepField();
  AdditionalStepField(const AdditionalStepField&) = delete;
  AdditionalStepField& operator=(const AdditionalStepField&) = delete;
};

// Returns the generated TypeScript interface of the viewer's fields, web/src/stepFields.ts.
std::string step_fields_typescript();

// Returns the generated list of columns in docs/formats.md.
std::string step_fields_markdown();

}  // namespace aspic
