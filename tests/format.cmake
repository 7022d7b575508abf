# Every source is formatted as .clang-format says, and the shell scripts parse.
find_program(CLANG_FORMAT clang-format)
if(CLANG_FORMAT)
  add_test(NAME format COMMAND ${CMAKE_SOURCE_DIR}/tools/lint)
endif()
foreach(script run test tools/setup.sh tools/lint .ci/run)
  add_test(NAME shell.${script} COMMAND sh -n ${CMAKE_SOURCE_DIR}/${script})
endforeach()
