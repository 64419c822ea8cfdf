// Counts allocations by new. It replaces the program's operators: included by one file a program.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <new>

inline std::int64_t n_allocations = 0;

[[gnu::noinline]] void* operator new(std::size_t n) {
  ++n_allocations;
  if (void* p = std::malloc(n)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
  ++n_allocations;
  return std::malloc(n);
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
