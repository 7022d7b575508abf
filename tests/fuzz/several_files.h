// Several files in one text for a reader of folders: a line "=== NAME" begins each; the line break before it belongs to
// no file.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/external_program.h"

namespace aspic::fuzz {

// Ignores names that are not in `allowed`. A text without such a line is the first of them.
std::vector<std::pair<std::string, std::string_view>> split_files(std::string_view bytes,
                                                                  const std::vector<std::string>& allowed);
std::string joined_files(const std::vector<std::pair<std::string, std::string>>& files);

// Without fsync: the files need not outlive the process.
void put_file(const std::filesystem::path& path, std::string_view bytes);

// Writes the files of a text into a folder and removes them in the destructor.
class Files {
 public:
  Files(const std::filesystem::path& folder, std::string_view bytes, const std::vector<std::string>& allowed);
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files();

 private:
  std::vector<std::filesystem::path> paths_;
};

// Temporary folder of this process.
const std::filesystem::path& folder_of_process();

// Corrects size and checksum of a checkpoint, so that fuzzing reaches the rest.
std::string with_right_checksum(std::string_view bytes);
std::string with_fingerprint(std::string_view checkpoint, std::string_view fingerprint);  // must have equal lengths

}  // namespace aspic::fuzz
