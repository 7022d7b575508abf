#include "commands/fit_options.h"

#include <fmt/format.h>

#include "pipeline/fit_options.h"
#include "scene/toml_reader.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

Table document_of(const fs::path& file) {
  return file.empty() ? Table() : read_toml(read_toml_text(file), file.string());
}

}  // namespace

fs::path options_of(const fs::path& data, const fs::path& given) {
  if (!given.empty()) return given;
  const fs::path beside = (fs::is_directory(data) ? data : data.parent_path()) / kFitOptionsFile;
  std::error_code error;
  return fs::exists(beside, error) ? beside : fs::path();
}

void read_fit_options(const fs::path& file, FitPlan& plan) {
  aspic::read_fit_options(document_of(file), file.string(), plan);
}

std::vector<OptionOrigin> fit_option_origins(const fs::path& file) {
  const Table document = document_of(file);
  std::vector<OptionOrigin> origins;
  for (const Key& key : fit_options_schema().keys) {
    const Value* given = document.find(key.name);
    origins.push_back({key.name, given ? file.string() + ":" + std::to_string(given->place.line) : "default"});
  }
  return origins;
}

std::string fit_options_text() {
  std::string text;
  for (const Key& key : fit_options_schema().keys)
    text += fmt::format("  {:<32}# {}\n", key.name + " = " + key.fallback, key.meaning);
  return text;
}

}  // namespace aspic::cli
