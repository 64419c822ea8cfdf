#include "base/heap.h"

#include <malloc.h>
#include <sys/resource.h>

namespace trocar {

void keep_freed_memory() {
  constexpr int most_kept = 256 << 20, least_apart = 32 << 20;  // bytes
  mallopt(M_TRIM_THRESHOLD, most_kept);
  mallopt(M_MMAP_THRESHOLD, least_apart);  // larger pieces go back by themselves
}

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

}  // namespace trocar
