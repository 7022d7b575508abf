# Creep and relaxation compared with an integration by NumPy, if Debian's Python has it (package python3-numpy).
if(TARGET aspic_cli AND ASPIC_DEBIAN_PYTHON)
  add_test(NAME cli.Viscoelastic COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/viscoelastic_test.py)
  set_tests_properties(cli.Viscoelastic PROPERTIES SKIP_RETURN_CODE 77 ENVIRONMENT ASPIC=$<TARGET_FILE:aspic_cli>)
endif()
