# Killed, interrupted, out of time, out of disk: what is on the disk can be opened and resumed to the same bits.
find_package(Python3 COMPONENTS Interpreter)
if(TARGET aspic_cli AND Python3_FOUND)
  set(cases Killed KilledFit NoRoom ReadOnly TimeLimit Signals Certificate SameBits)
  if(ASPIC_VIEWER)
    list(APPEND cases KilledRender SignalsToRender)
  endif()
  foreach(case ${cases})
    add_test(NAME crash.${case}
             COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/crash_test.py ${case})
    set_tests_properties(crash.${case} PROPERTIES ENVIRONMENT ASPIC=$<TARGET_FILE:aspic_cli>)
  endforeach()
endif()
