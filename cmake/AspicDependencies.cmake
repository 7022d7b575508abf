# Libraries that libaspic links, for this build and for users of the installed package.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(ZLIB)
find_dependency(EXPAT)

# Neither of these reliably has a CMake package.
set(without_package MUPARSER)
find_library(MUPARSER_LIBRARY muparser REQUIRED)
if(ASPIC_METIS)
  list(APPEND without_package METIS)
  find_library(METIS_LIBRARY metis REQUIRED)
endif()
foreach(name ${without_package})
  if(NOT TARGET aspic_${name})
    add_library(aspic_${name} UNKNOWN IMPORTED)
    set_target_properties(aspic_${name} PROPERTIES IMPORTED_LOCATION ${${name}_LIBRARY})
  endif()
endforeach()
