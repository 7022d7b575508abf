# Runs on several MPI ranks. Waiting ranks occupy their processors, so nothing else runs beside them.
if(TARGET aspic-mpi AND TARGET aspic_cli AND Python3_FOUND)
  add_executable(mpi_exception mpi_exception.cpp)
  target_link_libraries(mpi_exception PRIVATE aspic_distributed aspic_build)
  find_program(MPIRUN mpirun REQUIRED)
  foreach(case Equality Parts Slices Orders Shares SameBits Refusals Faults)
    add_test(NAME mpi.${case} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/mpi_test.py ${case})
    set_tests_properties(mpi.${case} PROPERTIES LABELS mpi RUN_SERIAL TRUE TIMEOUT 900
      ENVIRONMENT "ASPIC=$<TARGET_FILE:aspic_cli>;ASPIC_MPI=$<TARGET_FILE:aspic-mpi>;MPIRUN=${MPIRUN};MPI_EXCEPTION=$<TARGET_FILE:mpi_exception>")
  endforeach()
endif()
