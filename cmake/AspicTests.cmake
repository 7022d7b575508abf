# Functions that add tests of the core and of its packages.
include(GoogleTest)
find_package(GTest REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)  # an oracle of dense algebra
find_package(Python3 REQUIRED COMPONENTS Interpreter)
# Debian's Python, because packages such as python3-meshio and python3-numpy are invisible to others.
find_program(ASPIC_DEBIAN_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH aspic_REPOSITORY)

set(test_optimization -O1)  # compiles faster than -O3
if(ASPIC_FUZZ)  # theirs are the inline functions that the linker takes; none of them is fuzzed
  set(test_optimization -O2 -fno-sanitize=fuzzer-no-link)
endif()
# Tests that run for more than a few seconds. The others compile in half the time without optimization.
set(long_programs bench cholmod linalg scene verification crossing viewer lessons fit_data fit_model fit_estimate fit_pipeline)

# add_aspic_tests(NAME SOURCES...): a program of unit tests.
function(add_aspic_tests name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE aspic_reference aspic_build Eigen3::Eigen GTest::gmock GTest::gtest GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${aspic_REPOSITORY}/src ${aspic_REPOSITORY}/tests)
  target_compile_options(${name} PRIVATE ${test_optimization} -Wno-uninitialized)  # false alarms in AVX-512 headers
  string(REPLACE "test_" "" module ${name})
  if(NOT ASPIC_SANITIZE AND NOT ASPIC_FUZZ AND NOT module IN_LIST long_programs)
    target_compile_options(${name} PRIVATE -O0)
  endif()
  gtest_discover_tests(${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES)
endfunction()

# add_python_tests(PREFIX FILE [CLASS...]): a test PREFIX.CLASS for each class of a file that has tests, but those named.
# COST: the first run of ctest, which has no times, starts them before the short tests, so that none ends alone.
function(add_python_tests prefix file)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(STRINGS ${file} lines REGEX "^class |^    def test_")
  foreach(line ${lines})
    if(line MATCHES "^class ([A-Za-z0-9]+)")
      set(class ${CMAKE_MATCH_1})
    else()
      list(APPEND cases ${class})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES cases)
  list(REMOVE_ITEM cases ${ARGN})
  foreach(case ${cases})
    add_test(NAME ${prefix}.${case} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/${file} ${case})
    set_tests_properties(${prefix}.${case} PROPERTIES COST 1
                         ENVIRONMENT "ASPIC=$<TARGET_FILE:aspic_cli>;PYTHONPATH=${aspic_REPOSITORY}/tests")
  endforeach()
endfunction()
