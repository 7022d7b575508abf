# A plate compared with dolfinx, if Debian's Python has it (package python3-dolfinx).
if(TARGET aspic_cli AND ASPIC_DEBIAN_PYTHON)
  execute_process(COMMAND ${ASPIC_DEBIAN_PYTHON} -c "import importlib.util, sys; sys.exit(importlib.util.find_spec('dolfinx') is None)"
                  RESULT_VARIABLE lacks_dolfinx)
  if(NOT lacks_dolfinx)
    add_test(NAME plate_oracle COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/plate_oracle.py $<TARGET_FILE:aspic_cli>)
    set_tests_properties(plate_oracle PROPERTIES ENVIRONMENT XDG_CACHE_HOME=${CMAKE_CURRENT_BINARY_DIR})
  endif()
endif()
