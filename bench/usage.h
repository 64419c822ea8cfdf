// What benches answer to --help, and to options that they don't know.
#pragma once

#include <cstdio>
#include <cstring>

namespace trocar {

inline int print_usage(const char* usage, std::FILE* file) {
  std::fprintf(file, "usage: %s\n", usage);
  return file == stdout ? 0 : 2;
}

inline bool is_help_asked(int argc, char** argv) {
  for (int k = 1; k < argc; ++k)
    if (std::strcmp(argv[k], "--help") == 0 || std::strcmp(argv[k], "-h") == 0) return true;
  return false;
}

// Exit code of a bench that knows no other option: 0 after --help, 2 after anything else that looks
// like one; -1: it is to run.
inline int answer_options(int argc, char** argv, const char* usage) {
  if (is_help_asked(argc, argv)) return print_usage(usage, stdout);
  for (int k = 1; k < argc; ++k)
    if (argv[k][0] == '-') return print_usage(usage, stderr);
  return -1;
}

}  // namespace trocar
