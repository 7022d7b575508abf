# cmake -DWEB=... -DNPM=... -P WebModules.cmake: installs the npm packages of the page if they are missing.
set(installed ${WEB}/node_modules/.package-lock.json)
if(EXISTS ${installed} AND NOT ${WEB}/package-lock.json IS_NEWER_THAN ${installed})
  return()
endif()
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
                WORKING_DIRECTORY ${WEB} RESULT_VARIABLE status OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${said}\nnpm could not fetch the packages of the viewer's page (no network?).\n"
                      "Try again with a network, or build without the viewer: cmake -DASPIC_VIEWER=OFF, or ASPIC_VIEWER=0 ./run")
endif()
file(TOUCH_NOCREATE ${installed})
