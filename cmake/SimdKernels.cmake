# The element kernels, compiled once per instruction set; solver picks one at start.
# The files take no inline function of a common header with them: their interface is raw pointers.
file(GLOB simd_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/solver/*_simd.cpp)
# For tests: quick to compile.
set(simd_flags_scalar -march=x86-64 -O1)
set(simd_flags_sse2 -march=x86-64)
set(simd_flags_avx2 -march=x86-64-v3)
set(simd_flags_avx512 -march=x86-64-v4 -mprefer-vector-width=512)
foreach(isa scalar sse2 avx2 avx512)
  add_library(solver_${isa} OBJECT ${simd_sources})
  target_include_directories(solver_${isa} PRIVATE ${CMAKE_BINARY_DIR}/include/solver)
  target_compile_definitions(solver_${isa} PRIVATE TROCAR_ISA=${isa})
  target_compile_options(solver_${isa} PRIVATE ${TROCAR_WARNINGS} ${simd_flags_${isa}} -ffp-contract=fast)
  target_sources(solver PRIVATE $<TARGET_OBJECTS:solver_${isa}>)
endforeach()
