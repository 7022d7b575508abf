// Content hashes, which detect accidental changes, not forgery.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace aspic {

// FNV-1a of bytes, 64 bits [Fowler, Noll, Vo].
class Fnv1a {
 public:
  void add(const void* bytes, size_t count) {
    const auto* byte = static_cast<const unsigned char*>(bytes);
    for (size_t i = 0; i < count; ++i) hash_ = (hash_ ^ byte[i]) * kPrime;
  }
  std::uint64_t value() const { return hash_; }

  static constexpr std::uint64_t kBasis = 0xcbf29ce484222325, kPrime = 0x100000001b3;

 private:
  std::uint64_t hash_ = kBasis;
};

std::string hex_digits(std::uint64_t number);  // 16 hexadecimal digits

}  // namespace aspic
