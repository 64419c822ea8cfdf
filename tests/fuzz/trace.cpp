// What GCC's -fsanitize-coverage=trace-pc calls at each branch, as counters that libFuzzer looks at
// (clang's own ways of counting are others). Compiled without sanitizers, and linked before
// libFuzzer, which has a function of this name that refuses.
#include <cstdint>

namespace {

constexpr unsigned bits_of_place = 17;
[[gnu::section("__libfuzzer_extra_counters"),
  gnu::used]] std::uint8_t reached[std::size_t{1} << bits_of_place];

}  // namespace

extern "C" void __sanitizer_cov_trace_pc() {
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;
  const auto place = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  std::uint8_t& count = reached[place * golden >> (64 - bits_of_place)];
  if (count != 255) ++count;
}

// Comparisons of numbers that are no integers, which libFuzzer makes nothing of.
extern "C" void __sanitizer_cov_trace_cmpf(float /*a*/, float /*b*/) {}
extern "C" void __sanitizer_cov_trace_cmpd(double /*a*/, double /*b*/) {}
