# The viewer's program side, without a browser.
if(TARGET aspic_viewer)
  find_package(fmt REQUIRED)
  find_package(nlohmann_json REQUIRED)
  file(GLOB viewer_tests CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/viewer/*_test.cpp)
  add_aspic_tests(test_viewer ${viewer_tests})
  target_link_libraries(test_viewer PRIVATE aspic_viewer)
  target_include_directories(test_viewer SYSTEM PRIVATE ${BOOST_INCLUDE})
  target_compile_definitions(test_viewer PRIVATE ASPIC_SOURCE_DIR="${CMAKE_SOURCE_DIR}")

  # The page: types, unit tests, and the shortcuts in its guide.
  set(web ${CMAKE_SOURCE_DIR}/web)
  add_test(NAME page_types COMMAND ${NODE} ${web}/node_modules/typescript/bin/tsc --noEmit --project ${web})
  add_test(NAME page_units COMMAND ${NODE} ${web}/test/run.mjs)
  add_test(NAME page_guide COMMAND ${NODE} ${web}/test/guide.mjs ${CMAKE_BINARY_DIR}/web/page.html)
  add_test(NAME page_viewer COMMAND ${NODE} ${web}/test/viewer.mjs $<TARGET_FILE:aspic_cli>)
  set_tests_properties(page_guide page_viewer PROPERTIES SKIP_RETURN_CODE 77)
endif()
