# Compiler settings that every target of the project shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT EMSCRIPTEN)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin) # aspic finds aspic-mesh beside itself
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# A unit is a group of files of one folder that are compiled together: headers are read once per unit.
set(unit_size 16)
set(CMAKE_UNITY_BUILD ${ASPIC_UNITY})
set(CMAKE_UNITY_BUILD_BATCH_SIZE ${unit_size})

# group_by_folder(TARGET SOURCES...): compiles each folder's files in units of their own. Sources that are not listed
# are compiled one by one.
function(group_by_folder target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  set(folders)
  foreach(source ${ARGN})
    cmake_path(GET source PARENT_PATH path)
    cmake_path(GET path FILENAME folder)
    list(APPEND folders ${folder})
    list(APPEND in_${folder} ${source})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  foreach(folder ${folders})
    list(LENGTH in_${folder} count)
    math(EXPR units "(${count} + ${unit_size} - 1) / ${unit_size}")
    set(index 0)
    foreach(source ${in_${folder}})
      math(EXPR unit "${index} * ${units} / ${count} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}${unit})
      math(EXPR index "${index} + 1")
    endforeach()
  endforeach()
endfunction()

find_program(CCACHE ccache)
if(CCACHE)  # clones of the project share what they have compiled, with the debug information of the first
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
endif()

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
# Fused multiply-add is enabled; reassociation is not, so that results of a binary are bit-reproducible.
target_compile_options(aspic_build INTERFACE ${ASPIC_ARCH} -ffp-contract=${ASPIC_CONTRACT} -fno-math-errno -Wall -Wextra -Wshadow
                                             -Wno-missing-field-initializers)  # {.a = 1}: the rest has defaults
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # false alarms inside the headers of GCC 12
  target_compile_options(aspic_build INTERFACE -Wno-maybe-uninitialized -Wno-restrict)
endif()
if(ASPIC_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # takes the files of a unit for headers
  target_compile_options(aspic_build INTERFACE -Wno-subobject-linkage)
endif()

# Compiles the code around the numerics with less optimization, which saves a third of the time, and of the size in
# WebAssembly. Sanitizer builds with clang keep their flags.
function(compile_quickly target)
  if(EMSCRIPTEN)
    target_compile_options(${target} PRIVATE -Oz -finline-functions)  # emcc disables inlining at -Oz
  elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
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
