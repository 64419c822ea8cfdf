# What nearly every file includes, compiled once: half of a build's time. Files still include what they use, which
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows.
add_library(common_headers OBJECT ${CMAKE_SOURCE_DIR}/cmake/empty.cpp)
target_link_libraries(common_headers PRIVATE Eigen3::Eigen)
target_precompile_headers(common_headers PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <memory>
  <optional> <span> <string> <vector> <Eigen/Core>)

# Names of a folder are its own, whichever file they stand in, so that its sources may compile as one.
option(TROCAR_UNITY "Compile a dozen sources or tests of a folder at a time: whole builds take half as long, single changes longer" OFF)

# Names that other files hide and unnamed namespaces of classes that no header shows are no fault.
add_library(together INTERFACE)
target_compile_options(together INTERFACE -Wno-shadow -Wshadow=local -Wno-subobject-linkage)

# Comes after what else a target links, so that its options have the last word.
function(compile_together target)
  if(TROCAR_UNITY)
    target_link_libraries(${target} PRIVATE together)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  endif()
endfunction()

# layer(<folder> <allowed folders...>): one library per folder. Its include root holds a link to that folder only, so
# that including a folder that is not allowed does not compile.
function(layer folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  file(GLOB_RECURSE headers RELATIVE ${CMAKE_SOURCE_DIR} CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.h)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$|_simd\\.cpp$")
  set(root ${CMAKE_BINARY_DIR}/include/${folder})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  list(TRANSFORM headers PREPEND ${root}/)

  add_library(${folder} STATIC ${sources})
  target_sources(${folder} PUBLIC FILE_SET HEADERS BASE_DIRS ${root} FILES ${headers})
  set_target_properties(${folder} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
  target_compile_options(${folder} PRIVATE ${TROCAR_WARNINGS})
  target_precompile_headers(${folder} REUSE_FROM common_headers)
  compile_together(${folder})
  foreach(below ${ARGN})
    target_link_libraries(${folder} PUBLIC ${below})
  endforeach()
endfunction()

# Designated initialisers leave the other members at their defaults on purpose.
set(TROCAR_TEST_WARNINGS -Wall -Wextra -Wshadow -Wno-missing-field-initializers -Werror)
# GCC 12 warns falsely of what it inlines from std::string.
list(APPEND TROCAR_TEST_WARNINGS -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
set(TROCAR_WARNINGS ${TROCAR_TEST_WARNINGS} -Wconversion)
# The same bits are a promise: no value-changing optimisation, contraction only where a kernel asks for it.
add_compile_options(-ffp-contract=off)
add_compile_definitions(EIGEN_MPL2_ONLY EIGEN_MAX_STATIC_ALIGN_BYTES=16)
