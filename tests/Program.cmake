# Tests that go through the front door: they start the program, alone and under mpirun.
find_package(nlohmann_json REQUIRED)
set(TROCAR_ON_RANKS ${CMAKE_SOURCE_DIR}/scripts/on_ranks)
add_library(test_program STATIC support/program.cpp)
target_link_libraries(test_program PUBLIC test_support_mesh nlohmann_json::nlohmann_json PRIVATE test_options)
target_compile_definitions(test_program PUBLIC TROCAR_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
  TROCAR_PROGRAM="$<TARGET_FILE:trocar>" TROCAR_ON_RANKS="${TROCAR_ON_RANKS}")
target_precompile_headers(test_program PRIVATE <gtest/gtest.h> <cmath> <filesystem> <fstream> <nlohmann/json.hpp> <sstream> <string>)

# These keep all cores of the machine busy themselves; they come first, so that no core waits for their turn. The others start the
# program alone, have little for their ranks to do, or wait.
set(many_ranks
  "StateDigest.*:Traffic.*:Resume.in_*:Resume.of_*:Signals.*:BlockHex*:PlaneCut.*:BadInput.too_many_ranks_*")
set(properties TIMEOUT 600)
set(many_ranks_properties ${properties} PROCESSORS 4 COST 100)
foreach(folder scenes invariance faults)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*_test.cpp)
  add_executable(test_${folder} ${sources})
  add_dependencies(test_${folder} trocar)
  target_link_libraries(test_${folder} PRIVATE test_program test_options GTest::gtest_main)
  target_precompile_headers(test_${folder} REUSE_FROM test_program)
  gtest_discover_tests(test_${folder} TEST_PREFIX ${folder}/ DISCOVERY_TIMEOUT 60 TEST_FILTER -${many_ranks}:LiverIncision.*
    TEST_LIST ${folder}_tests PROPERTIES ${properties})
  gtest_discover_tests(test_${folder} TEST_PREFIX ${folder}/ DISCOVERY_TIMEOUT 60 TEST_FILTER ${many_ranks}
    TEST_LIST ${folder}_tests_on_many_ranks PROPERTIES ${many_ranks_properties})
endforeach()

# One run for all its tests.
add_test(NAME scenes/LiverIncision COMMAND test_scenes --gtest_filter=LiverIncision.*)
set_tests_properties(scenes/LiverIncision PROPERTIES ${many_ranks_properties})

# Many scenes in one start of ranks.
add_executable(scene_digests invariance/scene_digests.cpp)
target_link_libraries(scene_digests PRIVATE engine test_options)
add_dependencies(test_invariance scene_digests)
target_compile_definitions(test_invariance PRIVATE TROCAR_SCENE_DIGESTS="$<TARGET_FILE:scene_digests>")

add_executable(slow_rank invariance/slow_rank.cpp)
target_link_libraries(slow_rank PRIVATE base test_options)
add_test(NAME invariance/a_rank_exchanges_while_the_other_is_busy COMMAND ${TROCAR_ON_RANKS} 2 $<TARGET_FILE:slow_rank>)
set_tests_properties(invariance/a_rank_exchanges_while_the_other_is_busy PROPERTIES TIMEOUT 60)

add_executable(cut_on_ranks invariance/cut_on_ranks.cpp)
target_link_libraries(cut_on_ranks PRIVATE test_support_engine test_options GTest::gtest)
add_test(NAME invariance/ranks_around_the_blade_cut COMMAND ${TROCAR_ON_RANKS} 4 $<TARGET_FILE:cut_on_ranks>)
set_tests_properties(invariance/ranks_around_the_blade_cut PROPERTIES ${many_ranks_properties})
