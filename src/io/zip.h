// ZIP archives [APPNOTE 6.3.10], deflated, written whole in memory: what a page hands to its reader as one file.
#pragma once
#include <string>
#include <vector>

namespace aspic {

struct ZipEntry {
  std::string name;   // with "/" between folders
  std::string bytes;  // below 4 GiB
};

std::string zipped(const std::vector<ZipEntry>& entries);  // below 4 GiB and 65536 entries together

}  // namespace aspic
