// ZIP archives [APPNOTE 6.3.10], deflated in memory: several files that the page offers as one download.
#pragma once
#include <string>
#include <vector>

namespace aspic {

struct ZipEntry {
  std::string name;   // with "/" between folders
  std::string bytes;  // less than 4 GiB
};

std::string zipped(const std::vector<ZipEntry>& entries);  // in total less than 4 GiB and 65536 entries

}  // namespace aspic
