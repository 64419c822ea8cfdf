// Picks the kernels at run time and holds the scalar instance.
#include "solver/simd.h"

#include <atomic>

#include "base/error.h"
#include "solver/kernel_loops.h"
#include "solver/step.h"

namespace trocar {

namespace sse2 {
const Kernels& kernels();
}
namespace avx2 {
const Kernels& kernels();
}
namespace avx512 {
const Kernels& kernels();
}

const char* name_of(Simd simd) {
  constexpr const char* names[n_simd] = {"scalar", "sse2", "avx2", "avx512"};
  return names[static_cast<int>(simd)];
}

// x86-64-v3 and v4, as far as the compiler uses them here.
bool is_supported(Simd simd) {
  if (simd == Simd::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (simd == Simd::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd");
  return true;
}

const Kernels& kernels_of(Simd simd) {
  static constexpr Kernels scalar = make_kernels<double>(ElementList{});
  switch (simd) {
    case Simd::sse2:
      return sse2::kernels();
    case Simd::avx2:
      return avx2::kernels();
    case Simd::avx512:
      return avx512::kernels();
    case Simd::scalar:
      break;
  }
  return scalar;
}

static Simd widest() {
  for (const Simd simd : {Simd::avx512, Simd::avx2})
    if (is_supported(simd)) return simd;
  return Simd::sse2;
}

// The machine's setting: the only thing here that outlives a call.
static std::atomic<Simd>& selection() {
  static std::atomic<Simd> simd{widest()};
  return simd;
}

const Kernels& active_kernels() {
  return kernels_of(selection().load(std::memory_order_relaxed));
}

const char* simd_name() {
  return name_of(selection().load());
}

void select_simd(const std::string& name) {
  if (name == "auto") {
    selection() = widest();
    return;
  }
  for (int i = 0; i < n_simd; ++i) {
    const Simd simd = static_cast<Simd>(i);
    if (name != name_of(simd)) continue;
    if (!is_supported(simd))
      throw InputError("this machine has no " + name + " instructions; use \"auto\", which picks " +
                       name_of(widest()));
    selection() = simd;
    return;
  }
  throw InputError("unknown instruction set \"" + name +
                   "\"; known are auto, scalar, sse2, avx2, avx512");
}

}  // namespace trocar
