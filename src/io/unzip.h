// Reads ZIP archives [APPNOTE 6.3.10] in memory: stored and deflated files without encryption.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "io/zip.h"

namespace aspic {

// Returns the files of an archive. Throws InvalidInput if it is damaged or truncated, or if a file claims to unpack to
// more than deflated bytes can. `file`: name for messages.
std::vector<ZipEntry> unzipped(const std::string& file, std::string_view archive);

}  // namespace aspic
