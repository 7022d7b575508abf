#include "aspic/browser.h"

#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "io/child_process.h"
#include "io/external_program.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

bool has_display() {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value && *value;
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

}  // namespace

bool open_browser(const std::string& address) {
  if (!has_display()) return false;
  try {
    const fs::path opener = find_program("xdg-open", {}, "");
    const ChildProcess process({.command = {opener.string(), address}, .lifetime = Lifetime::detached});
    return true;
  } catch (const InvalidInput&) {
    return false;
  }
}

}  // namespace aspic::cli
