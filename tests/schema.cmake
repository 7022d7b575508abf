# `aspic schema` checked by an independent validator, if Debian's Python has it (package python3-jsonschema).
if(TARGET aspic_cli AND ASPIC_DEBIAN_PYTHON)
  add_test(NAME cli.Schema COMMAND ${ASPIC_DEBIAN_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/schema_test.py $<TARGET_FILE:aspic_cli>
                                   ${CMAKE_SOURCE_DIR}/scenes)
  set_tests_properties(cli.Schema PROPERTIES SKIP_RETURN_CODE 77)
endif()
