# Fits of measurements of an independent finite element program, if Debian's Python has NumPy and SciPy.
if(ASPIC_DEBIAN_PYTHON)
  add_test(NAME oracle.QuadraticFem COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/oracle/quadratic_fem_test.py)
  set_tests_properties(oracle.QuadraticFem PROPERTIES SKIP_RETURN_CODE 77 ENVIRONMENT "OMP_NUM_THREADS=1;OPENBLAS_NUM_THREADS=1")
endif()
if(TARGET aspic_cli AND ASPIC_DEBIAN_PYTHON)
  add_test(NAME oracle.Fits COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/oracle/capture_truths_test.py)
  set_tests_properties(oracle.Fits PROPERTIES SKIP_RETURN_CODE 77
                       ENVIRONMENT "ASPIC=$<TARGET_FILE:aspic_cli>;OMP_NUM_THREADS=1;OPENBLAS_NUM_THREADS=1")
  add_test(NAME oracle.FitsOfDisturbedData
           COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/oracle/capture_errors_test.py)
  set_tests_properties(oracle.FitsOfDisturbedData PROPERTIES SKIP_RETURN_CODE 77
                       ENVIRONMENT "ASPIC=$<TARGET_FILE:aspic_cli>;OMP_NUM_THREADS=1;OPENBLAS_NUM_THREADS=1")
endif()
