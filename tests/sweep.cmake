# Ensembles: studies, job lists that are killed and run again, collected results.
if(TARGET aspic_cli AND Python3_FOUND)
  add_aspic_tests(test_sweep ${CMAKE_SOURCE_DIR}/apps/aspic/sweep/study_test.cpp)
  target_link_libraries(test_sweep PRIVATE aspic_commands)
  add_python_tests(sweep sweep_test.py)
endif()
