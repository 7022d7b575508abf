// std::bit_cast, which libc++ 13 lacks.
#pragma once

namespace aspic {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

}  // namespace aspic
