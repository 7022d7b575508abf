# The viewer's program side, without a browser.
if(TARGET aspic_viewer)
  find_package(fmt REQUIRED)
  find_package(nlohmann_json REQUIRED)
  file(GLOB viewer_tests CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/viewer/*_test.cpp)
  add_aspic_tests(test_viewer ${viewer_tests})
  target_link_libraries(test_viewer PRIVATE aspic_viewer)
  target_include_directories(test_viewer SYSTEM PRIVATE ${BOOST_INCLUDE})
  target_compile_definitions(test_viewer PRIVATE ASPIC_SOURCE_DIR="${CMAKE_SOURCE_DIR}")

  add_aspic_tests(test_lessons ${CMAKE_SOURCE_DIR}/apps/aspic/lecture/lessons_test.cpp
    ${CMAKE_SOURCE_DIR}/apps/aspic/formulas_test.cpp ${CMAKE_SOURCE_DIR}/apps/aspic/gallery_test.cpp
    ${CMAKE_SOURCE_DIR}/apps/aspic/progress_test.cpp ${CMAKE_SOURCE_DIR}/apps/aspic/step_fields_test.cpp ${CMAKE_SOURCE_DIR}/apps/aspic/scene_gallery_test.cpp)
  target_link_libraries(test_lessons PRIVATE aspic_commands)
  target_compile_definitions(test_lessons PRIVATE ASPIC_SOURCE_DIR="${CMAKE_SOURCE_DIR}")

  # The page: types and unit tests.
  set(web ${CMAKE_SOURCE_DIR}/web)
  add_test(NAME page_types COMMAND ${NODE} ${web}/node_modules/typescript/bin/tsc --noEmit --project ${web})
  add_test(NAME page_units COMMAND ${NODE} ${web}/test/run.mjs)
  find_package(ZLIB REQUIRED)
  add_aspic_tests(test_mesh_pictures ${CMAKE_SOURCE_DIR}/apps/aspic/mesh_picture_test.cpp)
  target_link_libraries(test_mesh_pictures PRIVATE aspic_commands ZLIB::ZLIB)

  # The page with its program in Chromium, one browser at a time, beside other tests: it renders without a graphics card.
  file(GLOB page_themes CONFIGURE_DEPENDS ${web}/test/e2e/*.e2e.mjs ${CMAKE_SOURCE_DIR}/inverse/web/test/e2e/*.e2e.mjs)
  foreach(file ${page_themes})
    get_filename_component(theme ${file} NAME_WE)
    add_test(NAME page.${theme} COMMAND ${NODE} ${web}/test/e2e/run.mjs $<TARGET_FILE:aspic_cli> ${theme})
    set_tests_properties(page.${theme} PROPERTIES SKIP_RETURN_CODE 77 RESOURCE_LOCK browser COST 1)
  endforeach()
endif()
