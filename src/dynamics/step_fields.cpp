#include "dynamics/step_fields.h"

#include "base/hash.h"
#include "base/number_chars.h"

namespace aspic {
namespace {

constexpr unsigned kTable = 1, kFrame = 2, kJson = 4, kViewer = 8;
constexpr unsigned kCount = kTable | kJson, kWord = kTable | kJson | kViewer, kMeasured = kWord | kFrame;

struct Text {
  std::string_view name, unit, help;
};

template <auto Member>
StepField count(const Text& text, unsigned outputs) {
  return {text.name,
          text.unit,
          text.help,
          StepFieldType::count,
          outputs,
          [](const StepReport& r) { return StepValue(r.*Member); },
          [](StepReport& r, const StepValue& v) { return r.*Member = std::get<int>(v), true; },
          [](const StepReport& r) { return std::vector<double>{double(r.*Member)}; }};
}

template <auto Member>
StepField real(const Text& text, unsigned outputs) {
  return {text.name,
          text.unit,
          text.help,
          StepFieldType::real,
          outputs,
          [](const StepReport& r) { return StepValue(r.*Member); },
          [](StepReport& r, const StepValue& v) { return r.*Member = std::get<double>(v), true; },
          [](const StepReport& r) { return std::vector<double>{r.*Member}; }};
}

// A value of an enumeration whose last enumerator is Last.
template <auto Member, auto Last>
StepField name(const Text& text, unsigned outputs) {
  using Enum = decltype(Last);
  return {text.name,
          text.unit,
          text.help,
          StepFieldType::name,
          outputs,
          [](const StepReport& r) { return StepValue(std::string(to_string(r.*Member))); },
          [](StepReport& r, const StepValue& v) {
            for (int i = 0; i <= static_cast<int>(Last); ++i)
              if (to_string(static_cast<Enum>(i)) == std::get<std::string>(v))
                return r.*Member = static_cast<Enum>(i), true;
            return false;
          },
          [](const StepReport& r) { return std::vector<double>{static_cast<double>(r.*Member)}; }};
}

template <auto Member>
StepField word(const Text& text, unsigned outputs) {
  return {text.name,
          text.unit,
          text.help,
          StepFieldType::name,
          outputs,
          [](const StepReport& r) { return StepValue(r.*Member); },
          [](StepReport& r, const StepValue& v) { return r.*Member = std::get<std::string>(v), true; }};
}

// Number of evaluations times tets.
template <auto Member>
StepField per_element(const Text& text) {
  return {text.name, text.unit,
          text.help, StepFieldType::real,
          kTable,    [](const StepReport& r) {
            return StepValue(static_cast<double>(r.*Member) * r.elements); }};
}

StepField status() {
  StepField field =
      name<&StepReport::status, Status::inverted>({"status", "",
                                                   "`start` in row 0; success: `converged`, `round_off`; otherwise "
                                                   "`budget`, `iteration_limit`, `stuck`, `no_descent`, `undefined`, "
                                                   "`inaccurate`, `inverted`, `unstable`"},
                                                  kMeasured);
  field.get = [](const StepReport& r) {
    return StepValue(r.step == 0 ? std::string("start") : std::string(to_string(r.status)));
  };
  return field;
}

StepField converged() {
  return {"converged",
          "",
          "whether the status is a success",
          StepFieldType::flag,
          kJson | kViewer,
          [](const StepReport& r) { return StepValue(is_success(r.status)); }};
}

StepField state_hash() {
  return {"state_hash",
          "",
          "[hash](determinism.md#compare-two-runs) of the state",
          StepFieldType::hash,
          kMeasured,
          [](const StepReport& r) { return StepValue(hex_digits(r.state_hash)); },
          [](StepReport& r, const StepValue& v) {
            const std::string& digits = std::get<std::string>(v);
            from_chars(digits.data(), digits.data() + digits.size(), r.state_hash, 16);
            return true;
          },
          [](const StepReport& r) {
            const auto half = [&](int shift) { return double(static_cast<int32_t>(r.state_hash >> shift)); };
            return std::vector<double>{half(32), half(0)};
          },
          true};
}

StepField optional(StepField field) {
  field.is_optional = true;
  return field;
}

std::vector<StepField>& fields() {
  using R = StepReport;
  static std::vector<StepField> all = {
      count<&R::step>({"step", "", "0 is the start"}, kMeasured),
      real<&R::time>({"time", "s", "time at the end of the step"}, kTable | kJson | kViewer),
      status(),
      converged(),
      name<&R::criterion, Criterion::acceleration>({"criterion", "", "the convergence criterion"},
                                                   kTable | kFrame | kJson),
      count<&R::iterations>({"iterations", "", "iterations of the minimizer"}, kTable | kFrame | kJson),
      count<&R::trials>({"trials", "", "evaluations by the line search"}, kCount),
      count<&R::values>({"values", "", "evaluations of E over all tets"}, kCount),
      count<&R::gradients>({"gradients", "", "evaluations of the gradient"}, kCount),
      count<&R::hessians>({"hessians", "", "evaluations of the Hessian"}, kCount),
      count<&R::projected_hessians>({"projected_hessians", "", "modified Hessians among them"}, kCount),
      count<&R::elements>({"elements", "", "tets"}, kJson),
      per_element<&R::values>({"element_values", "", "`values` times tets"}),
      per_element<&R::gradients>({"element_gradients", "", "`gradients` times tets"}),
      per_element<&R::hessians>({"element_hessians", "", "`hessians` times tets"}),
      count<&R::factorizations>({"factorizations", "", "factorizations, or setups of a preconditioner"}, kCount),
      count<&R::linear_iterations>({"linear_iterations", "", "iterations of the linear solver"}, kCount),
      count<&R::products>({"products", "", "products with the Hessian"}, kCount),
      count<&R::cycles>({"cycles", "", "multigrid cycles"}, kCount),
      name<&R::initial_guess, InitialGuess::accelerated>(
          {"initial_guess", "",
           "of the last minimization: `zero`, `current`, `extrapolated`, `last_increment`, `accelerated`, `none`"},
          kCount),
      count<&R::substeps>({"substeps", "", "substeps of an adaptive step"}, kCount),
      count<&R::rejected>({"rejected", "", "rejected substeps"}, kCount),
      real<&R::residual>({"residual", "N", "norm of M a + dV/dx + dD/dx over free vertices"}, kMeasured),
      real<&R::residual_threshold>({"residual_threshold", "N", "its threshold"}, kMeasured),
      real<&R::residual_round_off>({"residual_round_off", "N", "its round-off floor"}, kJson),
      real<&R::lost_accuracy>({"lost_accuracy", "1", "share of the forces or velocities lost to round-off"}, kJson),
      count<&R::worst_vertex>({"worst_vertex", "", "vertex with the largest residual"}, kJson),
      real<&R::worst_residual>({"worst_residual", "N", "its residual"}, kJson),
      real<&R::min_det_F>({"min_det_F", "1", "smallest volume ratio of any tet; negative: inverted"}, kMeasured),
      real<&R::kinetic>({"kinetic", "J", "kinetic energy"}, kMeasured),
      optional(count<&R::contacts>({"contacts", "", "pairs of surface features in contact"}, kMeasured)),
      optional(real<&R::min_gap>({"min_gap", "m", "smallest distance between surfaces in contact; 0 without contacts"},
                                 kMeasured)),
      optional(word<&R::min_gap_pair>({"min_gap_pair", "", "bodies or obstacles with this gap"}, kWord)),
      optional(real<&R::max_pressure>({"max_pressure", "Pa", "largest contact pressure"}, kMeasured)),
      optional(real<&R::gap_error>(
          {"gap_error", "m", "bound of the gap that remains between surfaces in contact: their largest reach"},
          kMeasured)),
      optional(real<&R::contact_force_error>(
          {"contact_force_error", "1", "statics: estimate of the relative excess of contact forces"}, kMeasured)),
      optional(real<&R::friction_loss>({"friction_loss", "J", "share of friction in `damping_loss`"}, kMeasured)),
      optional(real<&R::friction_creep>({"friction_creep", "m", "largest slip of a sticking contact in this step"},
                                        kMeasured)),
      optional(real<&R::friction_residual>(
          {"friction_residual", "N", "change of friction by the last update of normal forces"}, kMeasured)),
      optional(count<&R::friction_passes>(
          {"friction_passes", "", "evaluations of lagged coefficients: friction, rims of pressures"}, kCount)),
      optional(count<&R::carries>(
          {"carries", "", "Newton directions along which bodies moved with obstacles before the iterations"}, kCount)),
      optional(real<&R::attachment_gap>(
          {"attachment_gap", "m", "largest difference of the distance of attached points from its rest length"},
          kMeasured)),
      optional(real<&R::mesh_stiffness>(
          {"mesh_stiffness", "1", "estimated excess of stiffness of the worst body; 0: not computed"}, kMeasured)),
      optional(real<&R::mesh_energy>({"mesh_energy", "J", "estimated energy above the minimum"}, kMeasured)),
      optional(count<&R::mesh_worst_tet>({"mesh_worst_tet", "", "tet with its largest density; -1: none"}, kMeasured)),
      optional(word<&R::mesh_error>({"mesh_error", "", "the estimate in words"}, kWord)),
      {"potential", "J",
       "energy of each term of V and of viscoelastic branches; a dead load has -f . x, not zero at rest",
       StepFieldType::potentials, kTable | kJson | kViewer},
      real<&R::potential_total>({"potential_total", "J", "sum of the potential energies"}, kTable | kFrame | kJson),
      real<&R::pin_work>({"pin_work", "J",
                          "work of moving pins, moving spring targets, time-dependent loads and muscles in this step"},
                         kMeasured),
      optional(real<&R::load_work>(
          {"load_work", "J", "share of moving spring targets and time-dependent loads in `pin_work`"}, kMeasured)),
      optional(real<&R::muscle_work>({"muscle_work", "J", "share of muscles in `pin_work`"}, kMeasured)),
      optional(real<&R::obstacle_work>({"obstacle_work", "J", "work of moving obstacles"}, kMeasured)),
      optional(real<&R::nonconservative_work>(
          {"nonconservative_work", "J",
           "work of wind, and of pressures on open patches beyond the change of their potential"},
          kMeasured)),
      real<&R::damping_loss>({"damping_loss", "J", "energy dissipated by damping and friction"}, kMeasured),
      optional(real<&R::viscoelastic_loss>(
          {"viscoelastic_loss", "J", "share of viscoelastic branches in `damping_loss`"}, kMeasured)),
      real<&R::numerical_loss>({"numerical_loss", "J",
                                "energy dissipated by the integrator; in statics no loss: forces at the end of the "
                                "step times its path minus the change of energy"},
                               kMeasured),
      real<&R::residual_work>({"residual_work", "J", "work of the residual"}, kMeasured),
      real<&R::ledger_error>({"ledger_error", "J", "remaining imbalance"}, kMeasured),
      {"reaction", "N, N m", "resultants of pins, loads and bodies", StepFieldType::resultants, kTable},
      optional(real<&R::decrement>({"decrement", "J", "Newton decrement -g.d / 2 of the last iteration"}, kMeasured)),
      optional(name<&R::energy_bound, EnergyBound::broken>(
          {"energy_bound", "",
           "`holds`, `broken`, `not_guaranteed`, `none`: the [bound](determinism.md#the-certificate-of-a-step) of "
           "backward Euler"},
          kMeasured)),
      optional(real<&R::energy_slack>({"energy_slack", "J", "bound minus energy"}, kMeasured)),
      state_hash(),
      real<&R::seconds>({"seconds", "s", "wall time"}, kJson | kViewer),
  };
  return all;
}

// Tables and frames format enumerators in Markdown; comments in TypeScript are plain text.
std::string plain(std::string_view markdown) {
  std::string text;
  for (size_t i = 0; i < markdown.size(); ++i) {
    if (markdown[i] == ']' && i + 1 < markdown.size() && markdown[i + 1] == '(') {
      i = markdown.find(')', i);
    } else if (markdown[i] != '`' && markdown[i] != '[') {
      text += markdown[i];
    }
  }
  return text;
}

std::string_view typescript_type(StepFieldType type) {
  switch (type) {
    case StepFieldType::flag:
      return "boolean";
    case StepFieldType::count:
      return "number";
    case StepFieldType::real:
      return "MaybeNumber";
    case StepFieldType::potentials:
      return "MaybeNumber[]";
    case StepFieldType::hash:
      return "string | null";
    default:
      return "string";
  }
}

// Value of a field before its step has ended.
std::string_view typescript_unknown_step(StepFieldType type) {
  switch (type) {
    case StepFieldType::flag:
      return "false";
    case StepFieldType::count:
      return "0";
    case StepFieldType::potentials:
      return "[]";
    case StepFieldType::name:
      return "\"\"";
    default:
      return "null";
  }
}

// The resultants of pins, loads and bodies have six columns per name.
constexpr std::string_view kResultantItems =
    R"(* `reaction_PIN_x`, `_y`, `_z` [N]: mean force of the pin `BODY.PIN` on its vertices
* `reaction_moment_PIN_x`, ... [N m]: its moment about the origin at the end of the step
* `load_NAME_x`, ..., `load_moment_NAME_x`, ... [N, N m]: the same of each load at the end of the step; `contact`: of all obstacles, without friction
* `body_NAME_x`, ..., `body_moment_NAME_x`, ... [N, N m]: mean of all pins and loads on the body
* `volume_NAME` [m^3], `pressure_NAME` [Pa]: those of each cavity, the pressure above that outside
)";

}  // namespace

