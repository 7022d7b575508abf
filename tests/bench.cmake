# Benchmarks: they run, give the known results, and take the known amount of work. Times are not tested.
if(TARGET bench_common)
  add_aspic_tests(test_bench ${CMAKE_SOURCE_DIR}/tests/bench/counts_test.cpp)
  target_link_libraries(test_bench PRIVATE bench_common)
  target_compile_definitions(test_bench PRIVATE ASPIC_SOURCE_DIR="${CMAKE_SOURCE_DIR}")

  # Aspic and the naive program agree with the reference displacement of the beam. Sanitizers make Eigen too slow.
  if(NOT ASPIC_SANITIZE)
    add_test(NAME bench.beam COMMAND bench_beam 7 --threads 1,2)
  endif()
  add_test(NAME bench.bent_beam COMMAND bench_beam 2 --bent --naive 0 --quiet)
  add_test(NAME bench.characters COMMAND bench_characters torus --detail tiny --steps 2 --csv characters.csv)
  # Missing shapes are reported and do not fail the test.
  add_test(NAME bench.missing_shapes COMMAND bench_characters bunny --shapes none --quiet)
  set_tests_properties(bench.missing_shapes PROPERTIES PASS_REGULAR_EXPRESSION "bunny +omitted")
  add_test(NAME bench.kernels COMMAND bench_kernels 2 --all-materials --threads 1,2 --seconds 1e-4 --repetitions 1
                                      --csv kernels.csv)
endif()
find_package(Python3 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME bench.compare COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/compare_test.py)
  add_test(NAME bench.contact COMMAND ${Python3_EXECUTABLE} ${CMAKE_SOURCE_DIR}/tests/bench/contact/run.py
                                      chute knives funnel rollers boxes --steps 1)
  set_tests_properties(bench.contact PROPERTIES ENVIRONMENT "ASPIC=$<TARGET_FILE:aspic_cli>" PASS_REGULAR_EXPRESSION
                                                "boxes +12500 +1 +1 ")
endif()
