# `aspic fit-motion` against motions computed by the test itself.
if(TARGET aspic_cli AND Python3_FOUND)
  add_test(NAME cli.FitMotion COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/fit_motion_test.py)
  set_tests_properties(cli.FitMotion PROPERTIES ENVIRONMENT ASPIC=$<TARGET_FILE:aspic_cli>)
endif()
