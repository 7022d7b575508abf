#include "io/input_file.h"

#include "base/error.h"

namespace aspic {

std::ifstream try_open_input(const std::filesystem::path& path) {
  std::error_code error;
  std::ifstream in;
  if (std::filesystem::is_regular_file(path, error)) {
    in.open(path, std::ios::binary);
  } else {
    in.setstate(std::ios::failbit);
  }
  return in;
}

std::ifstream open_input(const std::filesystem::path& path) {
  std::ifstream in = try_open_input(path);
  if (!in)
    throw InvalidInput(path.string() +
                       ": cannot be read, or is not a regular file; check the name and the permissions");
  return in;
}

void refuse_links(const std::filesystem::path& folder, FunctionRef<bool(const std::filesystem::path&)> counts) {
  namespace fs = std::filesystem;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (!fs::is_symlink(entry->symlink_status()) || !counts(entry->path())) continue;
    throw InvalidInput(entry->path().string() +
                       ": is a link, and results would go where it leads; put a copy in its place, or let the whole "
                       "folder be a link");
  }
}

}  // namespace aspic
