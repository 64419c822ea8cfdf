# Reads hostile bytes under libFuzzer with address and undefined-behaviour sanitizers (tests/fuzz). Everything is
# compiled by GCC, which alone knows all that the kernels use; only libFuzzer itself is clang's.
option(TROCAR_FUZZ "Build the fuzz targets, and everything with sanitizers and a trace of what is reached" OFF)
if(TROCAR_FUZZ)
  find_program(TROCAR_CLANG clang)
  if(TROCAR_CLANG)
    execute_process(COMMAND ${TROCAR_CLANG} -print-resource-dir OUTPUT_VARIABLE of_clang OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(TROCAR_LIBFUZZER ${of_clang}/lib/linux/libclang_rt.fuzzer-x86_64.a)
  endif()
  if(NOT EXISTS "${TROCAR_LIBFUZZER}" OR NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    message(FATAL_ERROR "TROCAR_FUZZ needs GCC as the compiler (found ${CMAKE_CXX_COMPILER_ID}) and clang beside it, for its "
      "libFuzzer (found: ${TROCAR_LIBFUZZER}): apt-get install g++ clang")
  endif()
  add_compile_options(-O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all)
  add_compile_options(-fsanitize-coverage=trace-pc,trace-cmp)
  add_link_options(-fsanitize=address,undefined)
endif()
