# Random small scenes through the parser and the solvers: none crashes, hangs or reports a wrong status. A longer
# search: build/bin/random_scenes --seed 1001 --count 20000
add_executable(random_scenes ${CMAKE_CURRENT_LIST_DIR}/random_scenes/main.cpp
                             ${CMAKE_CURRENT_LIST_DIR}/random_scenes/judge.cpp
                             ${CMAKE_CURRENT_LIST_DIR}/random_scenes/scene_text.cpp)
target_link_libraries(random_scenes PRIVATE aspic aspic_build)
target_include_directories(random_scenes PRIVATE ${CMAKE_SOURCE_DIR}/src ${CMAKE_CURRENT_LIST_DIR})
add_test(NAME random_scenes COMMAND random_scenes --seed 1 --count 1000)
# A free body moves to 5e14 times its size, where all sums are round-off. Its ledger is still balanced.
add_test(NAME random_scenes.far_away
         COMMAND random_scenes --file ${CMAKE_CURRENT_LIST_DIR}/random_scenes/far_away.toml)
# Minimized without a Hessian to a tolerance near round-off: the residual is compared with the reported round-off.
add_test(NAME random_scenes.round_off COMMAND random_scenes --run 2657)
# The first stage is solved with the mass matrix alone, and forces of 1e8 N leave a residual above the tolerance.
add_test(NAME random_scenes.stiff_start
         COMMAND random_scenes --file ${CMAKE_CURRENT_LIST_DIR}/random_scenes/stiff_start.toml)
# Free flight without gravity. The residual of the first step is the round-off of positions, above its threshold.
add_test(NAME random_scenes.free_flight
         COMMAND random_scenes --file ${CMAKE_CURRENT_LIST_DIR}/random_scenes/free_flight.toml)
