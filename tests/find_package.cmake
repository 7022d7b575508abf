# The installed library serves a project outside the tree.
if(NOT ASPIC_SANITIZE AND NOT ASPIC_COVERAGE)
  add_test(NAME installed_package
           COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR} -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}/installed_example
                   -DWORK=${CMAKE_BINARY_DIR}/installed_package -DGENERATOR=${CMAKE_GENERATOR}
                   -P ${CMAKE_CURRENT_SOURCE_DIR}/installed_example/check.cmake)
endif()
