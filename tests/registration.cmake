# Markers in other coordinates, and forces over time.
if(TARGET aspic_cli AND Python3_FOUND)
  add_python_tests(cli registration_test.py Registration Forces)
endif()
