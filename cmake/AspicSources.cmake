# Settings and functions for the sources of the core and of the packages that build on it (distributed, inverse).
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT EMSCRIPTEN)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin) # programs find each other there
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
if(CCACHE)
  cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH repository)
  # Clones of the project share what they have compiled, with the debug information of the first.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${repository} CCACHE_NOHASHDIR=1 ${CCACHE})
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
