// ASPIC_CHECK asserts an invariant; a violation is a bug in Aspic. Active in debug and sanitizer builds.
#pragma once

namespace aspic {

[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace aspic

#if defined(ASPIC_ENABLE_CHECKS)
#define ASPIC_CHECK(condition) ((condition) ? void() : ::aspic::check_failed(#condition, __FILE__, __LINE__))
#else
#define ASPIC_CHECK(condition) void(sizeof(!(condition)))
#endif
