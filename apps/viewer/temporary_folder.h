// Gone at the end of its life, with what is in it.
#pragma once
#include <filesystem>

namespace aspic::viewer {

class TemporaryFolder {
 public:
  TemporaryFolder();  // throws InvalidInput
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace aspic::viewer
