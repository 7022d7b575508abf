// What came from others is a regular file, or it is not read: a pipe may never end, and opening one may never return.
#pragma once
#include <filesystem>
#include <fstream>

#include "base/function_ref.h"

namespace aspic {

std::ifstream open_input(const std::filesystem::path& path);  // throws InvalidInput
// The same, but the stream has failed where the file is missing or not regular.
std::ifstream try_open_input(const std::filesystem::path& path);

// Before writing into a folder that may come from others. Throws InvalidInput where something that counts in it, or in
// a folder in it that counts, is a link: what is written there would go where it leads. So it does where such a folder
// cannot be listed.
void refuse_links(const std::filesystem::path& folder, FunctionRef<bool(const std::filesystem::path&)> counts);

}  // namespace aspic
