// Gzip [RFC 1952] in memory, one member.
#pragma once
#include <string>
#include <string_view>

namespace aspic {

std::string gzipped(std::string_view bytes);

// Throws InvalidInput if the data are damaged or truncated, or exceed `limit` bytes when unpacked.
std::string gunzipped(std::string_view bytes, size_t limit);

}  // namespace aspic