std::span<const StepField> step_fields() { return fields(); }

AdditionalStepField::AdditionalStepField(const StepField& field) { fields().push_back(field); }
AdditionalStepField::~AdditionalStepField() { fields().pop_back(); }

std::string step_fields_typescript() {
  std::string text =
      "// Generated from the description of step reports (src/dynamics/step_fields.cpp). Do not edit.\n"
      "import type { MaybeNumber } from \"./numbers\";\n\n"
      "export interface StepFields {\n";
  for (const StepField& field : step_fields()) {
    if (!field.is_in(StepOutput::viewer)) continue;
    const std::string unit = field.unit.empty() ? "" : " [" + std::string(field.unit) + "]";
    text += "  " + std::string(field.name) + ": " + std::string(typescript_type(field.type)) + "; // " +
            plain(field.help) + unit + "\n";
  }
  text += "}\n\n// Values for a step that has not ended.\nexport const kUnknownStep: StepFields = {\n";
  for (const StepField& field : step_fields())
    if (field.is_in(StepOutput::viewer))
      text += "  " + std::string(field.name) + ": " + std::string(typescript_unknown_step(field.type)) + ",\n";
  return text + "};\n";
}

std::string step_fields_markdown() {
  std::string text;
  for (const StepField& field : step_fields()) {
    if (!field.is_in(StepOutput::table)) continue;
    if (field.type == StepFieldType::resultants) {
      text += kResultantItems;
      continue;
    }
    const std::string column = std::string(field.name) + (field.type == StepFieldType::potentials ? "_NAME" : "");
    const std::string unit = field.unit.empty() ? "" : " [" + std::string(field.unit) + "]";
    text += "* `" + column + "`" + unit + ": " + std::string(field.help) + "\n";
  }
  return text;
}

}  // namespace aspic
