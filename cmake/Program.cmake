# The one program.
add_executable(trocar apps/main.cpp)
target_compile_options(trocar PRIVATE ${TROCAR_WARNINGS})
target_link_libraries(trocar PRIVATE apps)
set_target_properties(trocar PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
