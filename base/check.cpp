// The end of a program that found a mistake of its own: one sentence, then no rank goes on.
#include "base/check.h"

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "base/communicator.h"

namespace trocar {

// "folder/file.cpp" of a path: where the sources lay at build time is of no interest.
static std::string_view folder_and_file(std::string_view path) {
  const std::size_t last = path.rfind('/');
  if (last == std::string_view::npos || last == 0) return path;
  const std::size_t before = path.rfind('/', last - 1);
  return before == std::string_view::npos ? path : path.substr(before + 1);
}

void check_failed(const char* condition, const char* file, int line, const char* values) {
  const std::string_view place = folder_and_file(file);
  const bool has_values = values[0] != '\0';
  std::fprintf(stderr, "trocar: CHECK failed: %s%s%s%s at %.*s:%d\n", condition,
               has_values ? " (" : "", values, has_values ? ")" : "",
               static_cast<int>(place.size()), place.data(), line);
  std::fflush(nullptr);
  // 134 is what a shell reports for abort(); one rank aborts for real, for the core dump.
  if (has_other_ranks()) abort_all_ranks(134);
  std::abort();
}

}  // namespace trocar
