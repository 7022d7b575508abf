# Charts and pages of the program; requires gnuplot. Pictures of meshes are in viewer.cmake.
find_package(fmt QUIET)
if(TARGET aspic_cli AND fmt_FOUND)
  set(program ${CMAKE_SOURCE_DIR}/apps/aspic)
  add_aspic_tests(test_pictures ${program}/plot_test.cpp ${program}/report_page_test.cpp ${program}/gnuplot.cpp
    ${program}/plot_chart.cpp ${program}/plot_surface.cpp ${program}/report_page.cpp)
  target_link_libraries(test_pictures PRIVATE fmt::fmt)
  target_include_directories(test_pictures PRIVATE ${CMAKE_SOURCE_DIR}/apps)
endif()
