#include "base/heap.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace trocar {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

// The number behind `word` in a file of words, or its first one; `missing` if there is none.
double number_in(const std::string& file, const std::string& word, double missing) {
  std::ifstream in(file);
  std::string before;
  while (!word.empty() && before != word && in >> before) {
  }
  double number = 0;
  return in >> number ? number : missing;
}

// Of the group of this process and those above it.
double memory_of_group() {
  std::ifstream in("/proc/self/cgroup");
  std::string line;
  while (std::getline(in, line) && !line.starts_with("0::")) {
  }
  if (!line.starts_with("0::")) return unlimited;
  double free = unlimited;
  for (std::string path = line.substr(3);; path.resize(path.rfind('/'))) {
    const std::string folder = "/sys/fs/cgroup" + path;
    const double most = number_in(folder + "/memory.max", "", unlimited);  // "max" is no number
    // What only caches files is given back.
    const double used = number_in(folder + "/memory.current", "", 0) -
                        number_in(folder + "/memory.stat", "inactive_file", 0);
    free = std::min(free, most - used);
    if (path.empty() || path == "/") return free;
  }
}

}  // namespace

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

double memory_of_host() {
  const double kilobytes = number_in("/proc/meminfo", "MemAvailable:", unlimited);
  return std::min(1024 * kilobytes, memory_of_group());
}

double memory_of_process() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double pages = number_in("/proc/self/statm", "", 0);
  return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace trocar
