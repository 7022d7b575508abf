# Follows docs/extending.md literally.
if(TARGET aspic_viewer)
  add_test(NAME extending COMMAND ${CMAKE_SOURCE_DIR}/tests/extending_test.py ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR} ${NODE})
endif()
