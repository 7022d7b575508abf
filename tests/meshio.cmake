# Mesh files compared with meshio, if Debian's Python has it (package python3-meshio).
execute_process(COMMAND /usr/bin/python3 -c "import meshio" RESULT_VARIABLE meshio_missing OUTPUT_QUIET ERROR_QUIET)
if(NOT meshio_missing)
  add_executable(mesh_copy mesh_copy.cpp)
  target_link_libraries(mesh_copy PRIVATE aspic aspic_build)
  add_test(NAME meshio COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/meshio_oracle.py $<TARGET_FILE:mesh_copy>)
  add_test(NAME meshio.mechanics COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/mechanics_oracle.py
                                         $<TARGET_FILE:aspic_cli>)
endif()
