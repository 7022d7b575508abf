#include "aspic/shipped_files.h"

#include "io/external_program.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

fs::path found_near(fs::path folder, const fs::path& name) {
  std::error_code error;
  for (;;) {
    for (const fs::path& place : {folder / name, folder / "share" / "aspic" / name})
      if (fs::exists(place, error)) return place;
    if (!folder.has_relative_path()) return {};
    folder = folder.parent_path();
  }
}

}  // namespace

fs::path shipped_file(const fs::path& name) {
  std::error_code error;
  const fs::path near = found_near(fs::current_path(error), name);
  return near.empty() ? found_near(program_folder(), name) : near;
}

}  // namespace aspic::cli
