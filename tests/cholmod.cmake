# CHOLMOD (GPL) is a reference for tests only. Without it these tests are omitted.
find_library(CHOLMOD_LIBRARY cholmod)
find_path(CHOLMOD_INCLUDE suitesparse/cholmod.h)
if(CHOLMOD_LIBRARY AND CHOLMOD_INCLUDE)
  add_aspic_tests(test_cholmod ${CMAKE_CURRENT_SOURCE_DIR}/oracle/cholmod_test.cpp)
  target_link_libraries(test_cholmod PRIVATE ${CHOLMOD_LIBRARY})
  target_include_directories(test_cholmod SYSTEM PRIVATE ${CHOLMOD_INCLUDE})
endif()
