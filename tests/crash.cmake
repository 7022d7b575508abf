# Runs that are killed, interrupted, out of time or out of disk space: files stay readable and resuming gives the same
# bits.
if(TARGET aspic_cli AND Python3_FOUND)
  if(NOT ASPIC_VIEWER)
    set(of_viewer KilledRender SignalsToRender)
  endif()
  add_python_tests(crash crash_test.py ${of_viewer})
  add_python_tests(crash signals_test.py ${of_viewer})
endif()
