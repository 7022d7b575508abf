# Unit tests of the core as WebAssembly, for Node.js; tools/wasm_tests builds and runs them.
set(gtest /usr/src/googletest CACHE PATH "Sources of GoogleTest, Debian package googletest")
add_library(aspic_gtest STATIC EXCLUDE_FROM_ALL ${gtest}/googletest/src/gtest-all.cc ${gtest}/googlemock/src/gmock-all.cc
            ${gtest}/googlemock/src/gmock_main.cc)
set_target_properties(aspic_gtest PROPERTIES UNITY_BUILD OFF)
target_include_directories(aspic_gtest SYSTEM PUBLIC ${gtest}/googletest/include ${gtest}/googlemock/include
                           PRIVATE ${gtest}/googletest ${gtest}/googlemock)
target_compile_options(aspic_gtest PRIVATE -w)

add_custom_target(wasm_tests)
foreach(module math linalg optimize energy mesh contact dynamics engine)
  file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${module}/*_test.cpp)
  if(module STREQUAL "engine")
    set(tests ${PROJECT_SOURCE_DIR}/apps/engine/self_test_test.cpp)
  endif()
  add_executable(test_${module} EXCLUDE_FROM_ALL ${tests})
  set_target_properties(test_${module} PROPERTIES UNITY_BUILD OFF)
  target_link_libraries(test_${module} PRIVATE aspic aspic_build Eigen3::Eigen aspic_gtest)
  target_include_directories(test_${module} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests)
  target_compile_options(test_${module} PRIVATE -O1)
  target_link_options(test_${module} PRIVATE -O1 -sENVIRONMENT=node -sNODERAWFS=1 -sEXIT_RUNTIME=1 -sTOTAL_STACK=4MB
                      -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4096MB)
  add_dependencies(wasm_tests test_${module})
endforeach()
foreach(name affine_motion integrators models)  # shared with `aspic verify`
  target_sources(test_dynamics PRIVATE ${PROJECT_SOURCE_DIR}/tests/reference/${name}.cpp)
endforeach()

# The engine's guard against miscompilation, also compiled with what it guards against.
set(guard ${PROJECT_SOURCE_DIR}/apps/engine/self_test.cpp)
add_library(miscompiled_guard OBJECT EXCLUDE_FROM_ALL ${guard})
target_compile_options(miscompiled_guard PRIVATE -Dengine=miscompiled -fslp-vectorize)
target_link_libraries(miscompiled_guard PRIVATE aspic_build)
target_include_directories(miscompiled_guard PRIVATE ${PROJECT_SOURCE_DIR}/apps ${PROJECT_SOURCE_DIR}/src)
target_sources(test_engine PRIVATE ${guard} $<TARGET_OBJECTS:miscompiled_guard>)
target_include_directories(test_engine PRIVATE ${PROJECT_SOURCE_DIR}/apps)
