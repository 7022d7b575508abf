# The libraries that libaspic links, for this build and for projects that use the installed package.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(ZLIB)

foreach(name metis muparser) # neither has a reliable CMake package
  if(NOT TARGET aspic_${name})
    find_library(ASPIC_${name}_LIBRARY ${name} REQUIRED)
    add_library(aspic_${name} UNKNOWN IMPORTED)
    set_target_properties(aspic_${name} PROPERTIES IMPORTED_LOCATION ${ASPIC_${name}_LIBRARY})
  endif()
endforeach()
