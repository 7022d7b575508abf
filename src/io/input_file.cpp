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
  if (!fs::exists(folder, error)) return;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    if (!counts(path)) continue;
    const fs::file_status status = fs::symlink_status(path, error);
    if (fs::is_symlink(status))
      throw InvalidInput(path.string() +
                         ": is a link, and results would go where it leads; put a copy in its place, or let the whole "
                         "folder be a link");
    if (fs::is_directory(status)) refuse_links(path, counts);
  }
  if (error)  // an unlistable folder may contain links, too
    throw InvalidInput(folder.string() + ": cannot be listed: " + error.message() + "; check the permissions");
}

}  // namespace aspic
