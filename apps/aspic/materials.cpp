// `aspic materials`: prints the material registry as text or JSON.
#include "material/registry.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "aspic/commands.h"

namespace aspic::cli {
namespace {

void print(const MaterialInfo& material) {
  fmt::print("{}\n  psi = {}\n", material.name, material.formula);
  for (const ExtraParameter& extra : material.extra) {
    fmt::print("  {} [{}]: {}; {} to {}, default {}\n", extra.name, extra.unit, extra.meaning, extra.min, extra.max,
               extra.fallback);
  }
  if (material.barrier) fmt::print("  infinite for det F <= 0, so elements never invert\n");
  fmt::print("  {}\n\n", material.remarks);
}

nlohmann::ordered_json to_json(const MaterialInfo& material) {
  nlohmann::ordered_json parameters = nlohmann::json::array();
  for (const ExtraParameter& extra : material.extra) {
    parameters.push_back({{"name", extra.name},
                          {"unit", extra.unit},
                          {"meaning", extra.meaning},
                          {"default", extra.fallback},
                          {"min", extra.min},
                          {"max", extra.max}});
  }
  return {{"name", material.name},       {"formula", material.formula}, {"tex", material.tex},
          {"barrier", material.barrier}, {"parameters", parameters},    {"remarks", material.remarks}};
}

int list_materials(const std::string& name, bool json) {
  std::vector<MaterialInfo> listed = materials();
  if (!name.empty()) listed = {material_info(name)};
  if (json) {
    nlohmann::ordered_json array = nlohmann::json::array();
    for (const MaterialInfo& material : listed) array.push_back(to_json(material));
    fmt::print("{}\n", array.dump(2));
    return exit_done;
  }
  fmt::print(
      "Every material has small-strain constants, young [Pa] and poisson (or lame or shear and bulk moduli),\n"
      "and density [kg/m^3]. I1 = tr(F'F), J = det F, mu and lambda are the Lame constants.\n"
      "Typical young: jelly 5e3, soft tissue 3e4, foam 5e4 (poisson 0.2), silicone 2e5, rubber 2e6.\n\n");
  for (const MaterialInfo& material : listed) print(material);
  return exit_done;
}

}  // namespace

void add_materials(CLI::App& app, Action& action) {
  struct Arguments {
    std::string name;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("materials", "Lists the materials with formulas and parameters");
  command->footer("\nExamples:\n  aspic materials\n  aspic materials neo_hookean\n  aspic materials --json");
  command->add_option("NAME", arguments->name, "Material to list; all by default");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback(
      [arguments, &action] { action = [arguments] { return list_materials(arguments->name, arguments->json); }; });
}

}  // namespace aspic::cli
