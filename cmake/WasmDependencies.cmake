# Third-party libraries of the WebAssembly build. Header-only ones are those of the system, through links so that the other
# system headers stay out; zlib, Expat and muParser are compiled from the sources that ./run site fetches.
set(THREADS_PREFER_PTHREAD_FLAG OFF)
find_package(Threads REQUIRED)

set(wasm_headers ${CMAKE_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${wasm_headers})
foreach(folder eigen3/Eigen Spectra fmt nlohmann toml++)
  cmake_path(GET folder FILENAME name)
  find_path(place_${name} ${folder} PATHS /usr/include /usr/local/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH REQUIRED)
  file(CREATE_LINK ${place_${name}}/${folder} ${wasm_headers}/${name} SYMBOLIC)
endforeach()
foreach(target Eigen3::Eigen Spectra::Spectra fmt::fmt nlohmann_json::nlohmann_json)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${wasm_headers})
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY=1)

set(ASPIC_SOURCES ${PROJECT_SOURCE_DIR}/build/sources CACHE PATH "Sources of zlib, Expat and muParser")
foreach(name zlib expat muparser)
  file(GLOB folder ${ASPIC_SOURCES}/${name}/*)
  if(NOT folder)
    message(FATAL_ERROR "the sources of ${name} are missing in ${ASPIC_SOURCES}; ./run site fetches them")
  endif()
  set(${name}_folder ${folder})
endforeach()
enable_language(C)
set(CMAKE_UNITY_BUILD OFF)

file(GLOB sources ${zlib_folder}/*.c)
list(FILTER sources EXCLUDE REGEX "/gz[a-z]+\\.c$")
add_library(aspic_ZLIB STATIC ${sources})
target_include_directories(aspic_ZLIB SYSTEM PUBLIC ${zlib_folder})
add_library(ZLIB::ZLIB ALIAS aspic_ZLIB)

set(expat ${expat_folder}/expat/lib)
add_library(aspic_EXPAT STATIC ${expat}/xmlparse.c ${expat}/xmlrole.c ${expat}/xmltok.c)
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/expat/expat_config.h CONTENT [[
#define BYTEORDER 1234
#define XML_DEV_URANDOM 1
#define HAVE_MEMMOVE 1
#define XML_CONTEXT_BYTES 1024
#define XML_DTD 1
#define XML_NS 1
]])
target_include_directories(aspic_EXPAT SYSTEM PUBLIC ${expat} PRIVATE ${CMAKE_BINARY_DIR}/expat)
add_library(EXPAT::EXPAT ALIAS aspic_EXPAT)

file(GLOB sources ${muparser_folder}/src/*.cpp)
list(FILTER sources EXCLUDE REGEX "(DLL|Int|Test)\\.cpp$")
add_library(aspic_MUPARSER STATIC ${sources})
target_include_directories(aspic_MUPARSER SYSTEM PUBLIC ${muparser_folder}/include)
target_compile_definitions(aspic_MUPARSER PUBLIC MUPARSER_STATIC)
foreach(target aspic_ZLIB aspic_EXPAT aspic_MUPARSER)
  target_compile_options(${target} PRIVATE -w)
endforeach()
set(CMAKE_UNITY_BUILD ${ASPIC_UNITY})
