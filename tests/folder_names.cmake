# The build compiles the same units in a folder whose path contains the names of modules.
add_test(NAME folder_names COMMAND ${CMAKE_SOURCE_DIR}/tests/folder_names_test.py ${CMAKE_SOURCE_DIR} ${CMAKE_COMMAND})
