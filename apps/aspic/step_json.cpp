#include "aspic/step_json.h"

#include <nlohmann/json.hpp>

#include "dynamics/step_fields.h"

namespace aspic::cli {
namespace {

template <class Name>
void add_resultants(const char* kind, const std::vector<Resultant>& sums, const Name& name_of,
                    nlohmann::ordered_json& line) {
  nlohmann::ordered_json all = nlohmann::json::object();
  for (size_t i = 0; i < sums.size(); ++i) {
    const auto& [f, m] = sums[i];
    all[name_of(i)] = {{"force", {f[0], f[1], f[2]}}, {"moment", {m[0], m[1], m[2]}}};
  }
  line[kind] = std::move(all);
}

}  // namespace

std::string step_json(const StepReport& report, const Explanation& why, const Simulation& simulation) {
  nlohmann::ordered_json line;
  for (const StepField& field : step_fields()) {
    if (!field.is_in(StepOutput::json)) continue;
    nlohmann::ordered_json& entry = line[std::string(field.name)];
    if (field.type == StepFieldType::potentials) {
      entry = nlohmann::json::object();
      const std::vector<std::string> names = simulation.potential_names();
      for (size_t i = 0; i < report.potential.size(); ++i) entry[names.at(i)] = report.potential[i];
    } else {
      std::visit([&](const auto& value) { entry = value; }, field.get(report));
    }
  }
  if (report.worst_vertex >= 0) line["worst_vertex"] = simulation.model().numbering.vertex.to_user(report.worst_vertex);
  const Model& model = simulation.model();
  const Resultants& sums = report.resultants;
  add_resultants(
      "reactions", sums.pins, [&](size_t i) { return model.pins[i].name; }, line);
  add_resultants(
      "loads", sums.loads, [&](size_t i) { return std::string(model.loads[i]->name()); }, line);
  add_resultants(
      "bodies", sums.bodies, [&](size_t i) { return model.bodies[i].name; }, line);
  if (!is_success(report.status))
    line["explanation"] = {{"cause", why.cause}, {"place", why.place}, {"remedy", why.remedy}};
  return line.dump();
}

}  // namespace aspic::cli
