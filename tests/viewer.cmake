# The viewer's program side, without a browser.
if(TARGET aspic_viewer)
  find_package(fmt REQUIRED)
  find_package(nlohmann_json REQUIRED)
  file(GLOB viewer_tests CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/viewer/*_test.cpp)
  add_aspic_tests(test_viewer ${viewer_tests})
  target_link_libraries(test_viewer PRIVATE aspic_viewer)
  target_include_directories(test_viewer SYSTEM PRIVATE ${BOOST_INCLUDE})
  target_compile_definitions(test_viewer PRIVATE ASPIC_SOURCE_DIR="${CMAKE_SOURCE_DIR}")

  add_aspic_tests(test_lessons ${CMAKE_SOURCE_DIR}/apps/aspic/lecture/lessons_test.cpp)
  target_link_libraries(test_lessons PRIVATE aspic_commands)
endif()
