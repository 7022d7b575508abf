# cmake --install: programs, library, headers, and a package for find_package(aspic).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/aspic)

install(TARGETS aspic EXPORT aspic-targets)
# Installs only the headers of include/aspic, each expanded by the headers of src/ that it names.
install(CODE "
  execute_process(COMMAND \"${CMAKE_COMMAND}\" \"-DHEADERS=${CMAKE_SOURCE_DIR}/include/aspic\" \"-DSOURCES=${CMAKE_SOURCE_DIR}/src\"
                          \"-DOUTPUT=${CMAKE_BINARY_DIR}/include/aspic\" -P \"${CMAKE_SOURCE_DIR}/cmake/PublicHeaders.cmake\"
                  COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${CMAKE_BINARY_DIR}/include/aspic DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT aspic-targets NAMESPACE aspic:: DESTINATION ${package_dir})

configure_package_config_file(cmake/aspic-config.cmake.in ${CMAKE_BINARY_DIR}/aspic-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/aspic-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/aspic-config.cmake ${CMAKE_BINARY_DIR}/aspic-config-version.cmake
              cmake/AspicDependencies.cmake DESTINATION ${package_dir})
# Folder in which `aspic lecture` finds its scenes, and the bunny that ./run creates.
install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/aspic)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The packages of this repository (distributed, inverse) find the core in its build folder: -Daspic_DIR=.../package.
set(package ${CMAKE_BINARY_DIR}/package)
set(exported aspic aspic_build aspic_run_commands)
if(ASPIC_VIEWER)
  list(APPEND exported aspic_recordings aspic_viewer)
endif()
export(TARGETS ${exported} NAMESPACE aspic:: FILE ${package}/aspic-targets.cmake)
configure_file(cmake/aspic-build-config.cmake.in ${package}/aspic-config.cmake @ONLY)
file(COPY_FILE ${CMAKE_BINARY_DIR}/aspic-config-version.cmake ${package}/aspic-config-version.cmake)
