# The linear algebra's tests compare with Eigen, whose AVX-512 intrinsics make GCC 12 warn without cause.
find_package(Eigen3 REQUIRED NO_MODULE)
target_link_libraries(test_linalg PRIVATE Eigen3::Eigen)
target_compile_options(test_linalg PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
