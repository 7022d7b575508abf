// Gzip [RFC 1952]: one member, whole in memory.
#pragma once
#include <string>
#include <string_view>

namespace aspic {

std::string gzipped(std::string_view bytes);

// Throws InvalidInput for what is damaged, cut short, or larger than `limit` bytes when unpacked.
std::string gunzipped(std::string_view bytes, size_t limit);

}  // namespace aspic
