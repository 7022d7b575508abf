// Reads ZIP archives [APPNOTE 6.3.10] in memory: stored and deflated files without encryption.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/function_ref.h"
#include "io/zip.h"

namespace aspic {

// Returns the wanted files of an archive; the others are not unpacked. Throws InvalidInput if it is damaged or
// truncated, if wanted files overlap or have the same name, or if one claims to unpack to more than deflated bytes can,
// or all to more than the free memory. `file`: name for messages.
std::vector<ZipEntry> unzipped(const std::string& file, std::string_view archive,
                               FunctionRef<bool(const std::string& name)> is_wanted);

}  // namespace aspic
