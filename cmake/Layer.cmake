# layer(<folder> <allowed folders...>): one library per folder. Its include root holds a link to that folder only, so
# that including a folder that is not allowed does not compile.
function(layer folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.h)
  list(FILTER sources EXCLUDE REGEX "/main\\.cpp$|_simd\\.cpp$")
  set(root ${CMAKE_BINARY_DIR}/include/${folder})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  list(TRANSFORM headers REPLACE "^${CMAKE_SOURCE_DIR}/" "${root}/")

  add_library(${folder} STATIC ${sources} ${CMAKE_SOURCE_DIR}/cmake/empty.cpp)
  target_sources(${folder} PUBLIC FILE_SET HEADERS BASE_DIRS ${root} FILES ${headers})
  set_target_properties(${folder} PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
  target_compile_options(${folder} PRIVATE ${TROCAR_WARNINGS})
  foreach(below ${ARGN})
    target_link_libraries(${folder} PUBLIC ${below})
  endforeach()
endfunction()

# Designated initialisers leave the other members at their defaults on purpose; GCC 12 warns falsely of -Wrestrict on text + std::string.
set(TROCAR_WARNINGS -Wall -Wextra -Wshadow -Wconversion -Wno-missing-field-initializers -Wno-restrict -Werror)
# The same bits are a promise: no value-changing optimisation, contraction only where a kernel asks for it.
add_compile_options(-ffp-contract=off)
add_compile_definitions(EIGEN_MPL2_ONLY EIGEN_MAX_STATIC_ALIGN_BYTES=16)
