// CHECK finds our own mistakes and ends all ranks; DCHECK does so in the dev and sanitizer presets
// only.
#pragma once

namespace trocar {

// Prints the sentence with its place to stderr and ends the program on every rank.
[[noreturn]] void check_failed(const char* condition, const char* file, int line,
                               const char* values);

}  // namespace trocar

#include <sstream>

#define CHECK(condition)                                                          \
  do {                                                                            \
    if (!(condition)) ::trocar::check_failed(#condition, __FILE__, __LINE__, ""); \
  } while (false)

// Compares with `op` and prints both values: CHECK_OP(n, ==, m).
#define CHECK_OP(a, op, b)                                                                       \
  do {                                                                                           \
    const auto& check_a = (a);                                                                   \
    const auto& check_b = (b);                                                                   \
    if (!(check_a op check_b)) {                                                                 \
      std::ostringstream check_values;                                                           \
      check_values << check_a << " " #op " " << check_b;                                         \
      ::trocar::check_failed(#a " " #op " " #b, __FILE__, __LINE__, check_values.str().c_str()); \
    }                                                                                            \
  } while (false)

#ifdef TROCAR_DCHECK
#define DCHECK(condition) CHECK(condition)
#else
#define DCHECK(condition) static_cast<void>(0)
#endif
