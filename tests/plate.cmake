# A plate compared with dolfinx, if Debian's Python has it (package python3-dolfinx).
if(TARGET aspic_cli AND ASPIC_DEBIAN_PYTHON)
  add_test(NAME plate_oracle COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/plate_oracle.py $<TARGET_FILE:aspic_cli>)
  set_tests_properties(plate_oracle PROPERTIES SKIP_RETURN_CODE 77 ENVIRONMENT XDG_CACHE_HOME=${CMAKE_CURRENT_BINARY_DIR})
endif()
