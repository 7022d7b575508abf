# The tests of scenes read scenes/ and docs/scene.md of this source tree.
target_compile_definitions(test_scene PRIVATE ASPIC_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
