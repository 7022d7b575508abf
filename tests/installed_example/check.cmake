# cmake -DBUILD=... -DSOURCE=... -DWORK=... -DGENERATOR=... -P check.cmake
# Installs into an empty prefix, builds the example against what lies there, runs it.
file(REMOVE_RECURSE ${WORK})
function(step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed:\n${output}")
  endif()
  message(STATUS "${what}: done")
endfunction()

step("installing" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step("configuring the example" ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR}
     -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${WORK}/prefix)
step("building the example" ${CMAKE_COMMAND} --build ${WORK}/build)
step("running the example" ${WORK}/build/installed_example)
if(NOT EXISTS ${WORK}/prefix/bin/aspic)
  message(FATAL_ERROR "the program aspic was not installed")
endif()
step("running the installed program" ${WORK}/prefix/bin/aspic --version)
