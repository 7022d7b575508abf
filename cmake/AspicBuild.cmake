# Flags of the compiler, as target aspic_build.
include(AspicSources)

set(ASPIC_CONTRACT fast)
if(EMSCRIPTEN)  # WebAssembly has no fused multiply-add
  # The vectorizer of straight-line code in emscripten 3.1.6 miscompiles "x = A * x + b": never enable it.
  # Link-time optimization also vectorizes. It removes the virtual functions that the engine never calls.
  set(whole_program -flto -fwhole-program-vtables -fvirtual-function-elimination -fvisibility=hidden)
  add_compile_options(-msimd128 -fno-slp-vectorize -fwasm-exceptions ${whole_program})
  add_link_options(-fwasm-exceptions ${whole_program} -Wl,-mllvm,-vectorize-slp=false)
  if(ASPIC_WASM_THREADS)
    add_compile_options(-pthread)
    add_link_options(-pthread)
  endif()
  set(ASPIC_ARCH -msimd128)
  set(ASPIC_CONTRACT off)
elseif(ASPIC_BITS STREQUAL "portable")
  set(ASPIC_ARCH -march=x86-64)
  set(ASPIC_CONTRACT off)
  add_compile_definitions(EIGEN_DONT_VECTORIZE)  # its order of sums depends on the SIMD instructions
elseif(ASPIC_PORTABLE)
  set(ASPIC_ARCH -march=x86-64-v3)
else()
  set(ASPIC_ARCH -march=native)
endif()

add_library(aspic_build INTERFACE)
add_library(aspic::build ALIAS aspic_build)
set_target_properties(aspic_build PROPERTIES EXPORT_NAME build)
# Fused multiply-add is enabled; reassociation is not, so that results of a binary are bit-reproducible.
target_compile_options(aspic_build INTERFACE ${ASPIC_ARCH} -ffp-contract=${ASPIC_CONTRACT} -fno-math-errno -Wall -Wextra -Wshadow
                                             -Wno-missing-field-initializers)  # {.a = 1}: the rest has defaults
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # false alarms inside the headers of GCC 12
  target_compile_options(aspic_build INTERFACE -Wno-maybe-uninitialized -Wno-restrict)
endif()
if(ASPIC_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # takes the files of a unit for headers
  target_compile_options(aspic_build INTERFACE -Wno-subobject-linkage)
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
