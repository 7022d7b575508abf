#include "aspic/fit_options.h"

#include <fmt/format.h>

#include "capture/fit_options.h"
#include "scene/toml_reader.h"

namespace aspic::cli {

bool read_fit_options(const std::filesystem::path& file, FitPlan& plan) {
  return aspic::read_fit_options(file.empty() ? Table() : read_toml(read_toml_text(file), file.string()), file.string(),
                                 plan);
}

std::string fit_options_text() {
  std::string text;
  for (const Key& key : fit_options_schema().keys)
    text += fmt::format("  {:<32}# {}\n", key.name + " = " + key.fallback, key.meaning);
  return text;
}

}  // namespace aspic::cli
