#include "viewer/temporary_folder.h"

#include <stdlib.h>

#include <string>
#include <system_error>

#include "base/error.h"

namespace aspic::viewer {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "aspic-XXXXXX").string();
  if (!mkdtemp(name.data())) throw InvalidInput(name + ": a temporary folder cannot be made; is the disk full?");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace aspic::viewer
