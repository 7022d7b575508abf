# `aspic fit-motion` against motions computed by the test itself.
if(TARGET aspic_cli AND Python3_FOUND)
  add_python_tests(cli fit_motion_test.py FitMotion FitMotionSwing FitMotionErrors)
endif()
