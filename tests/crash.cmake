# Runs that are killed, interrupted, out of time or out of disk space: files stay readable and resuming gives the same
# bits.
if(TARGET aspic_cli AND Python3_FOUND)
  add_python_tests(crash crash_test.py Killed NoRoom ReadOnly TimeLimit)
  add_python_tests(crash signals_test.py Signals Certificate SameBits)
  if(ASPIC_VIEWER)
    add_python_tests(crash crash_test.py KilledRender)
    add_python_tests(crash signals_test.py SignalsToRender)
  endif()
endif()
