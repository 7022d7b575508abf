#include "io/byte_cursor.h"

#include <algorithm>
#include <climits>
#include <cmath>

#include "base/error.h"

namespace aspic {

int ByteCursor::checked_count(int64_t value, std::string_view what, size_t bytes) const {
  const size_t most = std::min<size_t>(remaining() / std::max<size_t>(bytes, 1), INT_MAX);
  if (value < 0 || static_cast<uint64_t>(value) > most)
    fail(std::string(what) + " is " + std::to_string(value) + ", but the rest of the file has room for at most " +
         std::to_string(most) + "; it is cut short or damaged, get a complete copy");
  return static_cast<int>(value);
}

double ByteCursor::checked_finite(double value, std::string_view what) const {
  if (!std::isfinite(value)) fail(std::string(what) + " is infinite or not a number; it must be finite");
  return value;
}

void ByteCursor::skip(uint64_t bytes, std::string_view what) {
  require(bytes, what);
  position_ += bytes;
}

void ByteCursor::require(uint64_t bytes, std::string_view what) const {
  if (bytes > remaining())
    fail("the file ends where " + std::string(what) + " should follow; it is cut short, get a complete copy");
}

void ByteCursor::fail(std::string_view message) const {
  throw InvalidInput(file_ + ": byte " + std::to_string(position_) + ": " + std::string(message));
}

}  // namespace aspic
