#include <fmt/format.h>

#include <CLI/Version.hpp>
#include <nlohmann/json.hpp>

#include "aspic/commands.h"
#include "build_facts.h"
#include "math/pack.h"

namespace aspic::cli {

std::string version_text() {
  using namespace build_facts;
  std::string text = fmt::format("aspic {}\n", kVersion);
  if (*kCommit) text += fmt::format("commit      {}\n", kCommit);
  text += fmt::format("compiler    {} ({})\n", kCompiler, kBuildType);
  text += fmt::format("flags       {}\n", kFlags);
  text += fmt::format("SIMD        {} doubles\n", kPackWidth);
  if (*kSanitizers) text += fmt::format("sanitizers  {}\n", kSanitizers);
#if defined(ASPIC_ENABLE_CHECKS)
  text += "assertions  on\n";
#else
  text += "assertions  off\n";
#endif
  text += fmt::format(
      "libraries   CLI11 {}, fmt {}.{}.{}, nlohmann_json {}.{}.{}; METIS, Eigen, Spectra, muParser, toml++, zlib, "
      "Expat",
      CLI11_VERSION, FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100, NLOHMANN_JSON_VERSION_MAJOR,
      NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
  return text;
}

}  // namespace aspic::cli
