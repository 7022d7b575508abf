# cmake -DOUTPUT=... -DSOURCE=... -DVERSION=... ... -P BuildFacts.cmake: writes the header for --version.
set(commit "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --exclude=* OUTPUT_VARIABLE commit
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#pragma once
namespace aspic::build_facts {
inline constexpr char kVersion[] = "@VERSION@";
inline constexpr char kCommit[] = "@commit@";
inline constexpr char kCompiler[] = "@COMPILER@";
inline constexpr char kBuildType[] = "@BUILD_TYPE@";
inline constexpr char kFlags[] = "@FLAGS@";
inline constexpr char kSanitizers[] = "@SANITIZE@";
}  // namespace aspic::build_facts
]] @ONLY)
