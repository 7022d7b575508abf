# A project outside of the tree builds with the installed library.
if(NOT ASPIC_SANITIZE AND NOT ASPIC_COVERAGE)
  add_test(NAME installed_package
           COMMAND ${CMAKE_COMMAND} -DBUILD=${CMAKE_BINARY_DIR} -DROOT=${CMAKE_SOURCE_DIR}
                   -DWORK=${CMAKE_BINARY_DIR}/installed_package -DGENERATOR=${CMAKE_GENERATOR}
                   -DCOMPILER=${CMAKE_CXX_COMPILER} -P ${CMAKE_CURRENT_SOURCE_DIR}/installed_example/check.cmake)
endif()

# Public headers contain the internal headers that they name, and must not contain others.
function(add_header_test name fault)
  add_test(NAME public_headers.${name}
           COMMAND ${CMAKE_COMMAND} -DHEADERS=${CMAKE_CURRENT_SOURCE_DIR}/public_headers/${name}
                   -DSOURCES=${CMAKE_CURRENT_SOURCE_DIR}/public_headers
                   -DOUTPUT=${CMAKE_BINARY_DIR}/public_headers/${name}
                   -P ${CMAKE_SOURCE_DIR}/cmake/PublicHeaders.cmake)
  set_tests_properties(public_headers.${name} PROPERTIES PASS_REGULAR_EXPRESSION "${fault}")
endfunction()
add_header_test(reaches_internal_header "part/wheel.h,[ \n]+which is internal")
add_header_test(names_header_twice "part/axle.h belongs to aspic/a.h and to aspic/b.h")
