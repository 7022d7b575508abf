# cmake --install: the programs, the library and its headers, and a package for find_package(aspic).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/aspic)

install(TARGETS aspic EXPORT aspic-targets)
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aspic FILES_MATCHING PATTERN "*.h" PATTERN "*_test.h" EXCLUDE)
install(EXPORT aspic-targets NAMESPACE aspic:: DESTINATION ${package_dir})

configure_package_config_file(cmake/aspic-config.cmake.in ${CMAKE_BINARY_DIR}/aspic-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/aspic-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/aspic-config.cmake ${CMAKE_BINARY_DIR}/aspic-config-version.cmake
              cmake/AspicDependencies.cmake DESTINATION ${package_dir})
# `aspic lecture` finds its scenes there, and the bunny where ./run has made it.
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/aspic)
install(DIRECTORY assets DESTINATION ${CMAKE_INSTALL_DATADIR}/aspic OPTIONAL FILES_MATCHING PATTERN "bunny.*")
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
