# The libraries that libaspic links, for this build and for projects that use the installed package.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(ZLIB)
find_dependency(EXPAT)

# Neither of these has a CMake package that one can count on.
find_library(METIS_LIBRARY metis REQUIRED)
find_library(MUPARSER_LIBRARY muparser REQUIRED)
foreach(name METIS MUPARSER)
  if(NOT TARGET aspic_${name})
    add_library(aspic_${name} UNKNOWN IMPORTED)
    set_target_properties(aspic_${name} PROPERTIES IMPORTED_LOCATION ${${name}_LIBRARY})
  endif()
endforeach()
