# Tests that go through the front door: they start the program, alone and under mpirun.
find_package(nlohmann_json REQUIRED)
string(JOIN " " mpirun_text ${TROCAR_MPIRUN})
foreach(folder scenes invariance faults)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*_test.cpp)
  if(sources)
    add_executable(test_${folder} ${sources})
    add_dependencies(test_${folder} trocar)
    target_link_libraries(test_${folder} PRIVATE mesh nlohmann_json::nlohmann_json GTest::gtest GTest::gtest_main)
    target_include_directories(test_${folder} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/support)
    target_compile_options(test_${folder} PRIVATE ${TROCAR_TEST_WARNINGS})
    target_compile_definitions(test_${folder} PRIVATE TROCAR_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
      TROCAR_PROGRAM="$<TARGET_FILE:trocar>" TROCAR_MPIRUN="${mpirun_text}")
    # They use all cores of the machine themselves.
    gtest_discover_tests(test_${folder} TEST_PREFIX ${folder}/ DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600 RUN_SERIAL TRUE)
  endif()
endforeach()

# Many scenes in one start of ranks.
add_executable(scene_digests invariance/scene_digests.cpp)
target_link_libraries(scene_digests PRIVATE engine)
target_compile_options(scene_digests PRIVATE ${TROCAR_TEST_WARNINGS})
add_dependencies(test_invariance scene_digests)
target_compile_definitions(test_invariance PRIVATE TROCAR_SCENE_DIGESTS="$<TARGET_FILE:scene_digests>")
