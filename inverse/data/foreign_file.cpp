#include "data/foreign_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "base/error.h"
#include "base/printable.h"

namespace aspic {

std::string conversion(const std::string& file, const std::string& output) {
  return "converted by: python3 -m aspic.recordings '" + printable(file) + "' '" + printable(output) + "'";
}

void require_table(const std::string& file, const std::string& output) {
  constexpr std::array<const char*, 5> kExtensions = {".trc", ".c3d", ".npz", ".ply", ".obj"};
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (file.find('*') != std::string::npos || std::count(kExtensions.begin(), kExtensions.end(), extension) > 0)
    throw InvalidInput(printable(file) + ": is a recording of another program; it is " + conversion(file, output));
}

}  // namespace aspic
