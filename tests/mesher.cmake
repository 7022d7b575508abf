# The mesher, if it is built.
if(TARGET aspic-mesh)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_test(NAME mesher COMMAND Python3::Interpreter ${CMAKE_SOURCE_DIR}/tests/mesher_test.py $<TARGET_FILE:aspic-mesh>)
  set_tests_properties(mesher PROPERTIES COST 1)
endif()
