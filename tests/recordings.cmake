# Measurements in the files of other programs, written by the tests themselves.
if(TARGET aspic_cli AND Python3_FOUND)
  add_python_tests(cli recordings_test.py Formats Selection Registration Forces)
endif()
