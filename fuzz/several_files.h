// A reader of several files fed from one text: a line "=== NAME" begins each; the break before it is part of no file.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/external_program.h"

namespace aspic::fuzz {

// Only names of `allowed` count; a text without such a line is the first of them.
std::vector<std::pair<std::string, std::string_view>> split_files(std::string_view bytes,
                                                                  const std::vector<std::string>& allowed);
std::string joined_files(const std::vector<std::pair<std::string, std::string>>& files);

// Without fsync: nothing here needs to outlive the process.
void put_file(const std::filesystem::path& path, std::string_view bytes);

// Puts each file of such a text into a folder, and removes them at the end.
class Files {
 public:
  Files(const std::filesystem::path& folder, std::string_view bytes, const std::vector<std::string>& allowed);
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files();

 private:
  std::vector<std::filesystem::path> paths_;
};

// A folder of this process, for a target that needs files.
const std::filesystem::path& folder_of_process();

// A checkpoint whose size and checksum are made right, so that what follows them is reached.
std::string with_right_checksum(std::string_view bytes);
std::string with_fingerprint(std::string_view checkpoint, std::string_view fingerprint);  // of the same length

}  // namespace aspic::fuzz
