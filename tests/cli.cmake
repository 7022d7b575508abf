# The program as its users meet it; standard Python drives it.
find_package(Python3 COMPONENTS Interpreter)
if(TARGET aspic_cli AND Python3_FOUND)
  foreach(case Help Materials Minimize Derivatives Check Convert Mesh Run Compare Interruption Lecture)
    add_test(NAME cli.${case} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/cli_test.py ${case})
    set_tests_properties(cli.${case} PROPERTIES ENVIRONMENT ASPIC=$<TARGET_FILE:aspic_cli> TIMEOUT 300)
  endforeach()
endif()
