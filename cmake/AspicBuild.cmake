# Compiler settings that every target of the project shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin) # aspic finds aspic-mesh beside itself
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

find_program(CCACHE ccache)
if(CCACHE)  # clones of the project share what they have compiled
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} ${CCACHE})
endif()

if(ASPIC_PORTABLE)
  set(ASPIC_ARCH -march=x86-64-v3)
else()
  set(ASPIC_ARCH -march=native)
endif()

add_library(aspic_build INTERFACE)
# One binary gives one set of bits; fused multiply-add is used, reassociation is not.
target_compile_options(aspic_build INTERFACE ${ASPIC_ARCH} -ffp-contract=fast -fno-math-errno -Wall -Wextra -Wshadow
                                             -Wno-missing-field-initializers)  # {.a = 1}: the rest has defaults
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # false alarms inside the headers of GCC 12
  target_compile_options(aspic_build INTERFACE -Wno-maybe-uninitialized -Wno-restrict)
endif()
if(ASPIC_WERROR)
  target_compile_options(aspic_build INTERFACE -Werror)
endif()
if(ASPIC_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "ASPIC_FUZZ needs clang and its libFuzzer: -DCMAKE_CXX_COMPILER=clang++")
  endif()
  set(ASPIC_SANITIZE address,undefined,float-cast-overflow,fuzzer-no-link)
  target_compile_definitions(aspic_build INTERFACE _GLIBCXX_ASSERTIONS)
endif()
if(ASPIC_CHECKS OR CMAKE_BUILD_TYPE STREQUAL "Debug" OR ASPIC_SANITIZE)
  target_compile_definitions(aspic_build INTERFACE ASPIC_ENABLE_CHECKS)
endif()
if(ASPIC_SANITIZE)
  target_compile_options(aspic_build INTERFACE -fsanitize=${ASPIC_SANITIZE} -fno-omit-frame-pointer
                                               -fno-sanitize-recover=all)
  target_link_options(aspic_build INTERFACE -fsanitize=${ASPIC_SANITIZE})
endif()
if(ASPIC_COVERAGE)
  target_compile_options(aspic_build INTERFACE --coverage -fprofile-update=atomic)  # threads count too
  target_link_options(aspic_build INTERFACE --coverage)
endif()
