# Other programs read the result files.
add_executable(results_samples ${CMAKE_CURRENT_LIST_DIR}/results_samples.cpp)
target_link_libraries(results_samples PRIVATE aspic aspic_build)
if(ASPIC_DEBIAN_PYTHON)
  add_test(NAME results_oracle COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/results_oracle.py
                                       $<TARGET_FILE:results_samples>
                                       ${CMAKE_SOURCE_DIR}/build/oracles/node_modules/tinyusdz)  # fetched by ./test
  set_tests_properties(results_oracle PROPERTIES SKIP_RETURN_CODE 77)
endif()
